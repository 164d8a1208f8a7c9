// CMAA2: conservative morphological anti-aliasing, version 2.3 [Strugar 2018].
//
// 1. Edges of sqrt-encoded luma between neighbours, less a share of the edges that meet them. 2. Pixels with two
// adjacent edges are candidates: each is blurred a little toward its edges. 3. Candidates that are the step of a
// Z-shaped line trace both its arms (which must be about equally long) and blend the pixels along half of each arm by a
// linear ramp. 4. A pixel with several results gets their weighted mean.
// Edges are found on linear colour clamped to [0,1]; blending is in linear light by default. Lengths in px.
// Deviation: results are added in a fixed order (own blur, horizontal lines from the left, vertical lines from the
// top), where a GPU's order is that of its threads.
#pragma once
#include "kernels/table.h"

namespace aa {
class Params;
struct MethodDescriptor;
MethodDescriptor cmaa2Descriptor();

// Edge bits of a pixel. The bytes around the image are 0.
inline constexpr uint8_t kCmaaRight = 1, kCmaaBottom = 2, kCmaaLeft = 4, kCmaaTop = 8;
inline constexpr uint16_t kCmaaBlurred = 0x8000;  // in `stored`; below it the number of lines that blended the pixel

struct Cmaa2EdgeArgs {
    const float* luma;
    uint8_t* edges;  // right and bottom bits
    int stride, edgeStride, width;
    float threshold, localContrast;
};
struct Cmaa2JoinArgs {
    const uint8_t* edges;
    uint8_t* all;  // with the left and top bits
    int edgeStride, width;
};
struct Cmaa2BlendArgs {
    const uint8_t* edges;  // all four bits
    RgbIn in;
    RgbOut out;
    uint16_t* stored;        // width entries per row
    uint16_t* verticals;     // columns of the vertical lines whose step lies in a row: width entries per row
    int* verticalCount;      // per row
    const int* columnStart;  // the same steps by column: rows columnRows[columnStart[x]] ... [columnStart[x + 1])
    const int* columnRows;
    float *blur, *shape, *lengthLeft, *lengthRight;  // debug; null when not wanted
    int stride, edgeStride, width;
    int longestPx;
    double simpleBlur, fadeFrom, fadePerEdge, symmetryCorrection, dampening;
};
// What the parameters say of the passes: thresholds and lengths, no planes yet.
struct Cmaa2Settings {
    float threshold, localContrast;
    Cmaa2BlendArgs blend{};
};
Cmaa2Settings cmaa2Settings(const Params& params);
struct Cmaa2Kernels {
    RowKernel<Cmaa2EdgeArgs> edges;
    RowKernel<Cmaa2JoinArgs> join;
    RowKernel<Cmaa2BlendArgs> rows;       // own blurs and horizontal lines, over rows
    RowKernel<Cmaa2BlendArgs> columns;    // vertical lines, over columns
    RowKernel<Cmaa2BlendArgs> normalise;  // over rows
};
}  // namespace aa
AA_KERNEL_TABLE(aa::Cmaa2Kernels, cmaa2Kernels)
