#include "methods/spatial/smaa_areas.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <deque>
#include <mutex>

#include "kernels/dispatch.h"

namespace aa {
namespace {
using Point = std::array<double, 2>;

float quantise(double area) { return float(std::floor(255 * area) / 255); }

std::vector<SmaaAreaQuery> evaluate(std::vector<SmaaAreaQuery> queries, Precision precision = Precision::oracle) {
    const SmaaAreaArgs args{queries.data()};
    Exec exec;
    exec.precision = precision;
    exec.parallel = false;
    runKernel(smaaBlendKernelsFor(exec).areas, exec, args, int(queries.size()));
    return queries;
}

// Area of the unit square at `corner` on the side of the line p-q where a (x - xm) + b (y - ym) > 0.
double exactSide(Point p, Point q, Point corner) {
    const double a = q[1] - p[1], b = p[0] - q[0], xm = (p[0] + q[0]) / 2, ym = (p[1] + q[1]) / 2;
    if (a == 0 && b == 0) return 1;
    const Point square[4] = {
        corner, {corner[0] + 1, corner[1]}, {corner[0] + 1, corner[1] + 1}, {corner[0], corner[1] + 1}};
    auto signedDistance = [&](Point v) { return a * (v[0] - xm) + b * (v[1] - ym); };
    std::vector<Point> kept;  // Sutherland-Hodgman against one half-plane
    for (int i = 0; i < 4; i++) {
        const Point u = square[i], v = square[(i + 1) % 4];
        const double du = signedDistance(u), dv = signedDistance(v);
        if (du > 0) kept.push_back(u);
        if ((du > 0) != (dv > 0)) {
            const double t = du / (du - dv);
            kept.push_back({u[0] + (v[0] - u[0]) * t, u[1] + (v[1] - u[1]) * t});
        }
    }
    double twice = 0;
    for (size_t i = 0; i < kept.size(); i++) {
        const Point u = kept[i], v = kept[(i + 1) % kept.size()];
        twice += u[0] * v[1] - u[1] * v[0];
    }
    return twice / 2;
}
// Counts the points i, j of 30 x 30 with x[i] + y[j] > 0. Rounding keeps the order of the x and of the y, so with x
// rising the points that are inside grow from the largest y on: 60 comparisons find the count that 900 would.
double sampledSide(Point p, Point q, Point corner) {
    constexpr size_t kPoints = 30;
    const double a = q[1] - p[1], b = p[0] - q[0], xm = (p[0] + q[0]) / 2, ym = (p[1] + q[1]) / 2;
    if (a == 0 && b == 0) return 1;
    std::array<double, kPoints> rising, falling;
    for (size_t k = 0; k < kPoints; k++) {
        const double step = double(k) / 29.0;
        rising[a < 0 ? kPoints - 1 - k : k] = a * (corner[0] + step - xm);
        falling[b < 0 ? k : kPoints - 1 - k] = b * (corner[1] + step - ym);
    }
    size_t inside = 0, insideColumn = 0;
    for (const double x : rising) {
        while (insideColumn < kPoints && x + falling[insideColumn] > 0) insideColumn++;
        inside += insideColumn;
    }
    return double(inside) / 900.0;
}

// The tables made last. They depend on their parameters alone, and every method of a run, every value of a sweep and
// every test asks for the same few; without a period the jitter asks for ever new ones, so the number is bounded.
class TableCache {
  public:
    // Compared bit for bit: -0 is not 0 here.
    using Key = std::array<uint64_t, 2>;
    static Key key(double first, double second) {
        return {std::bit_cast<uint64_t>(first), std::bit_cast<uint64_t>(second)};
    }
    template <class Make>
    std::vector<float> get(const Key& key, Make make) {
        if (std::lock_guard lock(mutex_); const auto* known = find(key)) return *known;
        std::vector<float> made = make();  // unlocked: whoever asks for another table need not wait
        std::lock_guard lock(mutex_);
        if (!find(key)) {
            if (entries_.size() == kMost) entries_.pop_front();
            entries_.emplace_back(key, made);
        }
        return made;
    }

  private:
    static constexpr size_t kMost = 32;  // a jitter's period of 16 and two axes; 17 MB of the largest table
    const std::vector<float>* find(const Key& key) const {
        const auto it = std::find_if(entries_.begin(), entries_.end(), [&](const auto& e) { return e.first == key; });
        return it == entries_.end() ? nullptr : &it->second;
    }
    std::mutex mutex_;
    std::deque<std::pair<Key, std::vector<float>>> entries_;
};

// Start and end corners (relative to the end pixels) of the lines to average.
struct Ends {
    Point start, end;
};
const std::vector<Ends>& alternatives(int code1, int code2) {
    static constexpr Point k00{0, 0}, k10{1, 0}, k11{1, 1};
    static const std::vector<Ends> table[4][4] = {
        {{{k11, k11}, {k10, k10}}, {{k00, k11}, {k10, k11}}, {{k00, k10}, {k10, k10}}, {{k00, k11}, {k10, k10}}},
        {{{k10, k00}, {k10, k10}}, {{k10, k11}}, {{k10, k10}}, {{k10, k11}, {k10, k10}}},
        {{{k11, k00}, {k11, k10}}, {{k11, k11}}, {{k11, k10}}, {{k11, k11}, {k11, k10}}},
        {{{k11, k00}, {k10, k10}}, {{k11, k11}, {k10, k11}}, {{k11, k10}, {k10, k10}}, {{k11, k11}, {k10, k10}}},
    };
    return table[code1][code2];
}
}  // namespace

SmaaAreas orthogonalArea(int leftCode, int rightCode, int leftPx, int rightPx, double offset) {
    const auto q = evaluate({{leftCode, rightCode, leftPx, rightPx, offset, 0, 0}})[0];
    return {q.own, q.opposite};
}

SmaaAreas diagonalArea(int code1, int code2, int d1, int d2, std::array<double, 2> offset, DiagonalIntegral integral) {
    const double d = d1 + d2 + 1;
    const Point below{1.0 + d1, 0.0 + d1}, above{1.0 + d1, 1.0 + d1};
    const auto& lines = alternatives(code1, code2);
    SmaaAreas mean;
    for (auto [start, end] : lines) {
        for (size_t k = 0; k < 2; k++) {
            if (code1 > 0) start[k] += offset[k];
            if (code2 > 0) end[k] += offset[k];
            end[k] += d;
        }
        const auto side = integral == DiagonalIntegral::exact ? exactSide : sampledSide;
        mean.own += (1 - side(start, end, below)) / double(lines.size());
        mean.opposite += side(start, end, above) / double(lines.size());
    }
    return mean;
}

std::vector<float> orthogonalTable(double offset) {
    std::vector<SmaaAreaQuery> queries;
    for (int e1 = 0; e1 < 5; e1++)
        for (int e2 = 0; e2 < 5; e2++)
            for (int u = 0; u < 16; u++)
                for (int v = 0; v < 16; v++) queries.push_back({e1, e2, u * u, v * v, offset, 0, 0});
    std::vector<float> table;
    for (const auto& q : evaluate(std::move(queries))) {
        table.push_back(quantise(q.own));
        table.push_back(quantise(q.opposite));
    }
    return table;
}

namespace {
std::vector<float> makeExactTable(double offset, int reachPx) {
    static constexpr int kCodes[] = {0, 1, 3, 4};
    std::vector<SmaaAreaQuery> queries;
    for (const int e1 : kCodes)
        for (const int e2 : kCodes)
            for (int l = 0; l < reachPx; l++)
                for (int r = 0; r <= reachPx; r++) queries.push_back({e1, e2, l, r, offset, 0, 0});
    std::vector<float> table;
    table.reserve(2 * queries.size());
    for (const auto& q : evaluate(std::move(queries), Precision::scalar)) {
        table.push_back(float(q.own));
        table.push_back(float(q.opposite));
    }
    return table;
}

std::vector<float> makeDiagonalTable(std::array<double, 2> offset, bool quantised) {
    std::vector<float> table;
    const auto integral = quantised ? DiagonalIntegral::sampled30 : DiagonalIntegral::exact;
    for (int c1 = 0; c1 < 4; c1++)
        for (int c2 = 0; c2 < 4; c2++)
            for (int d1 = 0; d1 < kDiagonals; d1++)
                for (int d2 = 0; d2 < kDiagonals; d2++) {
                    const SmaaAreas a = diagonalArea(c1, c2, d1, d2, offset, integral);
                    table.push_back(quantised ? quantise(a.own) : float(a.own));
                    table.push_back(quantised ? quantise(a.opposite) : float(a.opposite));
                }
    return table;
}
}  // namespace

std::vector<float> exactTable(double offset, int reachPx) {
    static TableCache cache;
    return cache.get(TableCache::key(offset, reachPx), [&] { return makeExactTable(offset, reachPx); });
}

std::vector<float> diagonalTable(std::array<double, 2> offset, bool quantised) {
    static TableCache published, exact;
    return (quantised ? published : exact).get(TableCache::key(offset[0], offset[1]), [&] {
        return makeDiagonalTable(offset, quantised);
    });
}

std::vector<float> diagonalTableAt(std::array<double, 2> samplePx, bool falling, bool quantised) {
    // The displacement along the line does nothing; across it, half of it in x and half in y (y up).
    const double across = (falling ? samplePx[0] - samplePx[1] : samplePx[0] + samplePx[1]) / 2;
    return diagonalTable({across, -across}, quantised);
}

}  // namespace aa
