#include "shot/segments.h"

#include <cmath>
#include <string>

#include "image/error.h"

namespace aa {
namespace {

std::array<float, 6> numbers(const EdgeSegment& s) { return {s.x0, s.y0, s.z0, s.x1, s.y1, s.z1}; }

// Index of the first number that makes a segment unusable, or -1.
int unusable(const std::array<float, 6>& n) {
    for (int i = 0; i < 6; i++) {
        const bool isDepth = i % 3 == 2;
        if (!std::isfinite(n[size_t(i)]) || (isDepth && n[size_t(i)] <= 0)) return i;
    }
    return -1;
}

}  // namespace

bool isUsable(const EdgeSegment& segment) { return unusable(numbers(segment)) < 0; }

SegmentPlanes packSegments(std::span<const EdgeSegment> segments) {
    const size_t count = std::max<size_t>(segments.size(), 1);
    const int width = int(std::min<size_t>(count, kSegmentsPerRow));
    const int height = int((count + kSegmentsPerRow - 1) / kSegmentsPerRow);
    SegmentPlanes planes;
    for (auto& p : planes) p = PlaneF(width, height);
    for (size_t i = 0; i < segments.size(); i++) {
        const auto n = numbers(segments[i]);
        for (size_t c = 0; c < 6; c++) planes[c].at(int(i % kSegmentsPerRow), int(i / kSegmentsPerRow)) = n[c];
    }
    return planes;
}

std::vector<EdgeSegment> unpackSegments(const SegmentPlanes& planes, InputPolicy policy, const PlaneName& name,
                                        SanitiseCounts& counts) {
    std::vector<EdgeSegment> segments;
    for (int y = 0; y < planes[0].height(); y++)
        for (int x = 0; x < planes[0].width(); x++) {
            std::array<float, 6> n;
            for (size_t c = 0; c < 6; c++) n[c] = planes[c].at(x, y);
            if (n[2] == 0) continue;
            const int bad = unusable(n);
            if (bad >= 0 && policy == InputPolicy::strict)
                throw InputError(name.where + ", channel '" + name.channels[size_t(bad)] + "', segment " +
                                 std::to_string(size_t(y) * size_t(planes[0].width()) + size_t(x)) + ": expected " +
                                 (bad % 3 == 2 ? "a finite depth > 0" : "a finite number") + ", found " +
                                 std::to_string(n[size_t(bad)]) + "; export the frame again");
            if (bad >= 0) counts.segments++;
            if (bad < 0 || policy == InputPolicy::raw) segments.push_back({n[0], n[1], n[2], n[3], n[4], n[5]});
        }
    return segments;
}

}  // namespace aa
