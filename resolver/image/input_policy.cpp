#include "image/input_policy.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "image/error.h"

namespace aa {
namespace {
constexpr std::pair<const char*, InputPolicy> kPolicies[] = {
    {"strict", InputPolicy::strict}, {"sanitise", InputPolicy::sanitise}, {"raw", InputPolicy::raw}};

// By integers: all of them are not negative.
bool isTooLarge(float v) { return std::bit_cast<int32_t>(v) > std::bit_cast<int32_t>(kLargestRadiance); }

void sanitiseChannel(PlaneF& plane, float ofInf, bool replace, ColourUse use, ColourCounts& counts) {
    // Neighbours are read as they came: a repaired pixel is no evidence for the next.
    std::vector<std::pair<float*, float>> repaired;
    for (int y = 0; y < plane.height(); y++)
        for (int x = 0; x < plane.width(); x++) {
            const float v = plane.at(x, y);
            if (std::isnan(v)) {
                double sum = 0;
                int n = 0;
                for (int j = std::max(y - 1, 0); j <= std::min(y + 1, plane.height() - 1); j++)
                    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, plane.width() - 1); i++)
                        if (isFinite(plane.at(i, j)))
                            sum += double(std::clamp(plane.at(i, j), 0.0f, kLargestRadiance)), n++;
                repaired.emplace_back(&plane.at(x, y), n ? float(sum / n) : 0.0f);
                counts.nan++;
            } else if (std::isinf(v)) {
                repaired.emplace_back(&plane.at(x, y), v > 0 ? ofInf : 0.0f);
                counts.inf++;
            } else if (v < 0 && use != ColourUse::measured) {
                repaired.emplace_back(&plane.at(x, y), 0.0f);
                counts.negative++;
            } else if (isTooLarge(v) && use == ColourUse::method) {
                repaired.emplace_back(&plane.at(x, y), kLargestRadiance);
                counts.large++;
            }
        }
    if (!replace) return;
    for (auto& [at, v] : repaired) *at = v;
}
}  // namespace

InputPolicy inputPolicyByName(const std::string& word) {
    for (const auto& [name, policy] : kPolicies)
        if (word == name) return policy;
    throw UsageError("--non-finite: expected strict, sanitise or raw, found '" + word + "'");
}

uint64_t nonFiniteValues(const Rgb& image) {
    uint64_t count = 0;
    for (const auto& plane : image.c)
        if (anyValue(plane, [](float v) { return !isFinite(v); }))
            for (int y = 0; y < plane.height(); y++)
                for (int x = 0; x < plane.width(); x++) count += !isFinite(plane.at(x, y));
    return count;
}

void refuseValue(const PlaneName& name, size_t channel, int x, int y, float found, const char* expected) {
    const std::string value = std::isnan(found)   ? "NaN"
                              : std::isinf(found) ? (found > 0 ? "+Inf" : "-Inf")
                                                  : std::to_string(found);
    throw InputError(name.where + ", channel '" + name.channels.at(channel) + "', pixel (" + std::to_string(x) + ", " +
                     std::to_string(y) + "): expected " + expected + ", found " + value + "; " + name.advice);
}

ColourCounts sanitiseColour(const std::array<PlaneF*, 3>& colour, bool storedAsHalf, InputPolicy policy, ColourUse use,
                            const PlaneName& name) {
    const bool limited = use == ColourUse::method;
    const auto refused = [limited](float v) { return uint32_t(!isFinite(v)) | uint32_t(limited & isTooLarge(v)); };
    if (policy == InputPolicy::strict)
        for (size_t c = 0; c < 3; c++)
            if (anyValue(*colour[c], refused))
                for (int y = 0; y < colour[c]->height(); y++)
                    for (int x = 0; x < colour[c]->width(); x++)
                        if (const float v = colour[c]->at(x, y); refused(v))
                            refuseValue(name, c, x, y, v, isFinite(v) ? "light of at most 1e18" : "a finite number");
    ColourCounts counts;
    for (PlaneF* plane : colour)
        if (anyValue(*plane, [&](float v) { return refused(v) | uint32_t(v < 0); }))
            sanitiseChannel(*plane, storedAsHalf ? 65504.0f : kLargestRadiance, policy != InputPolicy::raw, use,
                            counts);
    return counts;
}

std::string inWords(const ColourCounts& counts) {
    std::string words;
    for (const auto& [n, what] : {std::pair{counts.nan, "NaN"},
                                  {counts.inf, "Inf"},
                                  {counts.negative, "negative"},
                                  {counts.large, "above 1e18"}})
        if (n) words += (words.empty() ? "" : ", ") + std::to_string(n) + " " + what;
    return words;
}

}  // namespace aa
