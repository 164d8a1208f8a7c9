#include "image/colour.h"

#include <cmath>

#include "image/colour_kernels.h"

namespace aa {
namespace {
ColourArgs colourArgs(const Rgb& in, Rgb& out, const DisplayChain& chain) {
    if (out.width() != in.width() || out.height() != in.height()) out = Rgb(in.width(), in.height());
    return {view(in), view(out), in.stride(), in.width(), std::exp2(chain.exposure), int(chain.toneMap)};
}
}  // namespace

void encode(const Rgb& linear, const DisplayChain& chain, const Exec& exec, Rgb& encoded) {
    const auto args = colourArgs(linear, encoded, chain);
    runKernel(colourKernelsFor(exec.isa).encode, exec, args, linear.height());
    encoded.fillBorder();
}

void decode(const Rgb& encoded, const Exec& exec, Rgb& linear) {
    const auto args = colourArgs(encoded, linear, {});
    runKernel(colourKernelsFor(exec.isa).decode, exec, args, encoded.height());
    linear.fillBorder();
}

}  // namespace aa
