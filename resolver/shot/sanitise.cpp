#include "shot/sanitise.h"

#include <atomic>
#include <bit>
#include <cmath>

#include "image/error.h"
#include "kernels/dispatch.h"

namespace aa {
namespace {
bool finite(float v) { return (std::bit_cast<uint32_t>(v) & 0x7f800000u) != 0x7f800000u; }

// Whether `bad` holds anywhere, row-parallel; integer tests only, so that the compiler makes lanes of it.
template <class Bad>
bool any(const PlaneF& plane, const Bad& bad) {
    std::atomic<bool> found = false;
    forRows(
        {}, plane.height(),
        [&](int y0, int y1) {
            for (int y = y0; y < y1; y++) {
                const float* row = plane.row(y);
                uint32_t rowBad = 0;
                for (int x = 0; x < plane.width(); x++) rowBad |= uint32_t(bad(row[x]));
                if (rowBad) found.store(true, std::memory_order_relaxed);
            }
        },
        32);
    return found;
}
template <class Fn>
void forPixels(const PlaneF& plane, const Fn& fn) {
    for (int y = 0; y < plane.height(); y++)
        for (int x = 0; x < plane.width(); x++) fn(x, y);
}

[[noreturn]] void reject(const PlaneName& name, size_t channel, int x, int y, float found, const char* expected) {
    const std::string value = std::isnan(found)   ? "NaN"
                              : std::isinf(found) ? (found > 0 ? "+Inf" : "-Inf")
                                                  : std::to_string(found);
    throw InputError(name.where + ", channel '" + name.channels[channel] + "', pixel (" + std::to_string(x) + ", " +
                     std::to_string(y) + "): expected " + expected + ", found " + value +
                     "; repair the render or let the input be sanitised");
}
// The first pixel, in row-major order of the first plane that has one, where `bad` holds.
template <class Bad>
void rejectBad(std::initializer_list<const PlaneF*> planes, const PlaneName& name, const char* expected,
               const Bad& bad) {
    size_t channel = 0;
    for (const PlaneF* p : planes) {
        if (any(*p, bad))
            forPixels(*p, [&](int x, int y) {
                if (bad(p->at(x, y))) reject(name, channel, x, y, p->at(x, y), expected);
            });
        channel++;
    }
}

void sanitiseChannel(PlaneF& plane, float maxFinite, SanitiseCounts& counts) {
    // Neighbours are read as they came: a repaired pixel is no evidence for the next.
    std::vector<std::pair<float*, float>> repaired;
    forPixels(plane, [&](int x, int y) {
        const float v = plane.at(x, y);
        if (std::isnan(v)) {
            double sum = 0;
            int n = 0;
            for (int j = std::max(y - 1, 0); j <= std::min(y + 1, plane.height() - 1); j++)
                for (int i = std::max(x - 1, 0); i <= std::min(x + 1, plane.width() - 1); i++)
                    if (finite(plane.at(i, j))) sum += std::max(plane.at(i, j), 0.0f), n++;
            repaired.emplace_back(&plane.at(x, y), n ? float(sum / n) : 0.0f);
            counts.colourNan++;
        } else if (std::isinf(v)) {
            repaired.emplace_back(&plane.at(x, y), v > 0 ? maxFinite : 0.0f);
            counts.colourInf++;
        } else if (v < 0) {
            repaired.emplace_back(&plane.at(x, y), 0.0f);
            counts.colourNegative++;
        }
    });
    for (auto& [at, v] : repaired) *at = v;
}

// Replaces a vector of which any component is not finite.
void replaceVectors(std::initializer_list<PlaneF*> planes, float value, uint64_t& count) {
    bool bad = false;
    for (const PlaneF* p : planes) bad = bad || any(*p, [](float v) { return !finite(v); });
    if (!bad) return;
    forPixels(**planes.begin(), [&](int x, int y) {
        bool vectorBad = false;
        for (const PlaneF* p : planes) vectorBad = vectorBad || !finite(p->at(x, y));
        if (!vectorBad) return;
        for (PlaneF* p : planes) p->at(x, y) = value;
        count++;
    });
}
void sanitiseVectors(std::initializer_list<PlaneF*> planes, float value, InputPolicy policy, const PlaneName& name,
                     uint64_t& count) {
    if (policy == InputPolicy::raw) return;
    if (policy == InputPolicy::sanitise) return replaceVectors(planes, value, count);
    size_t channel = 0;
    for (const PlaneF* p : planes)
        rejectBad({p}, {name.where, {name.channels[channel++]}}, "a finite number", [](float v) { return !finite(v); });
}
}  // namespace

namespace {
constexpr std::pair<const char*, uint64_t SanitiseCounts::*> kCounts[] = {
    {"colourNan", &SanitiseCounts::colourNan},
    {"colourInf", &SanitiseCounts::colourInf},
    {"colourNegative", &SanitiseCounts::colourNegative},
    {"depth", &SanitiseCounts::depth},
    {"normal", &SanitiseCounts::normal},
    {"motion", &SanitiseCounts::motion},
    {"edges", &SanitiseCounts::edges},
    {"segments", &SanitiseCounts::segments}};
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
    if (policy == InputPolicy::raw) return;
    if (policy == InputPolicy::strict)
        rejectBad({&real(planes, 0), &real(planes, 1), &real(planes, 2)}, name, "a finite number",
                  [](float v) { return !finite(v); });
    for (size_t c = 0; c < 3; c++)
        if (any(real(planes, c), [](float v) { return uint32_t(!finite(v)) | uint32_t(v < 0); }))
            sanitiseChannel(real(planes, c), storedAsHalf ? 65504.0f : 1e30f, counts);
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

void sanitiseColour(Rgb& colour, bool storedAsHalf, InputPolicy policy, const PlaneName& name, SanitiseCounts& counts) {
    const PlaneRef planes[] = {&colour.c[0], &colour.c[1], &colour.c[2]};
    sanitiseColourPlanes(planes, storedAsHalf, policy, name, counts);
}

void sanitiseDepth(PlaneF& depth, InputPolicy policy, const PlaneName& name, SanitiseCounts& counts) {
    if (policy == InputPolicy::raw) return;
    const auto bad = [](float v) { return uint32_t(!(v > 0)) | uint32_t(!finite(v)); };
    if (policy == InputPolicy::strict) rejectBad({&depth}, name, "a finite depth > 0", bad);
    if (!any(depth, [&](float v) { return bad(v) | (uint32_t(v > 1e9f) & uint32_t(v != kBackgroundDepth)); })) return;
    forPixels(depth, [&](int x, int y) {
        float& v = depth.at(x, y);
        if (bad(v)) counts.depth++;
        if (bad(v) || v > 1e9f) v = kBackgroundDepth;
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
