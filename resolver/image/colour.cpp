#include "image/colour.h"

#include <cmath>
#include <limits>

#include "image/colour_kernels.h"

namespace aa {
namespace {
ColourArgs colourArgs(const Rgb& in, Rgb& out, const DisplayChain& chain) {
    if (out.width() != in.width() || out.height() != in.height()) out = Rgb::unset(in.width(), in.height());
    return {view(in), view(out), in.stride(), in.width(), displayArgs(chain)};
}
}  // namespace

DisplayArgs displayArgs(const DisplayChain& chain) {
    return {std::exp2(chain.exposure), int(chain.toneMap), chain.transfer == Transfer::srgb};
}

void encode(const Rgb& linear, const DisplayChain& chain, const Exec& exec, Rgb& encoded) {
    const auto args = colourArgs(linear, encoded, chain);
    runKernel(colourKernelsFor(exec).encode, exec, args, linear.height());
    encoded.fillBorder();
}

void decode(const Rgb& encoded, const DisplayChain& chain, const Exec& exec, Rgb& linear) {
    const auto args = colourArgs(encoded, linear, chain);
    runKernel(colourKernelsFor(exec).decode, exec, args, encoded.height());
    linear.fillBorder();
}

double displayCeiling(const DisplayChain& chain) {
    const double scale = std::exp2(double(chain.exposure));
    switch (chain.toneMap) {
        case ToneMap::none:
            return 1 / scale;
        case ToneMap::reinhard:
            return std::numeric_limits<double>::infinity();
        case ToneMap::aces:  // x (2.51 x + .03) = x (2.43 x + .59) + .14
            return (0.56 + std::sqrt(0.56 * 0.56 + 4 * 0.08 * 0.14)) / (2 * 0.08) / scale;
    }
    return 1;
}

size_t clippedPixels(const Rgb& linear, const DisplayChain& chain) {
    const double ceiling = displayCeiling(chain);
    size_t count = 0;
    for (int y = 0; y < linear.height(); y++)
        for (int x = 0; x < linear.width(); x++) {
            const auto outside = [&](size_t c) {
                const double v = double(linear.c[c].at(x, y));
                return v > ceiling || v < 0;
            };
            count += outside(0) || outside(1) || outside(2);
        }
    return count;
}

}  // namespace aa
