#include "metrics/error_bar.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

#include "metrics/student.h"

namespace aa {
namespace {
constexpr double kInf = std::numeric_limits<double>::infinity();

// What neighbours have in common, as a factor on the variance of a mean of `values` (deviations from that mean) on a
// grid: 1 + 2 sum of the correlations of neighbours. The mean is the values' own, which lowers every correlation by
// 1 / (n - 1): added again. Never below 1: what looks opposed is chance.
double sharedByNeighbours(std::span<const double> values, int columns) {
    const int n = int(values.size()), rows = n / columns;
    const auto v = [&](int x, int y) { return values[size_t(y * columns + x)]; };
    double squares = 0, beside = 0, across = 0, pairsBeside = 0, pairsAcross = 0;
    for (int y = 0; y < rows; y++)
        for (int x = 0; x < columns; x++) {
            squares += v(x, y) * v(x, y);
            if (x > 0) beside += v(x, y) * v(x - 1, y), pairsBeside++;
            if (y > 0) beside += v(x, y) * v(x, y - 1), pairsBeside++;
            if (x > 0 && y > 0) across += v(x, y) * v(x - 1, y - 1) + v(x - 1, y) * v(x, y - 1), pairsAcross += 2;
        }
    if (!(squares > 0)) return 1;
    const double variance = squares / n, own = 1.0 / (n - 1);
    const double more = beside / variance + own * pairsBeside + std::max(0.0, across / variance + own * pairsAcross);
    return std::max(1.0, 1 + 2 * more / n);
}
// Beyond this factor 16 parts hang together, beyond that one 9 do, or blocks of frames: then less is known than any
// interval of them says. Chance alone exceeds them in 2 to 3 of 100 pictures.
constexpr double kSharedBy16 = 2.2, kSharedBy9 = 2.0;
// A difference that nine parts would resolve by so many times their interval is one, even if they hang together.
constexpr double kBeyondDoubt = 3;

double total(const std::vector<double>& v) {
    double sum = 0;
    for (const double x : v) sum += x;
    return sum;
}

// Bounds of parts of whole tiles: part k of n covers tiles [k * tiles / n, (k + 1) * tiles / n).
size_t partOf(size_t tile, size_t tiles, size_t parts) { return ((tile + 1) * parts - 1) / tiles; }

// The grid of `parts` whose parts are nearest to square, in tiles; nothing where it does not fit.
std::optional<std::pair<size_t, size_t>> gridOf(size_t parts, size_t tilesX, size_t tilesY) {
    std::optional<std::pair<size_t, size_t>> best;
    double flattest = kInf;
    for (size_t columns = 1; columns <= parts; columns++) {
        if (parts % columns || columns > tilesX || parts / columns > tilesY) continue;
        const double shape =
            std::abs(std::log(double(tilesX) / double(columns) / (double(tilesY) / double(parts / columns))));
        if (shape < flattest) flattest = shape, best = {columns, parts / columns};
    }
    return best;
}
ErrorParts partsOf(const TileErrors& errors, size_t tilesX, size_t columns, size_t rows) {
    const size_t tilesY = errors.sum.size() / tilesX;
    ErrorParts p;
    p.columns = int(columns), p.rows = int(rows);
    for (auto* v : {&p.squares, &p.halves, &p.values}) v->resize(columns * rows);
    for (size_t i = 0; i < errors.sum.size(); i++) {
        const size_t part = partOf(i / tilesX, tilesY, rows) * columns + partOf(i % tilesX, tilesX, columns);
        p.values[part] += errors.values[i];
        p.measured += errors.sum[i];
        if (errors.againstA.empty()) {
            p.squares[part] += errors.sum[i];
        } else {
            p.squares[part] += 2 * errors.sum[i] - 0.5 * (errors.againstA[i] + errors.againstB[i]);
            p.halves[part] += errors.againstA[i] - errors.againstB[i];
        }
    }
    return p;
}

// Two methods on one grid of parts.
struct Paired {
    double first = 0, second = 0;                  // mean squared errors
    double ofFirst = 0, ofBoth = 0, ofSecond = 0;  // (co)variances of those means
    double ofDifference = 0, ofNoise = 0;  // variance of the difference of the means; that of the truth's noise in it
    double shared = 1;
    double t = 0;
    // What higher orders of the truth's noise may hide, as a variance that t^2 shared is to multiply.
    double hidden = 0;
    // What they leave in both errors alike: nothing in the difference, but in the ratio.
    double common = 0;
    double taken = 0;  // what the second order took off the difference of the means
    double half() const { return t * std::sqrt(shared * (ofDifference + hidden)); }
};
Paired paired(const ErrorParts& a, const ErrorParts& b) {
    const size_t n = a.squares.size();
    const double values = total(a.values);
    Paired p{.first = total(a.squares) / values, .second = total(b.squares) / values};
    std::vector<double> deviations(n);
    const double scale = double(n) / double(n - 1) / (values * values);
    for (size_t i = 0; i < n; i++) {
        const double x = a.squares[i] - p.first * a.values[i], y = b.squares[i] - p.second * b.values[i];
        p.ofFirst += x * x * scale, p.ofSecond += y * y * scale, p.ofBoth += x * y * scale;
        deviations[i] = x - y;
        p.ofDifference += deviations[i] * deviations[i] * scale;
        // Half the difference of the halves is the noise of their mean, in size.
        const double half = (a.halves[i] - b.halves[i]) / 2;
        p.ofNoise += half * half / (values * values);
    }
    // Equal but for rounding, the parts have no spread whose pattern could be told.
    const bool spread = p.ofDifference > 1e-24 * (p.first * p.first + p.second * p.second);
    p.shared = spread ? sharedByNeighbours(deviations, a.columns) : 1;
    p.t = student975(n / 2);
    // Where noise is as large as the light, the shift of a clamped value no longer grows as the square of sigma: as
    // much as was taken off may remain (Gaussian noise, sRGB, light from 0.02: 0.3 of it at sigma 0.01, 0.9 at 0.05).
    constexpr double kRest = 1;
    const double taken = p.taken = (a.measured - b.measured) / values - (p.first - p.second);
    const double perInterval = p.t * p.t * p.shared;
    p.hidden = kRest * kRest * taken * taken / perInterval;
    // Where noise is as large as the light, twice the samples do not halve an encoded value's variance: up to a quarter
    // of what was taken off is too much (Gaussian noise, sRGB, any sigma).
    constexpr double kAlike = 0.25;
    const double both = kAlike * ((a.measured + b.measured) / values - (p.first + p.second)) / 2;
    p.common = both * both / perInterval;
    return p;
}

double decibels(double ratio) { return 10 * std::log10(ratio); }

// Positive ratios r of the second to the first that the parts allow: (second - r first)^2 <= c variance(second - r
// first). A method whose own error may be zero has a ratio without bound.
void setGainInterval(Comparison& c, const Paired& p) {
    const double wide = p.t * p.t * p.shared;
    const double A = p.first * p.first - wide * (p.ofFirst + p.hidden / 2 + p.common),
                 B = p.first * p.second - wide * (p.ofBoth + p.common),
                 C = p.second * p.second - wide * (p.ofSecond + p.hidden / 2 + p.common), inner = B * B - A * C;
    c.gainLow = -kInf, c.gainHigh = kInf;
    if (A == 0 && c.resolved) c.gainLow = kInf;  // the first is without error and without doubt
    if (inner < 0 || A == 0) return;
    const double one = (B - std::sqrt(inner)) / A, other = (B + std::sqrt(inner)) / A, low = std::min(one, other),
                 high = std::max(one, other);
    if (A > 0) {  // the ratios between the two
        if (low > 0) c.gainLow = decibels(low);
        if (high > 0)
            c.gainHigh = decibels(high);
        else if (c.resolved)  // none: one of the two is below zero by chance
            (c.mseDifference < 0 ? c.gainLow : c.gainHigh) = c.mseDifference < 0 ? kInf : -kInf;
    } else if (high > 1 && low < 1) {  // those below the one and above the other; which, the difference tells
        if (c.mseDifference < 0)
            c.gainLow = decibels(high);
        else if (low > 0)
            c.gainHigh = decibels(low);
    } else if (low <= 0 && high > 0) {
        c.gainLow = decibels(high);
    }
}

// Where the errors sit in few places, the spread of the parts' differences hides what each part shows by itself. The
// sign test does not ask how large an error is: where no part or one alone disagrees, with a chance below 0.001, the
// difference is resolved; and its gain lies between the parts' own, from the second least to the second largest, which
// is the interval that the test inverts to. A part counts by more than what the truth's noise may have moved it.
void tellByAgreement(Comparison& c, const Paired& p, const ErrorParts& a, const ErrorParts& b) {
    std::vector<double> gains;
    size_t better = 0, worse = 0;
    for (size_t i = 0; i < a.squares.size(); i++) {
        const double difference = a.squares[i] - b.squares[i], doubt = std::abs(p.taken) * a.values[i];
        if (difference == 0 || (a.squares[i] <= 0 && b.squares[i] <= 0)) continue;  // nothing to be seen of either
        better += difference<-doubt, worse += difference> doubt;
        gains.push_back(a.squares[i] <= 0 ? kInf : b.squares[i] <= 0 ? -kInf : decibels(b.squares[i] / a.squares[i]));
    }
    const size_t n = gains.size(), against = n - std::max(better, worse);
    const bool isBetter = better > worse;
    if (n < 2 || against > 1 || c.gainDb == 0 || isBetter != (c.mseDifference < 0)) return;
    // What neighbours share makes the parts fewer; or else, with a chance of 0.004 for nine of nine, all must agree by
    // what no chance makes.
    const auto chance = [&](double parts) { return 2 * (against ? parts + 1 : 1) * std::pow(0.5, parts); };
    constexpr double kPlainDb = 3;
    std::sort(gains.begin(), gains.end());
    const double least = isBetter ? gains.front() : -gains.back();
    if (chance(double(n) / p.shared) > 0.001 && (chance(double(n)) > 0.005 || least < kPlainDb)) return;
    c.resolved = true;
    (isBetter ? c.high : c.low) = 0;
    c.gainLow = std::min(gains[1], c.gainDb), c.gainHigh = std::max(gains[n - 2], c.gainDb);
}

FrameSum total(std::span<const FrameSum> frames) {
    FrameSum t;
    for (const auto& f : frames) t.sum += f.sum, t.count += f.count;
    return t;
}
// Half width of the 95 % interval of statistic(frames kept), where frames [first, last) are left out block by block.
std::optional<double> jackknife(size_t frames, const std::function<double(size_t first, size_t last)>& statistic) {
    const size_t blocks = std::min<size_t>(8, frames);
    if (blocks < 4) return {};
    std::vector<double> without;
    double mean = 0, squares = 0;
    for (size_t b = 0; b < blocks; b++) {
        without.push_back(statistic(b * frames / blocks, (b + 1) * frames / blocks));
        mean += without.back() / double(blocks);
    }
    for (double& v : without) {
        v -= mean;
        squares += v * v;
    }
    const double shared = sharedByNeighbours(without, int(blocks));
    if (shared > kSharedBy9) return {};
    const double half = student975(blocks / 2) * std::sqrt(shared * squares * double(blocks - 1) / double(blocks));
    return std::isfinite(half) ? std::optional(half) : std::nullopt;
}

// Whether two errors differ by no more than rounding: the same picture, computed in another order. Values of two such
// pictures differ by about one unit in the last place of full white, 2^-24. Where they do so by that in the root mean
// square, the squares of a part differ by 2 2^-24 sqrt(squares values) at most [Cauchy-Schwarz]. Such pairs that we
// know stay below a twentieth of it in every part (ssaa and msaa, gbaa and d2e); by what parts agree and not by their
// sum, which may agree by chance.
bool alikeButForRounding(const ErrorParts& a, const ErrorParts& b) {
    constexpr double kLastPlace = 0x1p-24;
    for (size_t i = 0; i < a.squares.size(); i++) {
        const double larger = std::max({a.squares[i], b.squares[i], 0.0});
        if (std::abs(a.squares[i] - b.squares[i]) > 2 * kLastPlace * std::sqrt(larger * a.values[i])) return false;
    }
    return true;
}

struct Named {
    Unresolved why;
    std::string_view name, words, brief;
};
constexpr Named kWhy[] = {
    {Unresolved::no, "no", "resolved", "yes"},
    {Unresolved::truthNoise, "truthNoise", "not resolved: the truth's noise", "noise"},
    {Unresolved::varies, "varies", "not resolved: it varies over the picture", "varies"},
    {Unresolved::tooSmall, "tooSmall", "not resolved: too small to judge", "too small"},
    {Unresolved::equal, "equal", "not resolved: the same picture but for rounding", "same"},
};
const Named& row(Unresolved why) {
    return *std::find_if(std::begin(kWhy), std::end(kWhy), [&](const Named& n) { return n.why == why; });
}
}  // namespace

std::string_view nameOf(Unresolved why) { return row(why).name; }
std::string_view inWords(Unresolved why) { return row(why).words; }
std::string_view inShort(Unresolved why) { return row(why).brief; }
Unresolved unresolvedByName(std::string_view name) {
    for (const Named& n : kWhy)
        if (n.name == name) return n.why;
    throw std::runtime_error("no such reason: '" + std::string(name) + "'");
}

MseInterval mseInterval(double raw, double noise) { return {std::max(0.0, raw - noise), raw}; }

std::vector<ErrorParts> errorParts(const TileErrors& errors) {
    std::vector<ErrorParts> all;
    if (errors.sum.empty()) return all;
    const size_t tilesX = errors.columns ? errors.columns : errors.sum.size(), tilesY = errors.sum.size() / tilesX;
    for (const size_t parts : {size_t(16), size_t(9)})
        if (const auto grid = gridOf(parts, tilesX, tilesY))
            all.push_back(partsOf(errors, tilesX, grid->first, grid->second));
    // Without an interval the means are still to be told.
    if (all.empty()) all.push_back(partsOf(errors, tilesX, 1, 1));
    return all;
}

Comparison compareMethods(std::span<const ErrorParts> first, std::span<const ErrorParts> second) {
    assert(!first.empty() && first.size() == second.size());
    if (alikeButForRounding(first[0], second[0])) return {};
    Comparison c;
    const double values = total(first[0].values), a = total(first[0].squares) / values,
                 b = total(second[0].squares) / values;
    c.mseDifference = a - b;
    c.gainDb = a == b ? 0 : a <= 0 && b <= 0 ? 0 : a <= 0 ? kInf : b <= 0 ? -kInf : decibels(b / a);
    c.low = c.gainLow = -kInf, c.high = c.gainHigh = kInf;
    c.why = Unresolved::tooSmall;
    for (size_t i = 0; i < first.size(); i++) {
        const size_t parts = first[i].squares.size();
        if (parts < 9) continue;
        Paired p = paired(first[i], second[i]);
        const bool together = p.shared > (parts == 16 ? kSharedBy16 : kSharedBy9);
        if (together) {
            p.t *= kBeyondDoubt;
            if (parts == 16 || !(std::abs(c.mseDifference) > p.half())) continue;
        }
        c.low = c.mseDifference - p.half(), c.high = c.mseDifference + p.half();
        c.resolved = c.low > 0 || c.high < 0;
        setGainInterval(c, p);
        if (!c.resolved && !together) tellByAgreement(c, p, first[i], second[i]);
        c.why = c.resolved                                               ? Unresolved::no
                : p.ofNoise + p.hidden > (p.ofDifference + p.hidden) / 2 ? Unresolved::truthNoise
                                                                         : Unresolved::varies;
        break;
    }
    return c;
}
Comparison compareMethods(const TileErrors& first, const TileErrors& second) {
    return compareMethods(errorParts(first), errorParts(second));
}

// An error's estimate is linear in the sum of the halves' noise as the difference of the halves is in their difference,
// so half of the latter shows how large the former is.
std::optional<GainInterval> gainOnThisPicture(const ErrorParts& first, const ErrorParts& second) {
    double noise = 0;
    for (size_t i = 0; i < first.halves.size(); i++) {
        const double halves = (second.halves[i] - first.halves[i]) / 2;
        noise += halves * halves;
    }
    const double before = total(first.squares), after = total(second.squares);
    const double half = student975(first.halves.size()) * std::sqrt(noise);
    if (!(before > 0 && after - half > 0)) return {};
    return GainInterval{decibels((after - half) / before), decibels((after + half) / before)};
}

std::optional<double> errorOverTime(std::span<const FrameSum> frames) {
    const FrameSum all = total(frames);
    if (!(all.sum > 0)) return {};
    return jackknife(frames.size(), [&](size_t first, size_t last) {
        const FrameSum out = total(frames.subspan(first, last - first));
        return (all.sum - out.sum) / (all.count - out.count);
    });
}

std::optional<TimeComparison> compareOverTime(std::span<const FrameSum> first, std::span<const FrameSum> second) {
    assert(first.size() == second.size());
    const FrameSum a = total(first), b = total(second);
    if (!(a.sum > 0) || !(b.sum > 0)) return {};
    const auto half = jackknife(first.size(), [&](size_t from, size_t to) {
        return 10 * std::log10((b.sum - total(second.subspan(from, to - from)).sum) /
                               (a.sum - total(first.subspan(from, to - from)).sum));
    });
    if (!half) return {};
    const double gain = 10 * std::log10(b.sum / a.sum);
    return TimeComparison{gain, gain - *half, gain + *half, std::abs(gain) > *half};
}

}  // namespace aa
