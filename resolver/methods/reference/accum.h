// accum: accumulation buffer, the mean of the jittered frames of a static scene.
//
// Source: [Haeberli 1990]; [Oliveros 2018, 3.7, appendix B]. Linear light (`space=encoded`: display values), uniform
// weights: after one period of the jitter the output is the box mean of its phases. Sums are double, so that 1e5 frames
// do not drift. Deviation: a shot is finite, so frame n shows the mean of frames 1..n since the last reset, at most
// `samples` of them.
#pragma once
#include "methods/method.h"

namespace aa {
MethodDescriptor accumDescriptor();
}
