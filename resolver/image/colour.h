// Colour spaces and the display chain D of conventions 4: linear * 2^exposure -> tone map -> clamp [0,1] -> transfer.
//
// "Linear" is scene-referred BT.709; "encoded" is what is displayed, in [0,1]: with the sRGB transfer its codes, with
// the identity transfer the clamped values themselves ([Oliveros 2018] has no gamma anywhere; decisions 49). The sRGB
// functions use roots by Newton's method instead of libm's pow, so that every machine gives the same bits
// (error <= 3e-7 in float).
#pragma once
#include "image/plane.h"
#include "kernels/dispatch.h"
#include "kernels/display_args.h"

namespace aa {

enum class ToneMap { none, reinhard, aces };
enum class Transfer { srgb, identity };

struct DisplayChain {
    float exposure = 0;  // EV
    ToneMap toneMap = ToneMap::none;
    Transfer transfer = Transfer::srgb;
    // What images that are display-referred already still need: the transfer alone.
    DisplayChain transferOnly() const { return {0, ToneMap::none, transfer}; }
};
DisplayArgs displayArgs(const DisplayChain& chain);

// Linear scene-referred -> encoded [0,1]. NaN encodes to 0. Same size, also the same image; the border of the result is
// filled.
void encode(const Rgb& linear, const DisplayChain& chain, const Exec& exec, Rgb& encoded);
// Encoded [0,1] -> linear display-referred: the inverse of the chain's transfer function only.
void decode(const Rgb& encoded, const DisplayChain& chain, const Exec& exec, Rgb& linear);

// The linear value that is displayed as exactly 1; larger ones are clipped. Infinite for Reinhard.
double displayCeiling(const DisplayChain& chain);
// Pixels of which a channel lies above the ceiling or below 0.
size_t clippedPixels(const Rgb& linear, const DisplayChain& chain);

// What an 8-bit file keeps of a value: floor(255 v + 0.5) of v in [0, 1]. NaN gives 0.
inline int code8(float v) { return int(255.0f * (v > 0 ? (v < 1 ? v : 1.0f) : 0.0f) + 0.5f); }

}  // namespace aa
