#include "report/sheet_layout.h"

#include <algorithm>
#include <cmath>

#include "image/error.h"
#include "image/io.h"
#include "report/sheet_pages.h"

namespace aa {
namespace {
constexpr int kTallest = 320, kWidestFrame = 480, kLeastHeight = 48;  // px of a frame
constexpr int kLeastCrop = 216, kMostCrop = 288;                      // px of a crop's height on a free sheet

CellSize frameCell(int width, int height, int mostWidth, int mostHeight) {
    const int magnification = std::min(mostWidth / width, mostHeight / height);
    if (magnification > 0) return {width * magnification, height * magnification, magnification};
    const double scale = std::min(double(mostWidth) / width, double(mostHeight) / height);
    return {std::max(1, int(std::lround(width * scale))), std::max(1, int(std::lround(height * scale))), 0};
}
CellSize cropCell(const Window& crop, int zoom, int height) {
    const int magnification = zoom > 0 ? zoom : std::max(1, height / crop.height);
    return {crop.width * magnification, crop.height * magnification, magnification};
}
RowLayout rowOf(const RowContent& c, int height, int cropHeight) {
    RowLayout l{};
    l.frame = frameCell(c.frameWidth, c.frameHeight, height * kWidestFrame / kTallest, height);
    const int side = cropHeight > 0 ? cropHeight : std::clamp(l.frame.height, kLeastCrop, kMostCrop);
    // A low and wide crop is no wider than one and a half square ones.
    for (const Window& crop : c.crops)
        l.crops.push_back(cropCell(crop, c.zoom, std::min(side, std::max(1, 3 * side / 2 / crop.width) * crop.height)));
    l.width = (c.frame ? l.frame.column() + kSheetGap : 0) + c.maps * (l.mapColumn() + kSheetGap) - kSheetGap;
    if (c.frame || c.maps > 0) l.height = l.frame.height;
    for (const CellSize& crop : l.crops) {
        l.width += crop.column() + kSheetGap;
        l.height = std::max(l.height, crop.height);
    }
    return l;
}
std::string sizes(const std::vector<Window>& crops) {
    std::string all;
    for (const Window& w : crops)
        all += (all.empty() ? "" : ", ") + std::to_string(w.width) + " x " + std::to_string(w.height);
    return all;
}
}  // namespace

std::string smallerAdvice(const std::string& less, const std::string& page) {
    return "choose " + less + (page == "free" ? " or a smaller --zoom" : ", a smaller --zoom or --page free");
}

RowLayout rowLayout(const RowContent& c, int room, const std::string& page) {
    if (room == 0) {
        constexpr int kHeadAndFoot = 600, kBetween = 130;  // px, the second per row
        const int most = (kLargestSide - kHeadAndFoot) / c.rows - kBetween;
        RowLayout l = rowOf(c, kTallest, 0);
        for (int height = kTallest; l.height > most && height >= kLeastHeight; height -= 8)
            l = rowOf(c, height, height);
        return l;
    }
    for (int height = kTallest; height >= kLeastHeight; height -= 2)
        if (const RowLayout l = rowOf(c, height, height); l.width <= room) return l;
    throw UsageError("--page " + page + ": " + std::to_string((c.frame ? 1 : 0) + c.maps) +
                     " whole frames and crops of " + (c.crops.empty() ? "none" : sizes(c.crops)) + " px do not fit " +
                     std::to_string(room) + " px side by side; leave out --columns, " +
                     smallerAdvice("smaller crops", page));
}

GridLayout gridLayout(const std::vector<Window>& crops, size_t columns, int zoom, int room, int roomHeight,
                      const std::string& page) {
    constexpr int kLeastColumn = 96, kUsualHeight = 192, kMostZoom = 16;
    const auto of = [&](int z) {
        GridLayout l{{}, 0, 1};
        // The tallest crop by z, the others as much as comes near it.
        int tallest = 0;
        for (const Window& w : crops) tallest = std::max(tallest, w.height);
        for (const Window& w : crops) l.cells.push_back(cropCell(w, zoom, tallest * z));
        for (const CellSize& cell : l.cells) l.cellWidth = std::max(l.cellWidth, cell.width);
        l.cellWidth = std::max(l.cellWidth, kLeastColumn);
        l.columns = std::min(int(columns), (room + kCellGap) / (l.cellWidth + kCellGap));
        return l;
    };
    const auto heightOf = [&](const GridLayout& l) {
        int height = 0;
        for (const CellSize& cell : l.cells) height += cell.height;
        return height;
    };
    const auto blocks = [&](const GridLayout& l) { return (int(columns) + l.columns - 1) / l.columns; };
    GridLayout best{{}, 0, 0};
    for (int z = 1; z <= (zoom > 0 ? 1 : kMostZoom); z++) {
        const GridLayout l = of(z);
        if (l.columns < 1 || (roomHeight > 0 && heightOf(l) > roomHeight)) break;
        const bool usual = roomHeight > 0 || l.cells.empty() || l.cells[0].height <= kUsualHeight || z == 1;
        // On a page the fewest blocks count, then the size; else the usual size.
        if (best.columns == 0 || (roomHeight > 0 ? blocks(l) <= blocks(best) : usual)) best = l;
    }
    if (best.columns == 0)
        throw UsageError("--page " + page + ": crops of " + sizes(crops) + " px" +
                         (zoom > 0 ? " at --zoom " + std::to_string(zoom) : std::string()) + " do not fit " +
                         std::to_string(room) + (roomHeight > 0 ? " x " + std::to_string(roomHeight) : std::string()) +
                         " px; " + smallerAdvice("smaller crops", page));
    // As many in the last block as in the others, or nearly.
    best.columns = (int(columns) + blocks(best) - 1) / blocks(best);
    return best;
}

}  // namespace aa
