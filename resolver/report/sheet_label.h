// What a contact sheet says of a method: its name, its figures, the best of each marked.
#pragma once
#include <map>
#include <set>
#include <string>
#include <vector>

#include "report/sheet_pages.h"

namespace aa {

// The shown methods, as indices into RunResults::methods, in the order of the sheet.
struct SheetMethods {
    const RunResults& run;
    std::vector<size_t> order;
    // By the name of a figure, as it is printed: what several reach is marked at all of them. Only figures that two
    // methods or more have.
    std::map<std::string, std::string, std::less<>> best;
    std::set<std::string, std::less<>> figures;  // that one of them has, by the same names

    bool marksTime() const { return best.contains("time") || best.contains("device"); }

    const MethodResult& at(size_t place) const { return run.methods[order[place]]; }
};
SheetMethods sheetMethods(const RunResults& run, const std::vector<size_t>& order);

class SheetLabel {
  public:
    // All figures, for a row of pictures; `width` px wide. `place` counts in the order.
    static SheetLabel full(const SheetMethods& methods, size_t place, int width, const Theme& theme, const Canvas& pen);
    // The name, PSNR and gain, for a strip or above a column.
    static SheetLabel brief(const SheetMethods& methods, size_t place, int width, const Theme& theme,
                            const Canvas& pen);
    static SheetLabel words(const std::string& name, const std::vector<std::string>& lines, int width,
                            const Theme& theme, const Canvas& pen);
    int height() const;
    void draw(Canvas& canvas, int x, int y) const;  // its top left

  private:
    struct Line {
        std::string name, value, unit;  // a name alone is a line of text
        Colour colour;
        int sizePx, stepPx;
        bool bold = false, best = false;
    };
    SheetLabel(int width, const Theme& theme, const Canvas& pen) : width_(width), theme_(&theme), pen_(&pen) {}
    void text(const std::string& text, int sizePx, Colour colour, bool bold = false);
    void figure(const std::string& name, const std::string& value, const std::string& unit, Colour colour, bool best);
    void names(const MethodResult& method, int sizePx);
    void small(const std::string& words);
    int width_;
    const Theme* theme_;
    const Canvas* pen_;
    std::vector<Line> lines_;
};

}  // namespace aa
