// What is done with values that no method and no figure can use: one policy for every command that reads pictures
// (conventions 8). Whatever it is, such values are counted, and no figure calls a picture good that holds them.
#pragma once
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "image/plane.h"
#include "kernels/dispatch.h"

namespace aa {

enum class InputPolicy {
    strict,    // any NaN, Inf or depth <= 0 is an InputError naming file, plane and pixel
    sanitise,  // replaced by the rules of conventions 8
    raw,       // as stored
};
// Of the command line's word. Throws UsageError.
InputPolicy inputPolicyByName(const std::string& word);

// Names a plane in the errors of strict.
struct PlaneName {
    std::string where;  // "SHOT/frames/000001.exr: frame 1, part 'color'"
    std::vector<std::string> channels;
    std::string advice = "repair the render, or let the input be repaired with --non-finite sanitise";
};
[[noreturn]] void refuseValue(const PlaneName& name, size_t channel, int x, int y, float found, const char* expected);

// The largest radiance that methods take: its square is a float, and so are the products of two such differences.
inline constexpr float kLargestRadiance = 1e18f;

// Pixels times channels of a colour.
struct ColourCounts {
    uint64_t nan = 0, inf = 0, negative = 0, large = 0;
    uint64_t nonFinite() const { return nan + inf; }
};
// What a colour is read for. A method takes 0 to kLargestRadiance; the truth's radiance is not negative; what is
// measured may be both.
enum class ColourUse { method, truth, measured };

// Under sanitise: NaN -> mean of the finite pixels of its 3x3 (none finite: 0), +Inf and what is too large ->
// kLargestRadiance (Inf of half: 65504), -Inf and negative -> 0. Under strict what is not finite or too large throws,
// and negative becomes 0, too. The border is not touched.
ColourCounts sanitiseColour(const std::array<PlaneF*, 3>& colour, bool storedAsHalf, InputPolicy policy, ColourUse use,
                            const PlaneName& name);
inline ColourCounts sanitiseColour(Rgb& colour, bool storedAsHalf, InputPolicy policy, ColourUse use,
                                   const PlaneName& name) {
    return sanitiseColour({&colour.c[0], &colour.c[1], &colour.c[2]}, storedAsHalf, policy, use, name);
}

inline bool isFinite(float v) { return (std::bit_cast<uint32_t>(v) & 0x7f800000u) != 0x7f800000u; }
// Whether `bad` holds anywhere in rows [y0, y1); give it integer tests only, so that the compiler makes lanes of it.
template <class Bad>
bool anyValueIn(const PlaneF& plane, int y0, int y1, const Bad& bad) {
    for (int y = y0; y < y1; y++) {
        const float* row = plane.row(y);
        uint32_t rowBad = 0;
        for (int x = 0; x < plane.width(); x++) rowBad |= uint32_t(bad(row[x]));
        if (rowBad) return true;
    }
    return false;
}
// Anywhere, row-parallel.
template <class Bad>
bool anyValue(const PlaneF& plane, const Bad& bad) {
    std::atomic<bool> found = false;
    forRows(
        {}, plane.height(),
        [&](int y0, int y1) {
            if (anyValueIn(plane, y0, y1, bad)) found.store(true, std::memory_order_relaxed);
        },
        32);
    return found;
}
uint64_t nonFiniteValues(const Rgb& image);       // pixels times channels
std::string inWords(const ColourCounts& counts);  // "12 NaN, 1 Inf"

}  // namespace aa
