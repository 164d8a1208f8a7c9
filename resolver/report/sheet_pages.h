// Pages of a contact sheet: colours, sizes, head and foot, and rows that flow from page to page.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "report/canvas.h"
#include "study/results.h"

namespace aa {

// Neutral grounds: judging colours needs grey around the pictures.
struct Theme {
    Colour ground, panel, ink, quiet, better, worse, note;
    std::vector<Colour> crops;  // one after the other
    Colour ofCrop(size_t i) const { return crops[i % crops.size()]; }
};
const Theme& sheetTheme(bool light);

enum class PageSize { free, a4, a4Portrait, slide };
PageSize pageSizeByName(const std::string& name);  // free, a4, a4-portrait, slide; throws UsageError
struct PageFormat {
    int width, height;  // px, 144 to the inch; 0: as large as what is on it
    const char* name;
};
PageFormat formatOf(PageSize page);

inline constexpr int kSheetMargin = 28, kSheetGap = 14;

// What is drawn across the page with its top at y.
struct SheetItem {
    int height;
    std::function<void(Canvas&, int y)> draw;
};
struct SheetSection {
    std::vector<SheetItem> lead;  // above its rows, again on every page
    std::vector<SheetItem> rows;
};
struct SheetText {
    std::string title, after, line;  // large, beside it, below
    std::string foot;
};

// The sections below each other, on as many pages as they need. `width`: of the content without margins. Throws
// UsageError when not even one row fits the page, or a free page becomes too large a picture.
std::vector<Canvas> sheetPages(const std::vector<SheetSection>& sections, int width, PageSize page, const Theme& theme,
                               const SheetText& text, const std::string& version);

}  // namespace aa
