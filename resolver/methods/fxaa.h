// The FXAA family (T. Lottes; methods/02): blends every pixel with the neighbour across the edge that it lies on, by
// the share that an edge through the two ends of the visible step would cover.
//
// fxaa311: where the local luma contrast is high enough, take the direction of the edge, the side with the steeper
// gradient, walk along the boundary both ways until the luma of the pair changes, and shift the sampling point across
// the boundary by (0.5 - nearer end / both ends) px, or further where the pixel stands out of its 3x3 neighbourhood.
// Input: encoded RGB in [0,1] and one luma per pixel. Positions in px, y down; taps clamp to the image.
// Deviation: edge pixels are decided in double with a relative tolerance of 1e-6 on two comparisons that are exact ties
// on clean edges (orientation; a sample half a pixel short of the end), which rounding would decide otherwise.
#pragma once
#include "methods/method.h"

namespace aa {
MethodDescriptor fxaa311Descriptor();
MethodDescriptor fxaa1Descriptor();        // white paper: exhaustive search, low-pass against sub-pixel aliasing
MethodDescriptor fxaaCsDescriptor();       // compute shader (J. Stanard): log-luma decisions, blend in linear light
MethodDescriptor fxaaConsoleDescriptor();  // FXAA 3.11 console: four taps along the local edge direction
}  // namespace aa
