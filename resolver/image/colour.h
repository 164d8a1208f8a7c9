// Colour spaces and the display chain D of methods/00 s.4: linear * 2^exposure -> tone map -> clamp [0,1] -> sRGB.
//
// "Linear" is scene-referred BT.709; "encoded" is display-referred sRGB in [0,1]. The transfer functions use roots by
// Newton's method instead of libm's pow, so that every machine gives the same bits (error <= 3e-7 in float).
#pragma once
#include "image/plane.h"
#include "kernels/dispatch.h"

namespace aa {

enum class ToneMap { none, reinhard, aces };

struct DisplayChain {
    float exposure = 0;  // EV
    ToneMap toneMap = ToneMap::none;
};

// Linear scene-referred -> encoded [0,1]. NaN encodes to 0. Same size; the border of the result is filled.
void encode(const Rgb& linear, const DisplayChain& chain, const Exec& exec, Rgb& encoded);
// Encoded [0,1] -> linear display-referred: the inverse of the sRGB transfer function only.
void decode(const Rgb& encoded, const Exec& exec, Rgb& linear);

}  // namespace aa
