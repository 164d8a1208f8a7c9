// A drawing surface for contact sheets: encoded sRGB, filled rectangles, images, text.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "image/colour_map.h"
#include "image/io.h"
#include "image/plane.h"
#include "report/gallery.h"

namespace aa {

// What was drawn is kept as marks, so that a canvas becomes pixels (codes(), writePng) or a page of a PDF
// (report/document.h) with text as text.
class Canvas {
  public:
    enum class Font { regular, bold };
    enum class Align { left, centre, right };
    struct Fill {
        Window area;
        Colour colour;
    };
    struct Picture {
        int x, y, magnification, width, height;
        std::vector<unsigned char> codes;  // of its own pixels, R G B R G B ...
    };
    struct Text {
        int x, y, sizePx;  // x: of its left end; y: of the baseline
        int advancePx;     // from pen to pen, as pixels show it
        std::string text;
        Colour colour;
        Font font;
    };
    using Mark = std::variant<Fill, Picture, Text>;

    Canvas(int width, int height, Colour background);
    ~Canvas();
    Canvas(Canvas&&) noexcept;
    Canvas& operator=(Canvas&&) noexcept;
    int width() const { return width_; }
    int height() const { return height_; }

    void fill(const Window& area, Colour colour);
    void frame(const Window& area, Colour colour, int thickness);  // outside `area`
    // Top-left corner at (x, y), each pixel as a square of `magnification`.
    void draw(const Rgb& encoded, int x, int y, int magnification = 1);
    // UTF-8; `y` is the text's baseline, without kerning. Throws InputError when no DejaVu Sans font is installed.
    void text(int x, int y, const std::string& text, int sizePx, Colour colour, Font font = Font::regular,
              Align align = Align::left);
    int textWidth(const std::string& text, int sizePx, Font font = Font::regular) const;
    // Cut at the end with three dots to fit.
    std::string fitted(const std::string& text, int maxWidth, int sizePx, Font font = Font::regular) const;
    // Broken into lines that fit: after a space, ',' ':' '/', before '+', and within a word that is wider than a line.
    std::vector<std::string> wrapped(const std::string& text, int maxWidth, int sizePx,
                                     Font font = Font::regular) const;

    const std::vector<Mark>& marks() const { return marks_; }  // in the order of drawing
    std::vector<unsigned char> codes() const;                  // 8-bit sRGB, R G B R G B ..., row by row
    void writePng(const std::filesystem::path& file) const;    // through a temporary name; throws InputError
    static std::filesystem::path fontFile(Font font);          // throws InputError when there is none

  private:
    int width_, height_;
    std::vector<Mark> marks_;
    class Fonts;
    std::unique_ptr<Fonts> fonts_;
};

// Area-averaged in linear light to width x height (each at most the image's own).
Rgb shrunk(const Rgb& encoded, int width, int height, const Exec& exec);
PlaneF shrunk(const PlaneF& plane, int width, int height);

}  // namespace aa
