// Test support: the FXAA family written a second time, per pixel and in double. Shares no code with the kernels.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "image/plane.h"

namespace aa::testing {

// FXAA 3.11 written a second time, in the reference's control flow and in double: continuous positions, a general
// bilinear fetch, both directions in one loop. `nearTie` counts pixels whose decision hangs on the last bits.
class Reference311 {
  public:
    Reference311(const Rgb& image, std::vector<double> stepsPx, double subpix, double thr, double thrMin)
        : image_(image), steps_(std::move(stepsPx)), subpix_(subpix), thr_(thr), thrMin_(thrMin) {}
    int nearTies = 0;

    std::array<double, 3> pixel(int x, int y) {
        tie_ = false;
        const auto result = filtered(x, y);
        nearTies += tie_;
        return result;
    }
    bool lastWasNearTie() const { return tie_; }

  private:
    double channel(size_t c, double px, double py) const {  // bilinear at a position, clamped taps
        const double qx = px - 0.5, qy = py - 0.5, ax = std::floor(qx), ay = std::floor(qy), fx = qx - ax, fy = qy - ay;
        double sum = 0;
        for (int j = 0; j < 2; j++)
            for (int i = 0; i < 2; i++)
                sum += (i ? fx : 1 - fx) * (j ? fy : 1 - fy) * image_.c[c].clamped(int(ax) + i, int(ay) + j);
        return sum;
    }
    double luma(double px, double py) const {
        return 0.299 * channel(0, px, py) + 0.587 * channel(1, px, py) + 0.114 * channel(2, px, py);
    }
    void close(double a, double b) { tie_ = tie_ || std::abs(a - b) < 1e-6; }
    void closeEnd(double e, double gradient) {  // exact ties have a rule, near ones do not
        if (std::abs(std::abs(e) - gradient) > 1e-9) close(std::abs(e), gradient);
    }
    std::array<double, 3> filtered(int ix, int iy) {
        const double x = ix + 0.5, y = iy + 0.5;
        auto at = [&](int i, int j) { return luma(x + i, y + j); };
        const double m = at(0, 0), n = at(0, -1), s = at(0, 1), w = at(-1, 0), e = at(1, 0);
        const double highest = std::max({m, n, s, w, e}), range = highest - std::min({m, n, s, w, e});
        auto colour = [&](double px, double py) {
            return std::array{channel(0, px, py), channel(1, px, py), channel(2, px, py)};
        };
        close(range, std::max(thrMin_, highest * thr_));
        if (range < std::max(thrMin_, highest * thr_)) return colour(x, y);
        const double nw = at(-1, -1), ne = at(1, -1), sw = at(-1, 1), se = at(1, 1);
        const double horz =
            std::abs(-2 * w + (nw + sw)) + 2 * std::abs(-2 * m + (n + s)) + std::abs(-2 * e + (ne + se));
        const double vert =
            std::abs(-2 * s + (sw + se)) + 2 * std::abs(-2 * m + (w + e)) + std::abs(-2 * n + (nw + ne));
        const bool horizontal = horz >= vert * (1 - 1e-6);
        if (std::abs(horz - vert) > 1e-9) close(horz, vert * (1 - 1e-6));
        const double average = ((n + s + w + e) * 2 + nw + ne + sw + se) / 12;
        const double c = std::min(1.0, std::abs(average - m) / range), smooth = (3 - 2 * c) * c * c;
        const double before = horizontal ? n : w, after = horizontal ? s : e;
        const double gradBefore = std::abs(before - m), gradAfter = std::abs(after - m);
        if (gradBefore != gradAfter) close(gradBefore, gradAfter);
        const bool pairBefore = gradBefore >= gradAfter;
        const double sign = pairBefore ? -1 : 1, gradient = std::max(gradBefore, gradAfter) / 4;
        const double mean = ((pairBefore ? before : after) + m) / 2;
        const double bx = x + (horizontal ? 0 : sign * 0.5), by = y + (horizontal ? sign * 0.5 : 0);
        double dn = 0, dp = 0, en = 0, ep = 0;
        bool doneN = false, doneP = false;
        for (size_t k = 0; k < steps_.size(); k++) {
            if (!doneN) dn += steps_[k];
            if (!doneP) dp += steps_[k];
            if (k + 1 == steps_.size() || (doneN && doneP)) continue;
            auto end = [&](double d) { return horizontal ? luma(bx + d, by) - mean : luma(bx, by + d) - mean; };
            if (!doneN) en = end(-dn), closeEnd(en, gradient), doneN = std::abs(en) >= gradient * (1 - 1e-6);
            if (!doneP) ep = end(dp), closeEnd(ep, gradient), doneP = std::abs(ep) >= gradient * (1 - 1e-6);
        }
        const bool nearN = dn < dp;
        const bool good = ((nearN ? en : ep) < 0) != (m - mean < 0);
        const double pixelOffset = good ? 0.5 - std::min(dn, dp) / (dn + dp) : 0;
        const double offset = std::max(pixelOffset, smooth * smooth * subpix_) * sign;
        return horizontal ? colour(x, y + offset) : colour(x + offset, y);
    }
    const Rgb& image_;
    std::vector<double> steps_;
    double subpix_, thr_, thrMin_;
    bool tie_ = false;
};

// FXAA 1 and FXAA for compute shaders share their steps; `lastWasNearTie` as above.
class ReferenceSearch {
  public:
    bool lastWasNearTie() const { return tie_; }

  protected:
    explicit ReferenceSearch(const Rgb& image) : image_(image) {}
    double L(int x, int y) const {
        return luma_[size_t(std::clamp(y, 0, image_.height() - 1)) * size_t(image_.width()) +
                     size_t(std::clamp(x, 0, image_.width() - 1))];
    }
    void close(double a, double b) { tie_ = tie_ || std::abs(a - b) < 1e-6; }
    void decided(double e, double threshold) {  // exact ties have a rule, near ones do not
        if (std::abs(std::abs(e) - threshold) > 1e-9) close(std::abs(e), threshold);
    }
    bool horizontal(int x, int y) {
        const double rows = std::abs(L(x - 1, y - 1) - 2 * L(x - 1, y) + L(x - 1, y + 1)) +
                            2 * std::abs(L(x, y - 1) - 2 * L(x, y) + L(x, y + 1)) +
                            std::abs(L(x + 1, y - 1) - 2 * L(x + 1, y) + L(x + 1, y + 1));
        const double columns = std::abs(L(x - 1, y - 1) - 2 * L(x, y - 1) + L(x + 1, y - 1)) +
                               2 * std::abs(L(x - 1, y) - 2 * L(x, y) + L(x + 1, y)) +
                               std::abs(L(x - 1, y + 1) - 2 * L(x, y + 1) + L(x + 1, y + 1));
        if (std::abs(rows - columns) > 1e-9) close(rows, columns * (1 - 1e-6));
        return rows >= columns * (1 - 1e-6);
    }
    double range(int x, int y, double& highest) const {
        const double v[] = {L(x, y), L(x, y - 1), L(x, y + 1), L(x - 1, y), L(x + 1, y)};
        highest = *std::max_element(v, v + 5);
        return highest - *std::min_element(v, v + 5);
    }
    // The share of the neighbour on the chosen side: 1/2 - nearer end / both ends, or 0. `read(k, sign)` is the luma
    // of the pair at the k-th point of a search, `distancePx(k)` its distance; the n-th is never read.
    template <class Read, class Distance>
    double share(int n, const Read& read, const Distance& distancePx, double own, double side) {
        const double middle = (own + side) / 2, threshold = std::abs(own - side) / 4;
        double distance[2], e[2] = {};
        for (int s = 0; s < 2; s++) {
            distance[s] = distancePx(n);
            for (int k = 0; k < n; k++) {
                e[s] = read(k, s ? 1 : -1) - middle;
                decided(e[s], threshold);
                if (std::abs(e[s]) >= threshold * (1 - 1e-6)) {
                    distance[s] = distancePx(k);
                    break;
                }
            }
        }
        const int nearest = distance[0] < distance[1] ? 0 : 1;
        close(e[nearest], 0);
        if ((e[nearest] < 0) == (own - middle < 0)) return 0;
        return 0.5 - std::min(distance[0], distance[1]) / (distance[0] + distance[1]);
    }
    const Rgb& image_;
    std::vector<double> luma_;
    bool tie_ = false;
};

class ReferenceFxaa1 : public ReferenceSearch {
  public:
    ReferenceFxaa1(const Rgb& image, int preset) : ReferenceSearch(image) {
        static const double table[6][6] = {{1. / 4, 1. / 12, 2, 4, 2. / 3, 1},  {1. / 8, 1. / 16, 4, 3, 3. / 4, 0},
                                           {1. / 8, 1. / 24, 8, 2, 3. / 4, 0},  {1. / 8, 1. / 24, 16, 1, 3. / 4, 0},
                                           {1. / 8, 1. / 24, 24, 1, 3. / 4, 0}, {1. / 8, 1. / 24, 32, 1, 3. / 4, 0}};
        p_ = table[preset];
        for (int y = 0; y < image.height(); y++)
            for (int x = 0; x < image.width(); x++)
                luma_.push_back(image.c[1].at(x, y) * (0.587 / 0.299) + image.c[0].at(x, y));
    }
    std::array<double, 3> pixel(int x, int y) {
        tie_ = false;
        auto colour = [&](int u, int v, size_t c) { return double(image_.c[c].clamped(u, v)); };
        double highest = 0;
        const double r = range(x, y, highest), limit = std::max(p_[1], highest * p_[0]);
        close(r, limit);
        if (r < limit) return {colour(x, y, 0), colour(x, y, 1), colour(x, y, 2)};
        const double m = L(x, y), low = (L(x, y - 1) + L(x, y + 1) + L(x - 1, y) + L(x + 1, y)) / 4;
        const double blend = std::min(p_[4], std::max(0.0, std::abs(low - m) / r - 0.25) / 0.75);
        const bool h = horizontal(x, y);
        const double before = h ? L(x, y - 1) : L(x - 1, y), after = h ? L(x, y + 1) : L(x + 1, y);
        if (std::abs(before - m) != std::abs(after - m)) close(std::abs(before - m), std::abs(after - m));
        const int side = std::abs(before - m) >= std::abs(after - m) ? -1 : 1, a = int(p_[3]), n = int(p_[2]);
        const auto read = [&](int k, int sign) {  // mean over `a` pixels along the line, from 1 + k a
            double sum = 0;
            for (int i = 1 + k * a; i <= (k + 1) * a; i++)
                for (const int across : {0, side}) sum += h ? L(x + sign * i, y + across) : L(x + across, y + sign * i);
            return sum / (2 * a);
        };
        const double shift = share(
            n, read, [&](int k) { return (a + 1) / 2.0 + a * k; }, m, side < 0 ? before : after);
        std::array<double, 3> out;
        for (size_t c = 0; c < 3; c++) {
            double mean = 0;
            for (int j = -1; j <= 1; j++)
                for (int i = -1; i <= 1; i++)
                    if (p_[5] == 0 || i == 0 || j == 0) mean += colour(x + i, y + j, c) / (p_[5] == 0 ? 9 : 5);
            const double own = colour(x, y, c), other = h ? colour(x, y + side, c) : colour(x + side, y, c);
            out[c] = blend * mean + (1 - blend) * (own * (1 - shift) + other * shift);
        }
        return out;
    }

  private:
    const double* p_;
};

class ReferenceFxaaCs : public ReferenceSearch {
  public:
    // `linear` decides, `blended` is blended.
    ReferenceFxaaCs(const Rgb& linear, const Rgb& blended, std::vector<double> distancesPx)
        : ReferenceSearch(blended), distancesPx_(std::move(distancesPx)) {
        for (int y = 0; y < linear.height(); y++)
            for (int x = 0; x < linear.width(); x++) {
                const double w[] = {.212671, .715160, .072169};
                double sum = 0;
                for (size_t c = 0; c < 3; c++) sum += w[c] * std::clamp(double(linear.c[c].at(x, y)), 0.0, 1.0);
                luma_.push_back(std::log2(1 + 15 * std::min(sum, 1.0)) / 4);
            }
    }
    std::array<double, 3> pixel(int x, int y) {
        tie_ = false;
        auto colour = [&](int u, int v, size_t c) { return double(image_.c[c].clamped(u, v)); };
        double highest = 0;
        const double r = range(x, y, highest), m = L(x, y);
        close(r, 0.175);
        if (r < 0.175) return {colour(x, y, 0), colour(x, y, 1), colour(x, y, 2)};
        const double mean = (2 * (L(x, y - 1) + L(x, y + 1) + L(x - 1, y) + L(x + 1, y)) + L(x - 1, y - 1) +
                             L(x + 1, y - 1) + L(x - 1, y + 1) + L(x + 1, y + 1)) /
                            12;
        const double t = std::clamp(std::abs(mean - m) / r, 0.0, 1.0), s = t * t * (3 - 2 * t);
        const double raw = 254 * std::clamp(s * s * 0.5 * 2, 0.0, 1.0);
        close(raw, std::round(raw));  // the queue's 7 bits
        const double subpixel = (int(raw) & ~1) / 254.0 * 0.5;
        const bool h = horizontal(x, y);
        const double before = h ? L(x, y - 1) : L(x - 1, y), after = h ? L(x, y + 1) : L(x + 1, y);
        if (std::abs(before - m) != std::abs(after - m)) close(std::abs(before - m), std::abs(after - m));
        const int side = std::abs(after - m) >= std::abs(before - m) ? 1 : -1;
        const auto read = [&](int k, int sign) {  // bilinear on the line
            const double d = distancesPx_[size_t(k)], whole = std::floor(d), f = d - whole;
            const auto pair = [&](double i) {
                const int n = sign * int(i);
                return h ? (L(x + n, y) + L(x + n, y + side)) / 2 : (L(x, y + n) + L(x + side, y + n)) / 2;
            };
            return pair(whole) * (1 - f) + (f > 0 ? pair(whole + 1) * f : 0);
        };
        const double edge = share(
            int(distancesPx_.size()) - 1, read, [&](int k) { return distancesPx_[size_t(k)]; }, m,
            side < 0 ? before : after);
        const double final = std::max(subpixel, edge);
        close(final, 0.01);
        std::array<double, 3> out;
        for (size_t c = 0; c < 3; c++) {
            const double own = colour(x, y, c), other = h ? colour(x, y + side, c) : colour(x + side, y, c);
            out[c] = final > 0.01 ? own + (other - own) * final : own;
        }
        return out;
    }

  private:
    std::vector<double> distancesPx_;
};

}  // namespace aa::testing
