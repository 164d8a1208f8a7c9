#include "metrics/non_finite.h"

#include "image/input_policy.h"

namespace aa {

void putFarthest(const Rgb* source, const Rgb* referenceSource, const Rgb& reference, Rgb& encoded) {
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < encoded.height(); y++)
            for (int x = 0; x < encoded.width(); x++) {
                const auto broken = [&](const Rgb* of) { return of && !isFinite(of->c[c].at(x, y)); };
                if (!broken(source) && !broken(referenceSource)) continue;
                encoded.c[c].at(x, y) = reference.c[c].at(x, y) < 0.5f ? 1.0f : 0.0f;
            }
    encoded.fillBorder();
}

}  // namespace aa
