#include "methods/reference/noaa.h"

namespace aa {
namespace {
class NoAa : public Method {
    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        forRows(exec, frame.height, [&](int y0, int y1) {
            for (size_t c = 0; c < 3; c++)
                for (int y = y0; y < y1; y++) std::copy_n(frame.colorLinear.c[c].row(y), frame.width, out.c[c].row(y));
        });
    }
};
}  // namespace

MethodDescriptor noaaDescriptor() {
    return {.id = "noaa",
            .title = "No anti-aliasing",
            .family = "reference",
            .summary = "The colour samples as they are: the lower baseline.",
            .source = "the shot's own samples",
            .passes = Pass::color,
            .create = [](const Params&, const ShotInfo&) { return std::make_unique<NoAa>(); }};
}
}  // namespace aa
