// Sharpening filters of the temporal methods ([Oliveros 2018, eq 3.1 and 4.17]; [Castorina 2023]), applied to an output
// and never fed back.
//
// Both 3x3 crosses add gain * (4 c - sum of the cross) to the centre; "normalised" means gain 1/4 instead of 1.
// Encoded results are clamped to [0,1]; linear ones to the range of their 3x3 neighbourhood and to >= 0, so that a
// firefly cannot be multiplied by five (conventions 9).
#pragma once
#include "methods/method.h"
#include "methods/sharpen_kernels.h"

namespace aa {

inline constexpr Choice<Sharpen> kSharpens[] = {
    {"xu", Sharpen::xu}, {"norm", Sharpen::norm}, {"lumaPost", Sharpen::lumaPost}};
Sharpen sharpenByName(const std::string& text);  // one of kSharpens

// `image` needs a filled border of one pixel. `out` is resized to it; its border is not filled.
void sharpen(const Rgb& image, Sharpen filter, Space space, const Exec& exec, Rgb& out);

// lumaPost by any amount, of linear light, as the Vulkan book has it: held to >= 0 alone. `out` is of image's size.
void sharpenLuma(const Rgb& image, float amount, const Exec& exec, Rgb& out);

}  // namespace aa
