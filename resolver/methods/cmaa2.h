// CMAA2: conservative morphological anti-aliasing, version 2.3 (Intel 2018; methods/03 s.3.7).
//
// 1. Edges of sqrt-encoded luma between neighbours, less a share of the edges that meet them. 2. Pixels with two
// adjacent edges are candidates: each is blurred a little toward its edges. 3. Candidates that are the step of a
// Z-shaped line trace both its arms (which must be about equally long) and blend the pixels along half of each arm by a
// linear ramp. 4. A pixel with several results gets their weighted mean.
// Edges are found on linear colour clamped to [0,1]; blending is in linear light by default. Lengths in px.
// Deviation: results are added in a fixed order (own blur, horizontal lines from the left, vertical lines from the
// top), where a GPU's order is that of its threads.
#pragma once
#include "methods/method.h"

namespace aa {
MethodDescriptor cmaa2Descriptor();
}
