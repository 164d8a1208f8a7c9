// A rectangle of an image's pixels.
#pragma once
#include <string>

#include "image/plane.h"

namespace aa {

struct Window {
    int x = 0, y = 0, width = 0, height = 0;
    bool overlaps(const Window& o) const {
        return x < o.x + o.width && o.x < x + width && y < o.y + o.height && o.y < y + height;
    }
    // Not empty, and within an image of this size.
    bool isInside(int imageWidth, int imageHeight) const {
        return x >= 0 && y >= 0 && width > 0 && height > 0 && width <= imageWidth && height <= imageHeight &&
               x <= imageWidth - width && y <= imageHeight - height;
    }
    bool operator==(const Window&) const = default;
};

// "X,Y,WIDTH,HEIGHT", px, y down, as `option` gives it for `image` of this size. Throws UsageError: something else is
// written there, empty, or not within the image.
Window windowFrom(const std::string& text, const std::string& option, const std::string& image, int width, int height);
std::string inWords(const Window& window);  // "64 x 32 px at 100, 40"
// Its pixels as an image of their own, border filled.
Rgb cropped(const Rgb& image, const Window& window);

}  // namespace aa
