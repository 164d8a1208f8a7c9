#include "image/window.h"

#include <cstdio>

#include "image/error.h"

namespace aa {

Window windowFrom(const std::string& text, const std::string& option, const std::string& image, int width, int height) {
    Window w;
    int read = 0;
    const int found = std::sscanf(text.c_str(), "%d,%d,%d,%d%n", &w.x, &w.y, &w.width, &w.height, &read);
    if (found != 4 || size_t(read) != text.size())
        throw UsageError(option + ": expected X,Y,WIDTH,HEIGHT in pixels, as in 100,40,64,32, found '" + text + "'");
    if (!w.isInside(width, height))
        throw UsageError(option + " " + text + ": " +
                         (w.width < 1 || w.height < 1 ? "empty" : "not all within the picture") + "; " + image +
                         " has " + std::to_string(width) + " x " + std::to_string(height) + " px, so X is 0 to " +
                         std::to_string(width - 1) + " and Y 0 to " + std::to_string(height - 1));
    return w;
}

std::string inWords(const Window& w) {
    return std::to_string(w.width) + " x " + std::to_string(w.height) + " px at " + std::to_string(w.x) + ", " +
           std::to_string(w.y);
}

Rgb cropped(const Rgb& image, const Window& window) {
    Rgb out(window.width, window.height);
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < window.height; y++)
            std::copy_n(image.c[c].row(window.y + y) + window.x, window.width, out.c[c].row(y));
    out.fillBorder();
    return out;
}

}  // namespace aa
