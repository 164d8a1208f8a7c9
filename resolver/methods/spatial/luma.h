// One scalar per pixel for edge decisions: the lumas of the spatial methods, written to a bordered plane.
//
// BT.601 and BT.709 weights (conventions 4), the luma options of [Lottes 2011], FXAA 1's [Lottes 2009], the log-luma of
// the compute variant [Stanard n.d.], CMAA2's of square roots [Strugar 2018].
#pragma once
#include "image/colour.h"
#include "kernels/dispatch.h"
#include "methods/spatial/luma_kernels.h"

namespace aa {

// The luma that `kind` stands for in the space of a frame: where the transfer is the identity, linear colours are the
// displayed ones, and the curves that approximate an encoding fall away.
inline LumaKind shownLuma(LumaKind kind, const DisplayChain& display) {
    if (display.transfer != Transfer::identity) return kind;
    switch (kind) {
        case LumaKind::sqrtLinear:
        case LumaKind::linearOfSqrt:
            return LumaKind::rec601;
        case LumaKind::log2Linear:
            return LumaKind::rec709;
        default:
            return kind;
    }
}
// Writes the luma of `color` (encoded or linear as the kind demands) and fills the border. NaN gives a finite value.
void lumaPlane(const Rgb& color, LumaKind kind, const Exec& exec, PlaneF& luma);

}  // namespace aa
