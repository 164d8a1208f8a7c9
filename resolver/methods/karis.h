// karis, salvi, falcor, donut: one skeleton in linear HDR, four published sets of choices (methods/06 s.6.6, 6.7).
//
//  1. current colour: 3x3 samples weighted by their distance to the pixel centre (Blackman-Harris fit
//     exp(-2.29 d^2), d = |neighbour + jitter|) and by 1 / (1 + luminance)
//  2. colour box in YCoCg: min/max (rounded), variance about the centre pixel, or their intersection
//  3. history is clipped into it toward the filtered centre (karis), the mean (salvi), or clamped (falcor, donut)
//  4. weight of the current colour, with an anti-flicker rule; 5. blend with weights 1 / (1 + luminance)
// karis: Karis 2014 (Unreal Engine 4); its anti-flicker is the public engine's. salvi: Salvi 2016, variance clipping.
// falcor: Falcor's TAA pass (longest motion, clamp, no filter, plain blend). donut: Donut's (values PQ-encoded at
// nominal 10000; clamp to mean -+ sigma). Outside the image: the (filtered) current colour.
// Input and output: linear light, >= 0; depth planar; motion in px.
#pragma once
#include "methods/method.h"

namespace aa {
MethodDescriptor karisDescriptor();
MethodDescriptor salviDescriptor();
MethodDescriptor falcorDescriptor();
MethodDescriptor donutDescriptor();
}  // namespace aa
