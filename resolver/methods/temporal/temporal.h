// Host side shared by the temporal methods: history.h, temporal_params.h, and here what they read of a frame, the
// un-jittered current frame, expected depths, the display-space sharpening and the debug layers. The steps themselves
// are kernel text in temporal_blocks.kernel.h; what each does: conventions 7.
#pragma once
#include <algorithm>
#include <glm/vec3.hpp>

#include "methods/method.h"
#include "methods/temporal/history.h"
#include "methods/temporal/temporal_kernels.h"
#include "methods/temporal/temporal_params.h"

namespace aa {

namespace temporal {
// The members of TemporalIn that come from the frame alone; `color` in the method's working space.
TemporalIn frameView(const Frame& frame, const Rgb& color);

// ---- conventions 7.0: the current frame read at p - jitter ----
// A jittered frame holds at texel m the scene at centre(m) + jitter, so what lies at p is read at p - jitter: colours
// bilinear, depth, id and motion at the nearest texel, beyond the picture its edge. Without jitter nothing changes.
// The nearest texel as offset from the pixel: 0 but for a jitter of half a pixel.
glm::ivec2 unjitteredTexel(const Frame& frame);
// Makes `in` see the frame so: moves depth and motion, and asks runTemporal() for the colours.
void unjitter(const Frame& frame, TemporalIn& in);
// The same, and what a method reads beside it: the expectation of the texel's depth, and ids unless null.
void unjitter(const Frame& frame, TemporalIn& in, ExpectedDepth& expected, const uint32_t*& objectId);
// A whole picture un-jittered, into `out`; for methods that filter the current frame before they blend it.
void unjitter(const Rgb& in, glm::dvec2 jitterPx, const Exec& exec, Rgb& out);

// A few rows of un-jittered colour per thread, so that no picture of them is ever written.
class UnjitteredRows {
  public:
    // Of blocks of at most `rows` rows.
    UnjitteredRows(const TemporalIn& in, const Exec& exec, int rows);
    // What rows y0 - 1 .. y1 of `in.color` are, at the addresses that a kernel expects; until this thread's next call.
    RgbIn around(int y0, int y1);

  private:
    UnjitterArgs args_;
    void (*run_)(const UnjitterArgs&, int, int);
    size_t rows_;
    Scratch scratch_;
};
// runKernel for arguments that have a TemporalIn `in`, of whose colours the kernel reads a 3x3 window. `scratchRows`:
// rows of working memory for arguments with a member `scratch` (kernels/ring.h).
template <class Args>
void runTemporal(const RowKernel<Args>& kernel, const Exec& exec, const Args& args, int grain = 8,
                 int scratchRows = 0) {
    const auto fn = rowsOf(kernel, exec.precision);
    const TemporalIn& in = args.in;
    const bool unjitters = in.readXPx != 0 || in.readYPx != 0;
    Scratch scratch(scratchRows, in.stride);
    UnjitteredRows current(in, exec, unjitters ? grain : 0);
    forRows(
        exec, in.height,
        [&](int y0, int y1) {
            Args own = args;
            if constexpr (requires { own.scratch; }) own.scratch = scratch.local();
            if (!unjitters) return fn(own, y0, y1);
            for (int y = y0; y < y1; y += grain) {
                const int end = std::min(y + grain, y1);
                own.in.color = current.around(y, end);
                fn(own, y, end);
            }
        },
        grain);
}
}  // namespace temporal

// From frame.camera and frame.previousCamera; unknown without both, after a reset, and for other projections.
ExpectedDepth expectedDepth(const Frame& frame);
// In any other camera.
ExpectedDepth expectedDepth(const Frame& frame, const Camera& before);
// Of the depth that is read `texels` beside each pixel.
ExpectedDepth readBeside(ExpectedDepth expected, glm::ivec2 texels);

// View position of the sample at pixel position p and depth z: x and y = z * (perDepth . (p, 1)) + constant . (p, 1).
struct ViewRays {
    glm::dvec3 perDepth[2], constant[2];
};
std::optional<ViewRays> viewRays(const Frame& frame);  // nothing without a perspective or orthographic camera

// Sharpened copy of a display-encoded blend [Oliveros 2018, eq 3.1 and 4.17]; never fed back. `kernel` is not none.
void sharpenEncoded(const RgbaPlane& blend, SharpenKernel kernel, const Exec& exec, Rgb& out);
void sharpenEncodedRow(const RgbaPlane& blend, SharpenKernel kernel, const Exec& exec, int y, Rgb& out);
float sharpenGain(SharpenKernel kernel);  // as of SharpenHistoryArgs

// Planes behind TemporalDebug and their names.
class TemporalDebugLayers {
  public:
    // What `method` was asked to keep: everything, the rejection alone, or nothing.
    TemporalDebug begin(const Method& method, int width, int height);
    std::vector<DebugLayer> layers() const;
    const PlaneF* rejection() const { return rejection_.empty() ? nullptr : &rejection_; }

  private:
    Rgb boxLow_, boxHigh_;
    PlaneF motionX_, motionY_, rejection_, clipAmount_, feedback_;
};

}  // namespace aa
