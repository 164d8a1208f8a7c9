// Sizes of the pictures on a contact sheet: as large as the page allows, crops by whole factors.
#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "image/window.h"

namespace aa {

struct CellSize {
    int width = 0, height = 0;  // px of the sheet
    int magnification = 0;      // px of the sheet per px of the picture; 0: shrunk
    // Of its column, whose head must find room above a picture of one pixel, too.
    int column() const { return std::max(width, kLeastColumn); }
    static constexpr int kLeastColumn = 64;
};
// What ends a refusal: another page is no advice to who has asked for the free one.
std::string smallerAdvice(const std::string& less, const std::string& page);

// A row of a method: the whole frame, crops, maps of the whole frame.
struct RowContent {
    int frameWidth, frameHeight;  // of the run's pictures
    bool frame;                   // the column of the whole frame
    std::vector<Window> crops;
    int maps;
    int zoom;      // of the crops; 0: what fits
    int rows = 1;  // of methods and truth: many are lower than few, since a picture has 16384 px a side at most
};
struct RowLayout {
    CellSize frame;  // of maps too
    std::vector<CellSize> crops;
    int width, height;  // of the pictures, with the gaps between them
    // Of a map, whose scale is explained beside the truth.
    int mapColumn() const { return std::max(frame.width, kLeastMapColumn); }
    static constexpr int kLeastMapColumn = 144;
};
// `room`: width in px; 0: no limit. Throws UsageError when even the smallest do not fit.
RowLayout rowLayout(const RowContent& content, int room, const std::string& page);

// Crops side by side, one column per method or frame, one row per crop.
struct GridLayout {
    std::vector<CellSize> cells;  // one per crop
    int cellWidth;                // of a column
    int columns;                  // beside each other; more columns go below or onto the next page
};
// `room`, `roomHeight`: for the columns and for all crops of one block, px; 0: no limit of the height. `atOnce`: one
// block holds all crops, else each crop is a block of its own. Throws UsageError as above.
GridLayout gridLayout(const std::vector<Window>& crops, size_t columns, int zoom, int room, int roomHeight,
                      const std::string& page);

inline constexpr int kCellGap = 6;

}  // namespace aa
