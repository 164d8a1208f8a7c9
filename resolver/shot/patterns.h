// Sub-sample patterns: the one place where their positions are written (conventions 2).
//
// Positions are offsets from the pixel centre in px, x right, y down, in the order of the API that defines them.
#pragma once
#include <glm/vec2.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "image/error.h"

namespace aa {

// Direct3D 11 standard patterns, in 1/16 px.
struct SixteenthPx {
    int x, y;
};
inline constexpr SixteenthPx kD3d1[] = {{0, 0}};
inline constexpr SixteenthPx kD3d2[] = {{4, 4}, {-4, -4}};
inline constexpr SixteenthPx kD3d4[] = {{-2, -6}, {6, -2}, {-6, 2}, {2, 6}};
inline constexpr SixteenthPx kD3d8[] = {{1, -3}, {-1, 3}, {5, 1}, {-3, -5}, {-5, 5}, {-7, -1}, {3, 7}, {7, -7}};
inline constexpr SixteenthPx kD3d16[] = {{1, 1},  {-1, -3}, {-3, 2},  {4, -1}, {-5, -2}, {2, 5},  {5, 3}, {3, -5},
                                         {-2, 6}, {0, -7},  {-4, -6}, {-6, 4}, {-8, 0},  {7, -4}, {6, 7}, {-7, -8}};

// Pixel centre and upper left corner, which four pixels share (conventions 2).
inline constexpr SixteenthPx kQuincunx[] = {{0, 0}, {-8, -8}};

inline constexpr int kMaxGrid = 8;  // grid8: 64 sub-samples

// "d3d1", "d3d2", "d3d4", "d3d8", "d3d16", "quincunx" or "gridN" (regular N x N, row by row, N = 1..8). Throws
// UsageError otherwise.
inline std::vector<glm::dvec2> patternPositionsPx(std::string_view name) {
    std::vector<glm::dvec2> r;
    const auto sixteenths = [&](const auto& table) {
        for (const auto& p : table) r.emplace_back(p.x / 16.0, p.y / 16.0);
        return r;
    };
    if (name == "d3d1") return sixteenths(kD3d1);
    if (name == "d3d2") return sixteenths(kD3d2);
    if (name == "d3d4") return sixteenths(kD3d4);
    if (name == "d3d8") return sixteenths(kD3d8);
    if (name == "d3d16") return sixteenths(kD3d16);
    if (name == "quincunx") return sixteenths(kQuincunx);
    if (name.size() == 5 && name.starts_with("grid") && name[4] >= '1' && name[4] <= '0' + kMaxGrid) {
        const int n = name[4] - '0';
        for (int row = 0; row < n; row++)
            for (int column = 0; column < n; column++)
                r.emplace_back((2 * column + 1) / (2.0 * n) - 0.5, (2 * row + 1) / (2.0 * n) - 0.5);
        return r;
    }
    throw UsageError("sub-sample pattern '" + std::string(name) +
                     "': expected d3d1, d3d2, d3d4, d3d8, d3d16, quincunx or grid1..grid8");
}

}  // namespace aa
