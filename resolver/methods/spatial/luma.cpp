#include "methods/spatial/luma.h"

#include "methods/spatial/luma_kernels.h"

namespace aa {

namespace {
void run(const Rgb& color, LumaArgs args, const Exec& exec, PlaneF& luma) {
    if (luma.width() != color.width() || luma.height() != color.height()) luma = PlaneF(color.width(), color.height());
    args.in = view(color), args.luma = luma.row(0);
    args.stride = color.stride(), args.lumaStride = luma.stride(), args.width = color.width();
    runKernel(lumaKernelsFor(exec).luma, exec, args, color.height());
    luma.fillBorder();
}
}  // namespace

void lumaPlane(const Rgb& color, LumaKind kind, const Exec& exec, PlaneF& luma) {
    LumaArgs args{};
    args.kind = kind;
    run(color, args, exec, luma);
}
void encodedLumaPlane(const Rgb& linear, const DisplayChain& display, const Exec& exec, PlaneF& luma) {
    LumaArgs args{};
    args.kind = LumaKind::rec709, args.encodes = true, args.display = displayArgs(display);
    run(linear, args, exec, luma);
}

}  // namespace aa
