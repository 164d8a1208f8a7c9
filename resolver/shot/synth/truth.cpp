#include "shot/synth/truth.h"

#include <algorithm>
#include <glm/common.hpp>

#include "kernels/dispatch.h"
#include "shot/synth/sampler.h"

namespace aa {
using glm::dvec2;
using glm::dvec3;

namespace {
// Of a pixel that an outline crosses.
dvec3 areaColor(const PlacedRow& row, int x, int y, dvec3 background) {
    const Polygon pixel = rectangle(x, y, x + 1, y + 1);
    const auto holdsPixel = [&](const Placed* p) {
        return std::all_of(pixel.begin(), pixel.end(), [&](dvec2 corner) { return contains(p->region, corner); });
    };
    std::vector<const Region*> regions;
    std::vector<dvec3> colors;
    bool covered = false;
    for (const Placed* p : row.near(x)) {
        if (p->bounds.min.y > y + 1 || p->bounds.max.y < y) continue;
        if (p->bounds.min.x >= x + 1 || p->bounds.max.x <= x) continue;
        regions.push_back(&p->region);
        colors.push_back(p->shape->color);
        if ((covered = holdsPixel(p))) break;
    }
    if (regions.size() <= size_t(covered)) return covered ? colors[0] : background;  // no rounding of areas
    const std::vector<double> areas = visibleAreas(pixel, regions);
    dvec3 sum = areas.back() * (covered ? colors.back() : background);
    for (size_t i = 0; i < colors.size(); i++) sum += areas[i] * colors[i];
    return glm::max(sum, dvec3(0.0));
}

// Repeatable offset of a stratum's sample, in [0,1)^2.
dvec2 stratumOffset(uint32_t x, uint32_t y, uint32_t stratum, uint32_t half) {
    uint32_t h =
        x * 0x9E3779B1u ^ y * 0x85EBCA77u ^ stratum * 0xC2B2AE3Du ^ (half + 1) * 0x27D4EB2Fu;  // xxHash's primes
    const auto next = [&h] {
        h ^= h >> 15;
        h *= 0x2C1B3C6Du;
        h ^= h >> 12;
        h *= 0x297A2D39u;
        h ^= h >> 15;
        return h / 4294967296.0;
    };
    const double u = next(), v = next();
    return {u, v};
}
}  // namespace

void areaTruth(const std::vector<Placed>& frontToBack, dvec3 background, Rgb& to) {
    const auto shapes = shapesOfRows(frontToBack, to.height(), 0);
    forRows({}, to.height(), [&](int y0, int y1) {
        for (int y = y0; y < y1; y++) {
            const PlacedRow row(shapes[size_t(y)], y, to.width(), 0);
            dvec3 color(0.0);
            for (int x = 0; x < to.width(); x++) {
                if (row.isCrossed(x)) {
                    put(to, x, y, areaColor(row, x, y, background));
                    continue;
                }
                if (x == 0 || row.isCrossed(x - 1)) {  // of all pixels from here to the next outline
                    const Placed* hit = row.frontMost(x, {x + 0.5, y + 0.5});
                    color = hit ? hit->shape->color : background;
                }
                put(to, x, y, color);
            }
        }
    });
}

void zonePlateTruth(uint32_t half, Rgb& to) {
    const int width = to.width(), height = to.height();
    forRows({}, height, [&](int y0, int y1) {
        for (int y = y0; y < y1; y++)
            for (int x = 0; x < width; x++) {
                double sum = 0;
                for (uint32_t k = 0; k < kZonePlateStrata * kZonePlateStrata; k++) {
                    const dvec2 o = stratumOffset(uint32_t(x), uint32_t(y), k, half);
                    sum += zonePlateValue({x + (k % kZonePlateStrata + o.x) / kZonePlateStrata,
                                           y + (k / kZonePlateStrata + o.y) / kZonePlateStrata},
                                          width, height);
                }
                put(to, x, y, dvec3(sum / (kZonePlateStrata * kZonePlateStrata)));
            }
    });
}

}  // namespace aa
