// A temporal upscaler's accumulation at native resolution, after AMD's FSR 2 (public description and source).
// methods/06 s.6.14; results are "FSR2-like", not FSR 2.
//
// 1. Every surface is splatted to where it was a frame ago; a pixel that finds something nearer there was hidden
//    (depth clip), by how much is graded by the separation that the depth's resolution can tell.
// 2. One-pixel ridges of luma are locked: their history survives the colour box while the window's luma stays.
// 3. Current colour: Lanczos-2 over 3x3 around the jittered samples, deringed. Colour box: Gaussian mean and deviation
//    in YCoCg, cut with the window's bounds.
// 4. Blend in the tone-mapped space x / (1 + max), history read by Lanczos-2.
// Differs from FSR 2: no upscaling, no reactive masks, no auto-exposure; a lock watches the 3x3 mean of luma against
// its running mean over a jitter period, not a blurred pyramid; the box's Gaussian goes from exp(-2 d^2) to exp(-3 d^2)
// by mixing the two.
#pragma once
#include "methods/method.h"

namespace aa {
MethodDescriptor fsr2nDescriptor();
}
