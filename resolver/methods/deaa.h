// DEAA: directionally adaptive edge anti-aliasing (Iourcha, Yang, Pomianowski 2009; methods/04 s.4.4, reconstructed).
//
// 1. Pixels whose sub-samples differ in colour are edge pixels; isolated ones and those in the midst of nothing but
// edges keep the box resolve. 2. A plane is fitted to the luma of all sub-samples of the 3x3 window; where it does not
// fit, the box stays. 3. Every sub-sample within a rectangle along the isolines counts with the length that its isoline
// has inside the pixel: an edge gets as many levels as the whole window has samples. Linear light, px, y down. The
// thresholds are ours; the paper's are not public.
#pragma once
#include "methods/method.h"

namespace aa {
MethodDescriptor deaaDescriptor();
}
