// accum: accumulation buffer, the mean of the jittered frames of a static scene.
//
// Source: Haeberli & Akeley 1990; seed 000 s.3.7, App. B; methods/01 s.1.3. Linear light (`space=encoded`: display
// values), uniform weights: after one period of the jitter the output is the box mean of its phases. Sums are double,
// so that 1e5 frames do not drift. Deviation: a shot is finite, so frame n shows the mean of frames 1..n since the last
// reset, at most `samples` of them.
#pragma once
#include "methods/method.h"

namespace aa {
MethodDescriptor accumDescriptor();
}
