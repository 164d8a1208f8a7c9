#include "metrics/glance.h"

#include <algorithm>
#include <atomic>

#include "image/input_policy.h"

namespace aa {
namespace {
constexpr int kGlanceRows = 8;  // of three pictures of 1920 columns: 0.6 MB
}

Glance glance(const Rgb& resolved, const Rgb& shown, const Reference* reference, bool withLuma, const Exec& exec) {
    Glance g;
    if (withLuma) g.luma = PlaneF::unset(shown.width(), shown.height());
    std::optional<ReferenceErrors> errors;
    if (reference) errors.emplace(shown, *reference, exec);
    std::atomic<bool> isFinite = true;
    const auto look = [&](int y0, int y1) {
        const auto notFinite = [](float v) { return !aa::isFinite(v); };
        for (const PlaneF& plane : resolved.c)
            if (anyValueIn(plane, y0, y1, notFinite)) isFinite.store(false, std::memory_order_relaxed);
        if (withLuma) pictureLumaRows(shown, exec, y0, y1, g.luma);
        if (errors) errors->add(y0, y1);
    };
    forRows(exec, shown.height(), [&](int y0, int y1) {
        for (int y = y0; y < y1; y += kGlanceRows) look(y, std::min(y + kGlanceRows, y1));
    });
    g.isFinite = isFinite;
    g.luma.fillBorder();
    if (errors) g.errors = errors->total();
    return g;
}

}  // namespace aa
