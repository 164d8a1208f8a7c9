// What commonly goes wrong in a render that is to become a shot, as far as the files and pixels show it.
#pragma once
#include "shot/frame.h"
#include "shot/import/blender_exr.h"

namespace aa {

// Warnings that one file's header allows: lossy compression, half-float data, the number of samples.
std::vector<std::string> headerPitfalls(const BlenderExr& file);

// Counts over a frame's pixels; both are shares that mean something from kFewest on.
struct EdgeCounts {
    uint64_t sharp = 0, blended = 0;  // pixels at edges between flat sides: of one side's colour, or in between
    EdgeCounts& operator+=(const EdgeCounts& o) {
        sharp += o.sharp, blended += o.blended;
        return *this;
    }
    static constexpr uint64_t kFewest = 60;
    bool isAntiAliased() const { return sharp + blended >= kFewest && blended > sharp / 2; }
};
// A point-sampled picture jumps from one side to the other; a filtered one has a pixel in between.
EdgeCounts countEdges(const Rgb& colour);

// Share of the pixels whose colour (or id, where both frames have ids) lies outside of what their 3x3 neighbourhood
// showed in the frame before: jitter does not do that, motion does.
double changedShare(const Frame& previous, const Frame& frame);
// Above, something moves or flickers. Jitter makes wires that are thinner than a pixel come and go.
inline constexpr double kChangedShare = 0.002, kChangedShareJittered = 0.02;

}  // namespace aa
