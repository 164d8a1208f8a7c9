#include "shot/sanitise.h"

#include "image/error.h"

namespace aa {
namespace {
template <class Fn>
void forPixels(const PlaneF& plane, const Fn& fn) {
    for (int y = 0; y < plane.height(); y++)
        for (int x = 0; x < plane.width(); x++) fn(x, y);
}

// The first pixel, in row-major order of the first plane that has one, where `bad` holds.
template <class Bad>
void rejectBad(std::initializer_list<const PlaneF*> planes, const PlaneName& name, const char* expected,
               const Bad& bad) {
    size_t channel = 0;
    for (const PlaneF* p : planes) {
        if (anyValue(*p, bad))
            forPixels(*p, [&](int x, int y) {
                if (bad(p->at(x, y))) refuseValue(name, channel, x, y, p->at(x, y), expected);
            });
        channel++;
    }
}

// Replaces a vector of which any component is not finite.
void replaceVectors(std::initializer_list<PlaneF*> planes, float value, bool replace, uint64_t& count) {
    bool bad = false;
    for (const PlaneF* p : planes) bad = bad || anyValue(*p, [](float v) { return !isFinite(v); });
    if (!bad) return;
    forPixels(**planes.begin(), [&](int x, int y) {
        bool vectorBad = false;
        for (const PlaneF* p : planes) vectorBad = vectorBad || !isFinite(p->at(x, y));
        if (!vectorBad) return;
        for (PlaneF* p : planes)
            if (replace) p->at(x, y) = value;
        count++;
    });
}
void sanitiseVectors(std::initializer_list<PlaneF*> planes, float value, InputPolicy policy, const PlaneName& name,
                     uint64_t& count) {
    if (policy != InputPolicy::strict) return replaceVectors(planes, value, policy != InputPolicy::raw, count);
    size_t channel = 0;
    for (const PlaneF* p : planes)
        rejectBad({p}, {name.where, {name.channels[channel++]}, name.advice}, "a finite number",
                  [](float v) { return !isFinite(v); });
}
}  // namespace

namespace {
constexpr std::pair<const char*, uint64_t SanitiseCounts::*> kCounts[] = {
    {"colourNan", &SanitiseCounts::colourNan},
    {"colourInf", &SanitiseCounts::colourInf},
    {"colourNegative", &SanitiseCounts::colourNegative},
    {"colourLarge", &SanitiseCounts::colourLarge},
    {"depth", &SanitiseCounts::depth},
    {"normal", &SanitiseCounts::normal},
    {"motion", &SanitiseCounts::motion},
    {"edges", &SanitiseCounts::edges},
    {"segments", &SanitiseCounts::segments},
    {"truthNan", &SanitiseCounts::truthNan},
    {"truthInf", &SanitiseCounts::truthInf},
    {"truthNegative", &SanitiseCounts::truthNegative}};
static_assert(sizeof(SanitiseCounts) == std::size(kCounts) * sizeof(uint64_t));
}  // namespace

SanitiseCounts& SanitiseCounts::operator+=(const SanitiseCounts& o) {
    for (const auto& [name, count] : kCounts) this->*count += o.*count;
    return *this;
}
uint64_t SanitiseCounts::total() const {
    uint64_t all = 0;
    for (const auto& [name, count] : kCounts) all += this->*count;
    return all;
}
std::map<std::string, uint64_t> counted(const SanitiseCounts& counts) {
    std::map<std::string, uint64_t> named;
    if (counts.total() > 0)
        for (const auto& [name, count] : kCounts) named[name] = counts.*count;
    return named;
}

namespace {
using Planes = std::span<const PlaneRef>;
PlaneF& real(Planes planes, size_t i) { return *std::get<PlaneF*>(planes[i]); }
}  // namespace

void sanitiseColourPlanes(Planes planes, bool storedAsHalf, InputPolicy policy, const PlaneName& name,
                          SanitiseCounts& counts) {
    const ColourCounts found = sanitiseColour({&real(planes, 0), &real(planes, 1), &real(planes, 2)}, storedAsHalf,
                                              policy, ColourUse::method, name);
    counts.colourNan += found.nan, counts.colourInf += found.inf, counts.colourNegative += found.negative;
    counts.colourLarge += found.large;
}
void sanitiseDepthPlanes(Planes planes, bool, InputPolicy policy, const PlaneName& name, SanitiseCounts& counts) {
    sanitiseDepth(real(planes, 0), policy, name, counts);
}
void sanitiseNormalPlanes(Planes planes, bool, InputPolicy policy, const PlaneName& name, SanitiseCounts& counts) {
    sanitiseVectors({&real(planes, 0), &real(planes, 1), &real(planes, 2)}, 0.0f, policy, name, counts.normal);
}
void sanitiseMotionPlanes(Planes planes, bool, InputPolicy policy, const PlaneName& name, SanitiseCounts& counts) {
    sanitiseMotion(real(planes, 0), real(planes, 1), policy, name, counts);
}
void sanitiseEdgesPlanes(Planes planes, bool, InputPolicy policy, const PlaneName& name, SanitiseCounts& counts) {
    sanitiseEdges(real(planes, 0), real(planes, 1), policy, name, counts);
}

void sanitiseDepth(PlaneF& depth, InputPolicy policy, const PlaneName& name, SanitiseCounts& counts) {
    const auto bad = [](float v) { return uint32_t(!(v > 0)) | uint32_t(!isFinite(v)); };
    if (policy == InputPolicy::strict) rejectBad({&depth}, name, "a finite depth > 0", bad);
    if (!anyValue(depth, [&](float v) { return bad(v) | (uint32_t(v > 1e9f) & uint32_t(v != kBackgroundDepth)); }))
        return;
    forPixels(depth, [&](int x, int y) {
        float& v = depth.at(x, y);
        if (bad(v)) counts.depth++;
        if (policy != InputPolicy::raw && (bad(v) || v > 1e9f)) v = kBackgroundDepth;
    });
}

void sanitiseNormal(Rgb& normal, InputPolicy policy, const PlaneName& name, SanitiseCounts& counts) {
    sanitiseVectors({&normal.c[0], &normal.c[1], &normal.c[2]}, 0.0f, policy, name, counts.normal);
}
void sanitiseMotion(PlaneF& x, PlaneF& y, InputPolicy policy, const PlaneName& name, SanitiseCounts& counts) {
    sanitiseVectors({&x, &y}, kInvalidMotionPx, policy, name, counts.motion);
}
void sanitiseEdges(PlaneF& x, PlaneF& y, InputPolicy policy, const PlaneName& name, SanitiseCounts& counts) {
    sanitiseVectors({&x, &y}, 0.5f, policy, name, counts.edges);
}

}  // namespace aa
