// Pictures that tests of figures measure.
#pragma once
#include <random>

#include "image/plane.h"

namespace aa {

// Each value by itself, from lo to hi.
inline Rgb noisePicture(int w, int h, unsigned seed, float lo = 0, float hi = 1) {
    std::mt19937 random(seed);
    Rgb image(w, h);
    for (auto& p : image.c)
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++) p.at(x, y) = lo + (hi - lo) * float(random() >> 8) * 0x1p-24f;
    return image;
}

}  // namespace aa
