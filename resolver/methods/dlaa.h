// DLAA: directionally localised anti-aliasing (Andreev 2011; methods/04 s.4.1).
//
// 1. A high-pass gives the strength of edges. 2. Short edges: blur along the direction in which the other direction's
// high-pass is strong. 3. Long edges, where the strength over 16 px in one direction dominates: shift across the edge
// so that the luma matches the blur along it. Encoded colour; taps in px. Constants are those of published ports.
// Bilinear taps at half pixels are written as the pixels that they average.
// Deviation: three decisions that jump where nothing visible differs fade over what 8 bits cannot tell
// (dlaa_kernels.h): the ratio of nearly equal lumas, the "all four shares are 0" rule and the dominance of one
// direction. As published, neighbours that differ by 1e-8 moved single pixels by 0.3, in float otherwise than in
// double.
#pragma once
#include "methods/method.h"

namespace aa {
MethodDescriptor dlaaDescriptor();
}
