// A drawing surface for contact sheets: encoded sRGB, filled rectangles, images, text.
#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "image/colour_map.h"
#include "image/io.h"
#include "image/plane.h"
#include "report/gallery.h"

namespace aa {

class Canvas {
  public:
    enum class Font { regular, bold };
    enum class Align { left, centre, right };

    Canvas(int width, int height, Colour background);
    ~Canvas();
    int width() const;
    int height() const;

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

    void writePng(const std::filesystem::path& file) const;  // through a temporary name; throws InputError

  private:
    struct Pixels;
    std::unique_ptr<Pixels> pixels_;
};

// Area-averaged in linear light to width x height (each at most the image's own).
Rgb shrunk(const Rgb& encoded, int width, int height, const Exec& exec);
PlaneF shrunk(const PlaneF& plane, int width, int height);

}  // namespace aa
