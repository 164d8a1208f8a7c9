#include "methods/asymmetry.h"

#include <utility>

namespace aa {

std::string_view knownAsymmetry(std::string_view method) {
    static constexpr std::pair<std::string_view, std::string_view> table[] = {
        {"fxaa1",
         "where both sides of a line differ alike the upper or left one is taken, and a tie of directions is "
         "horizontal"},
        {"fxaa311",
         "where both sides of a line differ alike the upper or left one is taken, and a tie of directions is "
         "horizontal"},
        {"fxaacs",
         "where both sides of a line differ alike the lower or right one is taken, and a tie of directions is "
         "horizontal"},
        {"fxaaconsole", "one corner is biased by 1/384, so that the direction of a saddle does not vanish"},
        {"mlaa", "horizontal lines are blended first, vertical ones on their result"},
        {"smaa1x",
         "an edge yields to stronger ones two pixels to the left or above but not to the right or below, the "
         "left search is one pixel shorter, and symmetric corners blend vertically"},
        {"dlaa",
         "vertical blurs count half of horizontal ones, and long edges are matched on the left and above first"},
    };
    for (const auto& [id, sentence] : table)
        if (id == method) return sentence;
    return {};
}

}  // namespace aa
