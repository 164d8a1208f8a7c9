// What every temporal kernel reads and writes: plain views, shared by host and kernel text.
#pragma once
#include "kernels/table.h"

namespace aa {

enum class Dilation { closest3x3, closestX, longest3x3, none };  // conventions 7.2
// conventions 7.1; the last two are Catmull-Rom as published, without the clamp of conventions 9.
enum class HistoryFilter { bilinear, catmullRom, catmullRom5, catmullRomFree, catmullRom5Free };
enum class Neighbourhood { rounded, box3x3, plus };          // conventions 7.4
enum class ClipTarget { aabbCentre, mean, current, clamp };  // conventions 7.6; clamp: 7.5 instead of a clip
enum class SharpenKernel { none, xu, norm };                 // [Oliveros 2018, eq 3.1 and 4.17]
// Weights under the luminance feedback: 1/4 1/2 1/4 (the thesis's program), BT.709, BT.601, as INSIDE's source prints.
enum class Luminance { quarter, bt709, bt601, inside };

// Why a pixel's history was not used; 0 = it was. The numbers are those of the debug layer "validity".
enum class Rejection { none = 0, outside = 1, disoccluded = 2, magnified = 3, otherObject = 4, firstFrame = 5 };

// Previous view depth of a static surface point seen at pixel position p with depth z: z * (perDepth . (p, 1)) +
// constant . (p, 1), from the two cameras. Not known: the depth is taken as unchanged.
struct ExpectedDepth {
    bool known = false;
    float perDepth[3] = {0, 0, 1}, constant[3] = {0, 0, 0};
};

// Thresholds of the tests that reject history by geometry (conventions 7.3).
struct RejectionTest {
    float depthTolerance;  // share of the expected depth
    float magnification;   // of the footprint within which the previous pixel's centre must lie; 0: not tested
    bool bothSides;        // nearer surfaces are rejected, too
};

// Intermediates for --debug-layers: all or none of them; the rejection may also be kept alone.
struct TemporalDebug {
    float* rejection = nullptr;                        // Rejection as a number
    float *motionXPx = nullptr, *motionYPx = nullptr;  // after dilation
    float *boxLow[3] = {}, *boxHigh[3] = {};           // the constraint's box, in the method's space
    float* clipAmount = nullptr;                       // largest channel distance that the constraint moved history
    float* feedback = nullptr;                         // weight of history in the blend
};

// One frame in a method's working space and the colour history. All planes have the frame's size, one stride (pixels)
// and filled borders.
struct TemporalIn {
    RgbIn color;
    const float* depthView = nullptr;
    const float *motionXPx = nullptr, *motionYPx = nullptr;  // current - previous, y down
    const float* history = nullptr;  // RGBA, the previous blend; null on the first frame after a reset
    float* next = nullptr;           // RGBA, this frame's blend
    RgbOut out = {};                 // this frame's blend again, planar; null: not wanted
    int stride = 0, width = 0, height = 0;
    float jitterXPx = 0, jitterYPx = 0;  // of the colours as the kernel sees them: 0 once they are un-jittered
    // Where a pixel's colours are to be read, from its centre: -jitter where the frame is un-jittered
    // (conventions 7.0), else 0.
    float readXPx = 0, readYPx = 0;
    float feedbackCeiling = 1;  // largest history weight of this frame (warmup=ramp: 1 - 1/(t+1))
    bool clampOutside = false;  // outside the image the history is its border, not rejected
    Dilation dilation = Dilation::closest3x3;
    HistoryFilter filter = HistoryFilter::bilinear;
    TemporalDebug debug;
};

struct SharpenHistoryArgs {
    const float* rgba;  // interleaved, border filled
    RgbOut out;
    int stride, width;
    float gain;  // weight of each of the four neighbours: 1 (Xu), 1/4 (normalised)
};
// The colours of a history as a narrower format would hold them (conventions 8); its alpha stays float.
enum class HistoryFormat { float32, half, byte };
struct NarrowHistoryArgs {
    float* rgba;
    int stride, width;
    HistoryFormat format;
    bool dither;  // rounds up or down by chance, so that the mean is kept
    uint32_t frame;
};
// conventions 7.0: colours at p + (xPx, yPx), bilinear, over whole rows of planes. Row y0 of the call goes to `out`,
// y0 + 1 after it, ...; each starts at x = -border and is `stride` long.
struct UnjitterArgs {
    RgbIn in;
    RgbOut out;
    int stride, border;
    float xPx, yPx;
};
struct TemporalKernels {
    RowKernel<SharpenHistoryArgs> sharpen;
    RowKernel<NarrowHistoryArgs> narrow;
    RowKernel<UnjitterArgs> unjitter;  // rows [-1, height + 1): a window reaches over the edge
};
}  // namespace aa
AA_KERNEL_TABLE(aa::TemporalKernels, temporalKernels)
