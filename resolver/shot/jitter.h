// Jitter sequences (conventions 6).
//
// A jitter is the position of a frame's samples relative to their pixel centres, px, x right, y DOWN, each component in
// [-0.5, 0.5]. Names and numbers are those of the exporter's `--jitter`.
#pragma once
#include <glm/vec2.hpp>
#include <string_view>
#include <vector>

namespace aa {

struct JitterInfo {
    std::string_view name, meaning;
    int start;          // index of the first point
    int naturalPeriod;  // 0: any period
};
const std::vector<JitterInfo>& jitterSequences();
const JitterInfo& jitterSequence(std::string_view name);  // throws UsageError with a suggestion

struct JitterSpec {
    std::string_view sequence = "halton23";
    int start = -1;        // index of the first point; -1: the sequence's own. Only halton23 has a choice
    int period = 16;       // the block of points that repeats
    bool centred = false;  // subtract the block's mean, which a finite block of most sequences has not at 0
};
// Jitter of the index-th frame, from 0. Throws UsageError: unknown sequence, a start that the sequence has not.
glm::dvec2 jitterPx(const JitterSpec& spec, uint64_t index);

// Digits of `index` in `base` mirrored at the point; each digit d becomes permutation[d] when one is given.
double radicalInverse(uint32_t base, uint64_t index, const uint32_t* permutation = nullptr);

}  // namespace aa
