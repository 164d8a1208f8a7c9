#include "methods/float_bounds.h"

namespace aa {

std::span<const FloatBound> writtenFloatBounds() {
    static constexpr FloatBound table[] = {
        {"fxaacs", "shifts in steps of 1/128 px: one at the boundary of two steps falls on either side", 2e-2},
        {"dlaa", "a blur's share of a bright neighbour is taken off again"},
        {"sraa", "sums about the pixel's own colour, which may be the bright one"},
        {"smaaS2x", "a bright pixel that is blended nearly whole into a dark one"},
        {"smaaT2x", "a bright pixel that is blended nearly whole into a dark one"},
        {"smaa4x", "a bright pixel that is blended nearly whole into a dark one"},
        {"uncharted", "sharpening takes bright neighbours off a dark value"},
        {"unchartedNorm", "sharpening takes bright neighbours off a dark value"},
        {"master", "the blend's step from a bright history to a dark colour"},
        {"raptor", "sharpening takes bright neighbours off a dark value"},
        {"falcor", "a dark channel is a difference of luminance and chroma"},
        {"salvi", "weights 1 / (1 + Y): 1 - k of 1e-6 keeps one digit", 2e-2},
        {"karis", "weights 1 / (1 + Y): 1 - k of 1e-6 keeps one digit", 1e-2},
        {"fsr2n", "the tone-mapped space ends at 1, which float meets in steps of 6e-8", 1e-2},
    };
    return table;
}
const FloatBound* writtenFloatBound(std::string_view method) {
    for (const FloatBound& b : writtenFloatBounds())
        if (b.method == method) return &b;
    return nullptr;
}

}  // namespace aa
