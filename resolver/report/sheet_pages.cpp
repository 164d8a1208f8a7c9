#include "report/sheet_pages.h"

#include <algorithm>

#include "image/error.h"
#include "report/sheet_layout.h"

namespace aa {
namespace {
using Font = Canvas::Font;
using Align = Canvas::Align;
constexpr int kTitlePx = 30, kAfterPx = 19, kLinePx = 15, kFootPx = 14, kLeast = 1100;

struct Placed {
    const SheetItem* item;
    int y;
};
// Tops of the rows, from `top`; a row that would pass `bottom` begins the next page.
std::vector<std::vector<Placed>> flow(const std::vector<SheetSection>& sections, int top, int bottom,
                                      const char* page) {
    std::vector<std::vector<Placed>> pages(1);
    int y = top;
    const auto put = [&](const SheetItem& item) {
        pages.back().push_back({&item, y});
        y += item.height;
    };
    for (const auto& s : sections) {
        int lead = 0;
        for (const auto& item : s.lead) lead += item.height;
        for (size_t r = 0; r < s.rows.size(); r++) {
            const int needed = s.rows[r].height + (r == 0 ? lead : 0);
            if (bottom > 0 && y + needed > bottom) {
                if (top + lead + s.rows[r].height > bottom)
                    throw UsageError("--page " + std::string(page) + ": a row of " + std::to_string(s.rows[r].height) +
                                     " px below heads of " + std::to_string(lead) + " does not fit " +
                                     std::to_string(bottom - top) + "; " +
                                     smallerAdvice("smaller crops, fewer columns", page));
                pages.emplace_back();
                y = top;
                for (const auto& item : s.lead) put(item);
            } else if (r == 0) {
                for (const auto& item : s.lead) put(item);
            }
            put(s.rows[r]);
        }
    }
    return pages;
}
}  // namespace

const Theme& sheetTheme(bool light) {
    static const Theme dark{{0.105f, 0.105f, 0.108f},
                            {0.150f, 0.150f, 0.154f},
                            {0.925f, 0.925f, 0.92f},
                            {0.66f, 0.66f, 0.67f},
                            {0.55f, 0.83f, 0.60f},
                            {0.93f, 0.56f, 0.50f},
                            {0.90f, 0.76f, 0.42f},
                            {{0.30f, 0.78f, 0.95f},
                             {0.98f, 0.72f, 0.25f},
                             {0.93f, 0.45f, 0.75f},
                             {0.45f, 0.85f, 0.55f},
                             {0.96f, 0.93f, 0.45f},
                             {0.70f, 0.62f, 0.98f}}};
    static const Theme light_{{1.0f, 1.0f, 1.0f},
                              {0.945f, 0.945f, 0.95f},
                              {0.10f, 0.10f, 0.11f},
                              {0.36f, 0.36f, 0.38f},
                              {0.10f, 0.44f, 0.20f},
                              {0.68f, 0.18f, 0.10f},
                              {0.52f, 0.34f, 0.0f},
                              {{0.0f, 0.45f, 0.70f},
                               {0.83f, 0.37f, 0.0f},
                               {0.72f, 0.20f, 0.52f},
                               {0.0f, 0.50f, 0.36f},
                               {0.55f, 0.47f, 0.0f},
                               {0.36f, 0.28f, 0.75f}}};
    return light ? light_ : dark;
}

PageSize pageSizeByName(const std::string& name) {
    for (const PageSize p : {PageSize::free, PageSize::a4, PageSize::a4Portrait, PageSize::slide})
        if (name == formatOf(p).name) return p;
    throw UsageError("--page: expected free, a4, a4-portrait or slide, found '" + name + "'");
}
PageFormat formatOf(PageSize page) {
    switch (page) {
        case PageSize::a4:  // ISO 216: 297 x 210 mm
            return {1684, 1190, "a4"};
        case PageSize::a4Portrait:
            return {1190, 1684, "a4-portrait"};
        case PageSize::slide:  // 13 1/3 x 7 1/2 inches
            return {1920, 1080, "slide"};
        case PageSize::free:
            break;
    }
    return {0, 0, "free"};
}

std::vector<Canvas> sheetPages(const std::vector<SheetSection>& sections, int width, PageSize page, const Theme& theme,
                               const SheetText& text, const std::string& version) {
    const PageFormat format = formatOf(page);
    const int pageWidth = format.width > 0 ? format.width : std::max(width + 2 * kSheetMargin, kLeast);
    const int inner = pageWidth - 2 * kSheetMargin;
    const Canvas pen(1, 1, theme.ground);  // measures
    const auto title = pen.wrapped(text.title, inner, kTitlePx, Font::bold);
    const int titleEnd = pen.textWidth(title.back(), kTitlePx, Font::bold) + 22;
    const bool beside = titleEnd + pen.textWidth(text.after, kAfterPx) <= inner;
    const auto after = beside ? std::vector{text.after} : pen.wrapped(text.after, inner, kAfterPx);
    const auto lines = pen.wrapped(text.line, inner, kLinePx);
    const std::string mark = "AA Resolve " + version;
    constexpr int kPageNumber = 130;  // px
    const auto foot = pen.wrapped(text.foot, inner - pen.textWidth(mark, kFootPx) - kPageNumber, kFootPx);
    const int head = 10 + int(title.size()) * 36 + (beside ? 0 : int(after.size()) * 24) + int(lines.size()) * 20 + 22;
    const int below = 20 + int(foot.size()) * 19 + 12;
    // A free sheet ends where a picture does.
    const auto pages = flow(sections, head, (format.height > 0 ? format.height : kLargestSide) - below, format.name);

    std::vector<Canvas> out;
    for (size_t p = 0; p < pages.size(); p++) {
        const int end = pages[p].empty() ? head : pages[p].back().y + pages[p].back().item->height;
        const int height = format.height > 0 ? format.height : end + below;
        if (std::max(pageWidth, height) > kLargestSide)
            throw UsageError("the sheet would have " + std::to_string(pageWidth) + " x " + std::to_string(height) +
                             " px, more than " + std::to_string(kLargestSide) +
                             " a side; choose fewer methods, frames or crops, or --page a4");
        Canvas canvas(pageWidth, height, theme.ground);
        int y = 10;
        for (const auto& t : title) canvas.text(kSheetMargin, y += 36, t, kTitlePx, theme.ink, Font::bold);
        if (beside)
            canvas.text(kSheetMargin + titleEnd, y, text.after, kAfterPx, theme.quiet);
        else
            for (const auto& t : after) canvas.text(kSheetMargin, y += 24, t, kAfterPx, theme.quiet);
        y += 8;
        for (const auto& t : lines) canvas.text(kSheetMargin, y += 20, t, kLinePx, theme.quiet);
        for (const auto& [item, top] : pages[p]) item->draw(canvas, top);
        y = height - below + 20;
        const std::string number =
            pages.size() == 1 ? mark : mark + ", page " + std::to_string(p + 1) + " of " + std::to_string(pages.size());
        canvas.text(pageWidth - kSheetMargin, y, number, kFootPx, theme.quiet, Font::regular, Align::right);
        for (const auto& t : foot) canvas.text(kSheetMargin, y, t, kFootPx, theme.quiet), y += 19;
        out.push_back(std::move(canvas));
    }
    return out;
}

}  // namespace aa
