#include "methods/spatial/luma.h"

#include "methods/spatial/luma_kernels.h"

namespace aa {

void lumaPlane(const Rgb& color, LumaKind kind, const Exec& exec, PlaneF& luma) {
    if (luma.width() != color.width() || luma.height() != color.height()) luma = PlaneF(color.width(), color.height());
    const LumaArgs args{view(color), luma.row(0), color.stride(), luma.stride(), color.width(), kind};
    runKernel(lumaKernelsFor(exec).luma, exec, args, color.height());
    luma.fillBorder();
}

}  // namespace aa
