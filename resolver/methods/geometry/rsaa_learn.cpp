#include "methods/geometry/rsaa_learn.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <string>

#include "image/split_mix64.h"
#include "shot/patterns.h"

namespace aa {
namespace {

using glm::dvec2;

constexpr int kAngles = 720, kDistances = 301;     // decisions 33
constexpr int kWedges = 200000, kStrips = 100000;  // ditto
constexpr double kReachPx = 0.75;                  // ditto; a line farther than 0.71 px misses the pixel
constexpr double kMinorClassMass = 0.25;           // ditto: wedges and strips against half-planes
constexpr double kRegularisation = 1e-4;           // ditto
constexpr uint64_t kLeastCases = 20;               // ditto
constexpr uint64_t kSeed = 0x5eed;

// cos and sin of 2 pi t, 0 <= t < 1, without libm: Taylor series on an eighth of a turn, error below 1e-15.
dvec2 unitVector(double turns) {
    const double quarter = std::floor(4 * turns + 0.5);
    const double a = 6.283185307179586 * (turns - quarter / 4), a2 = a * a;
    double s = 0, c = 0;
    for (int k = 9; k >= 1; k--) {
        s = (1 + s) * (-a2 / double((2 * k) * (2 * k + 1)));
        c = (1 + c) * (-a2 / double((2 * k - 1) * (2 * k)));
    }
    s = a * (1 + s), c = 1 + c;
    switch (int(quarter) & 3) {
        case 0:
            return {c, s};
        case 1:
            return {-s, c};
        case 2:
            return {-c, -s};
        default:
            return {s, -c};
    }
}

struct Random : SplitMix64 {
    using SplitMix64::SplitMix64;
    double uniform(double lo, double hi) { return lo + (hi - lo) * uniformDouble(); }
};

struct HalfPlane {  // the points p with n.p > r
    dvec2 n;
    double r;
    bool has(dvec2 p) const { return n.x * p.x + n.y * p.y > r; }
};
using Shape = std::array<HalfPlane, 2>;  // their intersection; a half-plane is given twice
bool has(const Shape& s, dvec2 p) { return s[0].has(p) && s[1].has(p); }

// Area of the shape inside the pixel, the unit square about the origin: Sutherland-Hodgman, then the shoelace formula.
double coverage(const Shape& shape) {
    std::array<dvec2, 8> polygon = {dvec2{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
    size_t count = 4;
    for (const HalfPlane& h : shape) {
        std::array<dvec2, 8> kept;
        size_t n = 0;
        for (size_t i = 0; i < count; i++) {
            const dvec2 a = polygon[i], b = polygon[(i + 1) % count];
            const double da = h.n.x * a.x + h.n.y * a.y - h.r, db = h.n.x * b.x + h.n.y * b.y - h.r;
            if (da > 0) kept[n++] = a;
            if ((da > 0) != (db > 0)) kept[n++] = a + (b - a) * (da / (da - db));
        }
        polygon = kept, count = n;
    }
    double twice = 0;
    for (size_t i = 0; i < count; i++) {
        const dvec2 a = polygon[i], b = polygon[(i + 1) % count];
        twice += a.x * b.y - a.y * b.x;
    }
    return twice / 2;
}

// In the quadrant of offsets with given signs, a bilinear fetch from the 3x3 picture whose centre is 1 leaves the error
// d - a |u| - b |v| - c |u||v|. Sums of the products of (d, a, b, c) over the cases of one mask:
struct Moments {
    double dd = 0, da = 0, db = 0, dc = 0, aa = 0, ab = 0, ac = 0, bb = 0, bc = 0, cc = 0;
    void add(double weight, double d, double a, double b, double c) {
        dd += weight * d * d, da += weight * d * a, db += weight * d * b, dc += weight * d * c;
        aa += weight * a * a, ab += weight * a * b, ac += weight * a * c;
        bb += weight * b * b, bc += weight * b * c, cc += weight * c * c;
    }
    double squaredError(double u, double v) const {
        const double w = u * v;
        return dd + u * (u * aa - 2 * da) + v * (v * bb - 2 * db) + w * (w * cc - 2 * dc) +
               2 * (u * v * ab + u * w * ac + v * w * bc);
    }
};
struct MaskCases {
    std::array<Moments, 4> quadrant;  // index: (u >= 0) + 2 (v >= 0)
    double weight = 0;
    uint64_t count = 0;

    double objective(double u, double v) const {
        const auto& m = quadrant[size_t(u >= 0) + 2 * size_t(v >= 0)];
        return m.squaredError(std::abs(u), std::abs(v)) + kRegularisation * (u * u + v * v) * weight;
    }
};

class TrainingSet {
  public:
    explicit TrainingSet(const std::vector<dvec2>& positionsPx)
        : positionsPx_(positionsPx), masks_(size_t(1) << positionsPx.size()) {}

    // One picture: the shape in one colour, the rest in the other. Which colour is which cannot matter, because the
    // mask is relative to the centre and the error to the square.
    void add(const Shape& shape, double weight) {
        const bool centre = has(shape, {0, 0});
        uint32_t mask = 0;
        for (size_t k = 0; k < positionsPx_.size(); k++) mask |= uint32_t(has(shape, positionsPx_[k]) == centre) << k;
        if (mask + 1 == masks_.size()) return;  // all ones: never resampled
        const double area = coverage(shape), like = centre ? area : 1 - area;
        const auto cell = [&](int x, int y) { return has(shape, dvec2(x, y)) == centre ? 1.0 : 0.0; };
        MaskCases& cases = masks_[mask];
        for (size_t q = 0; q < 4; q++) {
            const int sx = q & 1 ? 1 : -1, sy = q & 2 ? 1 : -1;
            const double cx = cell(sx, 0), cy = cell(0, sy), cxy = cell(sx, sy);
            cases.quadrant[q].add(weight, like - 1, cx - 1, cy - 1, 1 - cx - cy + cxy);
        }
        cases.weight += weight;
        cases.count++;
    }
    const std::vector<MaskCases>& masks() const { return masks_; }

  private:
    const std::vector<dvec2>& positionsPx_;
    std::vector<MaskCases> masks_;
};

void addHalfPlanes(TrainingSet& set) {
    for (int i = 0; i < kAngles; i++)
        for (int j = 0; j < kDistances; j++) {
            const HalfPlane h{unitVector((i + 0.5) / kAngles), kReachPx * (2.0 * j / (kDistances - 1) - 1)};
            set.add({h, h}, 1);
        }
}
void addWedges(TrainingSet& set, Random& random) {
    for (int i = 0; i < kWedges; i++) {
        const dvec2 n0 = unitVector(random.uniform(0, 1)), n1 = unitVector(random.uniform(0, 1));
        const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
        set.add({HalfPlane{n0, n0.x * x + n0.y * y}, HalfPlane{n1, n1.x * x + n1.y * y}},
                kMinorClassMass * kAngles * kDistances / kWedges);
    }
}
void addStrips(TrainingSet& set, Random& random) {
    for (int i = 0; i < kStrips; i++) {
        const dvec2 n = unitVector(random.uniform(0, 1));
        const double half = random.uniform(0.2, 1.5) / 2, c = random.uniform(-1, 1) * (kReachPx + half);
        set.add({HalfPlane{n, c - half}, HalfPlane{-n, -c - half}}, kMinorClassMass * kAngles * kDistances / kStrips);
    }
}

// Grid of 1/32 px over [-1, 1]^2, then three rounds on the 3x3 neighbours at half the step. Ties: smallest |uv|.
RsaaEntry bestOffset(uint32_t mask, const MaskCases& cases) {
    int bestU = 0, bestV = 0;
    double best = INFINITY;
    const auto offer = [&](int u, int v) {
        if (std::max(std::abs(u), std::abs(v)) > 256) return;
        const double e = cases.objective(u * kRsaaOffsetUnitPx, v * kRsaaOffsetUnitPx);
        if (e < best || (e == best && u * u + v * v < bestU * bestU + bestV * bestV)) best = e, bestU = u, bestV = v;
    };
    for (int v = -256; v <= 256; v += 8)
        for (int u = -256; u <= 256; u += 8) offer(u, v);
    for (const int step : {4, 2, 1}) {
        const int u0 = bestU, v0 = bestV;
        for (int dv = -step; dv <= step; dv += step)
            for (int du = -step; du <= step; du += step) offer(u0 + du, v0 + dv);
    }
    return {mask, int16_t(bestU), int16_t(bestV)};
}

}  // namespace

std::vector<dvec2> d3dPattern(size_t samples) { return patternPositionsPx("d3d" + std::to_string(samples)); }

std::vector<RsaaEntry> learnRsaa(const std::vector<dvec2>& positionsPx, RsaaTraining training) {
    assert(!positionsPx.empty() && positionsPx.size() <= kRsaaMaxSamples);
    TrainingSet set(positionsPx);
    Random random(kSeed);
    addHalfPlanes(set);
    if (training == RsaaTraining::all) {
        addWedges(set, random);
        addStrips(set, random);
    }
    std::vector<RsaaEntry> entries;
    for (uint32_t mask = 0; mask < set.masks().size(); mask++)
        if (set.masks()[mask].count >= kLeastCases) entries.push_back(bestOffset(mask, set.masks()[mask]));
    return entries;
}

std::vector<float> rsaaTable(size_t samples, std::span<const RsaaEntry> trained) {
    const uint32_t masks = 1u << samples;
    std::vector<float> table(size_t(masks) * 2, 0.0f);
    for (uint32_t mask = 0; mask + 1 < masks; mask++) {
        int nearest = int(samples) + 1, count = 0, u = 0, v = 0;
        for (const RsaaEntry& e : trained) {
            const int distance = std::popcount(e.mask ^ mask);
            if (distance < nearest) nearest = distance, count = 0, u = 0, v = 0;
            if (distance == nearest) count++, u += e.u, v += e.v;
        }
        if (!count) continue;  // nothing was learned
        table[2 * mask] = float(u * kRsaaOffsetUnitPx / count);
        table[2 * mask + 1] = float(v * kRsaaOffsetUnitPx / count);
    }
    return table;
}

RsaaErrors halfPlaneErrors(const std::vector<dvec2>& positionsPx, const std::vector<float>& table) {
    constexpr int kCases = 100000;  // conventions 14
    RsaaErrors sum;
    Random random(kSeed + 1);  // not the seed of the training
    for (int i = 0; i < kCases; i++) {
        const dvec2 n = unitVector(random.uniform(0, 1));
        const HalfPlane h{n, random.uniform(-kReachPx, kReachPx)};
        const Shape shape = {h, h};
        const auto value = [&](dvec2 p) { return has(shape, p) ? 1.0 : 0.0; };
        const double centre = value({0, 0}), truth = coverage(shape);
        double mean = 0;
        uint32_t mask = 0;
        for (size_t k = 0; k < positionsPx.size(); k++) {
            const double v = value(positionsPx[k]);
            mean += v / double(positionsPx.size());
            mask |= uint32_t(v == centre) << k;
        }
        const double u = double(table[2 * mask]), v = double(table[2 * mask + 1]), fx = std::abs(u), fy = std::abs(v);
        const double sx = u < 0 ? -1 : 1, sy = v < 0 ? -1 : 1;
        const double resampled = (1 - fx) * (1 - fy) * centre + fx * (1 - fy) * value({sx, 0}) +
                                 (1 - fx) * fy * value({0, sy}) + fx * fy * value({sx, sy});
        sum.noaa += (centre - truth) * (centre - truth) / kCases;
        sum.msaa += (mean - truth) * (mean - truth) / kCases;
        sum.rsaa += (resampled - truth) * (resampled - truth) / kCases;
    }
    return sum;
}

}  // namespace aa
