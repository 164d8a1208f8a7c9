// SMAA's area tables, generated from the analytic definition [Jimenez 2012].
#pragma once
#include <array>
#include <vector>

#include "methods/spatial/smaa_kernels.h"

namespace aa {

// Weights of the pixel for its neighbour's colour, and the other way round.
struct SmaaAreas {
    double own = 0, opposite = 0;
};
// The exact areas for crossing codes (0 none, 1 above, 3 below, 4 both), distances in px and a sub-sample offset.
SmaaAreas orthogonalArea(int leftCode, int rightCode, int leftPx, int rightPx, double offset = 0);

enum class DiagonalIntegral { exact, sampled30 };  // sampled30: the published rule, 30 x 30 points at k / 29
// Codes 2 * horizontal + vertical crossing, distances in px, sub-sample offset in px with y up.
SmaaAreas diagonalArea(int code1, int code2, int d1, int d2, std::array<double, 2> offset, DiagonalIntegral integral);

// The tables below may be asked for from any thread; the costly ones are kept, the last 32 of each kind.
// 25 code pairs x 16 x 16 pairs of floor(255 a) / 255 at l = u^2, r = v^2: one orthogonal tile of the published
// texture.
std::vector<float> orthogonalTable(double offset);
// The exact areas in float, as the kernel evaluates them: 16 pairs of codes 0, 1, 3, 4 x distances 0 to reachPx - 1 x 0
// to reachPx.
std::vector<float> exactTable(double offset, int reachPx);
// 16 code pairs x kDiagonals^2 pairs for every distance; `quantised` as published, otherwise exact.
std::vector<float> diagonalTable(std::array<double, 2> offset, bool quantised);
// The same of an image that was sampled at `samplePx` from the pixel centres (y down), for lines that rise or fall to
// the right.
std::vector<float> diagonalTableAt(std::array<double, 2> samplePx, bool falling, bool quantised);

}  // namespace aa
