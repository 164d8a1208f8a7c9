// Test support: SMAA 1x [Jimenez 2012] written a second time. Shares no code with the kernels.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "image/plane.h"

namespace aa::testing {

// SMAA 1x written a second time, per pixel and in double: searches in pairs of pixels as the shader steps, clamped
// reads, a bilinear blend, areas by integration.
class ReferenceSmaa {
  public:
    ReferenceSmaa(const Rgb& image, double threshold, int steps, int diagonalSteps, double rounding,
                  bool colour = false, bool unorm8 = false)
        : image_(image),
          threshold_(threshold),
          steps_(steps),
          diag_(diagonalSteps),
          rounding_(rounding),
          colour_(colour),
          unorm8_(unorm8) {
        w_ = image.width();
        h_ = image.height();
        for (int y = 0; y < h_; y++)
            for (int x = 0; x < w_; x++) edges_.push_back(edgeBits(x, y));
        for (int y = 0; y < h_; y++)
            for (int x = 0; x < w_; x++) weights_.push_back(weights(x, y));
    }
    int edgePixels() const {
        int n = 0;
        for (int e : edges_) n += e != 0;
        return n;
    }
    int nearTies = 0;
    std::array<double, 3> pixel(int x, int y) const {
        const double right = at(x + 1, y)[3], bottom = at(x, y + 1)[1], left = at(x, y)[2], top = at(x, y)[0];
        std::array<double, 3> out;
        for (size_t c = 0; c < 3; c++) {
            const double own = value(c, x, y);
            out[c] = own;
            if (right + bottom + left + top < 1e-5) continue;
            const bool horizontal = std::max(right, left) > std::max(bottom, top) * (1 + 1e-5);
            const double a1 = horizontal ? right : bottom, a2 = horizontal ? left : top;
            const double n1 = horizontal ? value(c, x + 1, y) : value(c, x, y + 1);
            const double n2 = horizontal ? value(c, x - 1, y) : value(c, x, y - 1);
            out[c] = (a1 * (own * (1 - a1) + n1 * a1) + a2 * (own * (1 - a2) + n2 * a2)) / (a1 + a2);
        }
        return out;
    }

  private:
    double value(size_t c, int x, int y) const { return image_.c[c].clamped(x, y); }
    double luma(int x, int y) const {
        return 0.2126 * value(0, x, y) + 0.7152 * value(1, x, y) + 0.0722 * value(2, x, y);
    }
    double difference(int x, int y, int u, int v) const {
        if (!colour_) return std::abs(luma(x, y) - luma(u, v));
        double m = 0;
        for (size_t c = 0; c < 3; c++) m = std::max(m, std::abs(value(c, x, y) - value(c, u, v)));
        return m;
    }
    int edgeBits(int x, int y) {
        const double dl = difference(x, y, x - 1, y), dt = difference(x, y, x, y - 1);
        for (double d : {dl, dt}) nearTies += std::abs(d - threshold_) < 1e-6;
        if (dl < threshold_ && dt < threshold_) return 0;
        const int from = colour_ ? 0 : 1;
        const double m = std::max({dl, dt, difference(x, y, x + 1, y), difference(x, y, x, y + 1),
                                   difference(x - from, y, x - 2, y), difference(x, y - from, x, y - 2)});
        for (double d : {dl, dt}) nearTies += std::abs(2 * d - m) < 1e-6;
        return (dl >= threshold_ && 2 * dl >= m ? 1 : 0) | (dt >= threshold_ && 2 * dt >= m ? 2 : 0);
    }
    int bits(int x, int y) const {
        return edges_[size_t(std::clamp(y, 0, h_ - 1)) * size_t(w_) + size_t(std::clamp(x, 0, w_ - 1))];
    }
    // Edge reads in a frame that may be transposed: N is the edge that lines follow, W the one that crosses them.
    bool follow(bool t, int x, int y) const { return t ? bits(y, x) & 1 : bits(x, y) & 2; }
    bool cross(bool t, int x, int y) const { return t ? bits(y, x) & 2 : bits(x, y) & 1; }
    const std::array<double, 4>& at(int x, int y) const {
        return weights_[size_t(std::clamp(y, 0, h_ - 1)) * size_t(w_) + size_t(std::clamp(x, 0, w_ - 1))];
    }

    std::array<double, 2> ortho(bool t, int x, int y) const {
        auto clear = [&](int s) { return !cross(t, s, y) && !cross(t, s, y - 1); };
        int xl = x, xr = x;
        for (int i = 0, s = x; i < steps_; i++, s -= 2) {
            int ext = 0;
            if (follow(t, s, y)) ext = 1;
            if (ext == 1 && follow(t, s - 1, y) && clear(s)) ext = 2;
            xl = s + 1 - ext;
            if (!(follow(t, s, y) && follow(t, s - 1, y) && clear(s) && clear(s - 1))) break;
        }
        for (int i = 0, s = x + 1; i < steps_; i++, s += 2) {
            int ext = 0;
            if (follow(t, s, y) && clear(s)) ext = 1;
            if (ext == 1 && follow(t, s + 1, y) && clear(s + 1)) ext = 2;
            xr = s - 1 + ext;
            if (ext != 2) break;
        }
        const int dl = x - xl, dr = xr - x;
        auto code = [&](int s) { return (cross(t, s, y - 1) ? 1 : 0) + (cross(t, s, y) ? 3 : 0); };
        auto [own, opposite] = lineArea(code(xl), code(xr + 1), dl, dr);
        if (rounding_ >= 0) {
            const double lr = dl <= dr, rr = dr <= dl, r = (1 - rounding_) / (lr + rr);
            auto factor = [&](int row) {
                return std::clamp(1 - r * lr * cross(t, xl, row) - r * rr * cross(t, xr + 1, row), 0.0, 1.0);
            };
            own *= factor(y + 1);
            opposite *= factor(y - 2);
        }
        return {own, opposite};
    }
    std::array<double, 2> diagonal(int x, int y) const {
        auto left = [&](int u, int v) { return bits(u, v) & 1; };
        auto top = [&](int u, int v) { return (bits(u, v) & 2) != 0; };
        auto walk = [&](int sx, int sy, int shift, bool& found, bool& lastTop) {
            int n = 0;
            found = false;
            for (int i = 1; i <= diag_; i++) {
                lastTop = top(x + i * sx, y + i * sy);
                if (!(lastTop && left(x + i * sx + shift, y + i * sy))) {
                    found = true;
                    break;
                }
                n++;
            }
            return std::min(n, diag_ - 1);
        };
        double own = 0, opposite = 0;
        for (const bool second : {false, true}) {
            bool f1 = true, f2 = true, last = false;
            int d1 = 0, d2 = 0, c1h, c1v, c2h, c2v;
            if (!second) {
                if (left(x, y)) d1 = walk(-1, 1, 0, f1, last), d1 += last;
                d2 = walk(1, -1, 0, f2, last);
                c1h = top(x - d1 - 1, y + d1), c1v = left(x - d1, y + d1);
                c2h = top(x + d2 + 1, y - d2), c2v = left(x + d2 + 1, y - d2 - 1);
            } else {
                d1 = walk(-1, -1, 1, f1, last);
                if (left(x + 1, y)) d2 = walk(1, 1, 1, f2, last), d2 += last;
                c1h = top(x - d1 - 1, y - d1), c1v = left(x - d1, y - d1 - 1);
                c2h = top(x + d2 + 1, y + d2), c2v = left(x + d2 + 1, y + d2);
            }
            if (d1 + d2 <= 2) continue;
            const auto a = staircaseArea(f1 ? 2 * c1h + c1v : 0, f2 ? 2 * c2h + c2v : 0, d1, d2);
            own += second ? a[1] : a[0];
            opposite += second ? a[0] : a[1];
        }
        return {std::min(own, 1.0), std::min(opposite, 1.0)};  // as the published target of 8 bits
    }
    // Areas below (own) and above (opposite) the base line in [l, l + 1] under straight pieces (t0, h0)-(t1, h1).
    using Pieces = std::vector<std::array<double, 4>>;
    static std::array<double, 2> areaUnder(const Pieces& pieces, double l) {
        std::array<double, 2> sum{};
        for (const auto& [t0, h0, t1, h1] : pieces) {
            const double slope = (h1 - h0) / (t1 - t0), a = std::max(t0, l), b = std::min(t1, l + 1);
            if (a >= b) continue;
            std::vector<double> cuts = {a, b};
            const double zero = slope != 0 ? t0 - h0 / slope : a;
            if (zero > a && zero < b) cuts = {a, zero, b};
            for (size_t i = 0; i + 1 < cuts.size(); i++) {
                const double middle = h0 + slope * ((cuts[i] + cuts[i + 1]) / 2 - t0);
                sum[middle < 0 ? 0 : 1] += std::abs(middle) * (cuts[i + 1] - cuts[i]);
            }
        }
        return sum;
    }
    // Lines along rows or columns, without a sub-sample offset.
    static std::array<double, 2> lineArea(int e1, int e2, int l, int r) {
        const bool one1 = e1 == 1 || e1 == 3, one2 = e2 == 1 || e2 == 3;
        if (!one1 && !one2) return {};
        const double d = l + r + 1, h1 = e1 == 1 ? .5 : -.5, h2 = e2 == 1 ? .5 : -.5;
        if (one1 && one2 && e1 == e2) {
            std::array<double, 2> sum{};
            for (const Pieces& half : {Pieces{{0, h1, d / 2, 0}}, Pieces{{d / 2, 0, d, h2}}}) {
                const auto a = areaUnder(half, l);
                const double t = std::min(d / 32, 1.0);
                for (size_t k = 0; k < 2; k++) sum[k] += std::sqrt(2 * a[k]) / 2 * (1 - t) + a[k] * t;
            }
            return sum;
        }
        if (one1 && (one2 || e2 == 4)) return areaUnder({{0, h1, d, -h1}}, l);
        if (one2 && e1 == 4) return areaUnder({{0, -h2, d, h2}}, l);
        if (one1) return l <= r ? areaUnder({{0, h1, d / 2, 0}}, l) : std::array<double, 2>{};
        return l >= r ? areaUnder({{d / 2, 0, d, h2}}, l) : std::array<double, 2>{};
    }
    // Area of the unit square at p where a (x - xm) + b (y - ym) > 0 for the line through s and e: strips of x.
    static double sideArea(std::array<double, 2> s, std::array<double, 2> e, std::array<double, 2> p) {
        const double a = e[1] - s[1], b = s[0] - e[0], xm = (s[0] + e[0]) / 2, ym = (s[1] + e[1]) / 2;
        if (a == 0 && b == 0) return 1;
        const auto height = [&](double x) {  // of the part of the column at x, from the bottom when b < 0
            const double y = b != 0 ? ym - a * (x - xm) / b : 0;
            if (b == 0) return a * (x - xm) > 0 ? 1.0 : 0.0;
            const double below = std::clamp(y - p[1], 0.0, 1.0);
            return b > 0 ? 1 - below : below;
        };
        std::vector<double> cuts = {p[0], p[0] + 1};
        if (a != 0)
            for (const double y : {p[1], p[1] + 1}) cuts.push_back(std::clamp(xm - b * (y - ym) / a, p[0], p[0] + 1));
        std::sort(cuts.begin(), cuts.end());
        double sum = 0;
        for (size_t i = 0; i + 1 < cuts.size(); i++)
            sum += height((cuts[i] + cuts[i + 1]) / 2) * (cuts[i + 1] - cuts[i]);
        return sum;
    }
    // S;E of the lines to average, by the codes of the two ends.
    static std::array<double, 2> staircaseArea(int c1, int c2, int d1, int d2) {
        static const char* const lines[4][4] = {{"11111010", "00111011", "00101010", "00111010"},
                                                {"10001010", "1011", "1010", "10111010"},
                                                {"11001110", "1111", "1110", "11111110"},
                                                {"11001010", "11111011", "11101010", "11111010"}};
        const std::string text = lines[c1][c2];
        std::array<double, 2> mean{};
        const double d = d1 + d2 + 1, n = double(text.size() / 4);
        for (size_t i = 0; i < text.size(); i += 4) {
            const std::array<double, 2> s{double(text[i] - '0'), double(text[i + 1] - '0')},
                e{text[i + 2] - '0' + d, text[i + 3] - '0' + d};
            mean[0] += (1 - sideArea(s, e, {1.0 + d1, 0.0 + d1})) / n;
            mean[1] += sideArea(s, e, {1.0 + d1, 1.0 + d1}) / n;
        }
        return mean;
    }
    double stored(double w) const { return unorm8_ ? std::floor(w * 255 + 0.5) / 255 : w; }
    std::array<double, 4> weights(int x, int y) const {
        std::array<double, 4> w{};
        if (bits(x, y) & 2) {
            std::array<double, 2> n{};
            if (diag_ > 0) n = diagonal(x, y);
            if (n[0] + n[1] > 0) return {stored(n[0]), stored(n[1]), 0, 0};
            n = ortho(false, x, y);
            w[0] = stored(n[0]), w[1] = stored(n[1]);
        }
        if (bits(x, y) & 1) {
            const auto v = ortho(true, y, x);
            w[2] = stored(v[0]), w[3] = stored(v[1]);
        }
        return w;
    }
    const Rgb& image_;
    double threshold_;
    int steps_, diag_;
    double rounding_;
    bool colour_, unorm8_;
    int w_, h_;
    std::vector<int> edges_;
    std::vector<std::array<double, 4>> weights_;
};

}  // namespace aa::testing
