// The display chain of image/colour.h as a kernel takes it (kernels/display.h).
#pragma once

namespace aa {

struct DisplayArgs {
    float scale = 1;   // 2^exposure
    int toneMap = 0;   // ToneMap as an integer
    bool srgb = true;  // the transfer function; otherwise the clamped value is the displayed one
};

}  // namespace aa
