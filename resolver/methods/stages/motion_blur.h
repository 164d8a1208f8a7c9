// +motionBlur=SCALE: samples along the motion vector [Chapman 2012]. Off for metrics: the truth is an instant.
//
// v = motion * SCALE px (SCALE = current frame rate / target frame rate; 0.5 is a half-open shutter);
// n = clamp(int |v|, 1, 32); out = (c(p) + sum over i = 1 .. n-1 of B(c, p + v (i / (n-1) - 1/2))) / n, as published:
// the centre tap plus the symmetric run. |v| is held to half the image (conventions 11), positions to the image; a
// motion that is not a number blurs nothing.
#pragma once
#include "methods/stage.h"

namespace aa {
StageDescriptor motionBlurStage();
}
