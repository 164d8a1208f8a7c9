// One scalar per pixel for edge decisions: the lumas of the spatial methods, written to a bordered plane.
//
// methods/00 s.4 (601 and 709 weights), 02 s.2.1 (luma options), 02 s.2.2 (FXAA 1), 02 s.2.3 (log-luma of the compute
// variant), 03 s.3.7 (CMAA2: sqrt-encoded).
#pragma once
#include "image/plane.h"
#include "kernels/dispatch.h"
#include "methods/luma_kernels.h"

namespace aa {

// Writes the luma of `color` (encoded or linear as the kind demands) and fills the border. NaN gives a finite value.
void lumaPlane(const Rgb& color, LumaKind kind, const Exec& exec, PlaneF& luma);

}  // namespace aa
