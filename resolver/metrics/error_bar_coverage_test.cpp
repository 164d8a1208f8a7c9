// Known comparisons by the hundred: how often the 95 % intervals hold the difference that was built in, how often equal
// methods are told apart, and whether the reason for not telling them apart is the right one.
//
// Every case counts 300 comparisons or more; AA_LONG_TESTS=1 adds pictures of 200 x 120 and 480 x 270 and
// prints.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "image/split_mix64.h"
#include "metrics/error_bar.h"
#include "metrics/measure.h"

namespace aa {
namespace {

struct Random : SplitMix64 {
    using SplitMix64::SplitMix64;
    double uniform() { return uniformDouble(); }
    double normal() {  // sum of four of 16 bits, variance 1
        const uint64_t z = next();
        const auto part = [&](int shift) { return double(z >> shift & 0xFFFF); };
        return (part(0) + part(16) + part(32) + part(48) - 2 * 65535.0) * (std::sqrt(3.0) / 65536);
    }
};

// Two methods whose errors are noise of a strength that changes from place to place, as it does along edges.
struct Case {
    int width, height;
    double truthSigma = 0;    // of the mean of the halves, linear
    double ratio = 1;         // of the second method's mean squared error to the first's
    double offset = 0;        // what the second adds to every value, encoded: where a biased truth would show
    double unevenness = 0.8;  // of the strength: sigma of its logarithm
    int patchPx = 4;          // side of the patches of one strength
    double mse = 4e-4;        // the first's: PSNR 34 dB
};
struct Drawn {
    TileErrors first, second;
    double difference = 0, gainDb = 0;  // of all pictures of this kind
};
Drawn draw(const Case& c, Random& random) {
    const int w = c.width, h = c.height, across = w / c.patchPx + 2, down = h / c.patchPx + 2;
    const auto patches = [&](auto value) {
        std::vector<double> v(size_t(across * down));
        for (double& x : v) x = value();
        return v;
    };
    const int shiftX = int(random.next() % uint64_t(c.patchPx)), shiftY = int(random.next() % uint64_t(c.patchPx));
    const auto base = patches([&] { return random.normal(); });
    const auto strength = [&] {
        std::vector<double> v(base.size());
        for (size_t i = 0; i < v.size(); i++)  // both methods fail at much the same places
            v[i] = std::exp(0.5 * c.unevenness * (0.8 * base[i] + 0.6 * random.normal()) -
                            c.unevenness * c.unevenness / 4);
        return v;
    };
    const auto first = strength(), second = strength(),
               light = patches([&] { return 0.02 + 0.85 * random.uniform() * random.uniform(); });
    Rgb a(w, h), b(w, h), exact(w, h);
    for (size_t ch = 0; ch < 3; ch++)
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++) {
                const double r = light[size_t((y + shiftY) / c.patchPx * across + (x + shiftX) / c.patchPx)];
                exact.c[ch].at(x, y) = float(r);
                const double sigma = c.truthSigma * std::sqrt(2.0);
                a.c[ch].at(x, y) = float(std::max(0.0, r + sigma * random.normal()));
                b.c[ch].at(x, y) = float(std::max(0.0, r + sigma * random.normal()));
            }
    const Reference reference = makeReference(a, b, {}, {});
    Rgb encoded, test;
    encode(exact, {}, {}, encoded);
    const auto method = [&](const std::vector<double>& field, double mse, double offset) {
        test = encoded;
        for (size_t ch = 0; ch < 3; ch++)
            for (int y = 0; y < h; y++)
                for (int x = 0; x < w; x++)
                    test.c[ch].at(x, y) +=
                        float(offset + std::sqrt(mse) * random.normal() *
                                           field[size_t((y + shiftY) / c.patchPx * across + (x + shiftX) / c.patchPx)]);
        return tileErrors(test, reference, {});
    };
    Drawn d;
    // The spread of exp(u n / 2) squared is exp(u n), whose mean is exp(u^2 / 2): taken off above.
    d.first = method(first, c.mse, 0);
    d.second = method(second, c.mse * c.ratio, c.offset);
    const double other = c.mse * c.ratio + c.offset * c.offset;
    d.difference = c.mse - other, d.gainDb = 10 * std::log10(other / c.mse);
    return d;
}

struct Tally {
    int judged = 0, covered = 0, gainCovered = 0, resolved = 0, wrongSide = 0, disagree = 0, all = 0;
    int why[5] = {};
    double percent(int of) const { return 100.0 * of / all; }
};
Tally tally(const Case& c, uint64_t seed, int comparisons = 300) {
    Random random{seed};
    Tally t;
    for (int i = 0; i < comparisons; i++) {
        const Drawn d = draw(c, random);
        const Comparison found = compareMethods(d.first, d.second);
        t.all++;
        t.why[int(found.why)]++;
        if (found.why == Unresolved::tooSmall) continue;
        t.judged++;
        t.covered += found.low <= d.difference && d.difference <= found.high;
        t.gainCovered += found.gainLow <= d.gainDb && d.gainDb <= found.gainHigh;
        t.resolved += found.resolved;
        t.wrongSide += found.resolved && d.difference != 0 && (found.mseDifference > 0) != (d.difference > 0);
        t.disagree += found.resolved != (found.gainLow > 0 || found.gainHigh < 0);
    }
    return t;
}
struct Size {
    int width, height, comparisons;
};
// More comparisons where they cost little: a share of 5 % is then known better.
std::vector<Size> sizes() {
    std::vector<Size> all = {{32, 32, 500}, {48, 40, 400}, {64, 48, 300}};
    if (std::getenv("AA_LONG_TESTS"))
        all.push_back({96, 64, 300}), all.push_back({200, 120, 300}), all.push_back({480, 270, 300});
    return all;
}
void print(const Case& c, const Tally& t) {
    if (!std::getenv("AA_LONG_TESTS")) return;
    std::printf(
        "%d x %d, sigma %g, ratio %g, offset %g: coverage %.1f %% (gain %.1f %%), resolved %.1f %%, too small %d "
        "of %d\n",
        c.width, c.height, c.truthSigma, c.ratio, c.offset, 100.0 * t.covered / t.judged,
        100.0 * t.gainCovered / t.judged, t.percent(t.resolved), t.why[int(Unresolved::tooSmall)], t.all);
}
std::string traceOf(const Case& c) {
    return std::to_string(c.width) + " x " + std::to_string(c.height) + ", sigma " + std::to_string(c.truthSigma) +
           ", ratio " + std::to_string(c.ratio) + ", offset " + std::to_string(c.offset);
}

TEST(ErrorBarCoverage, IntervalsHoldTheKnownDifference) {
    uint64_t seed = 1;
    for (const Size& size : sizes())
        for (const double sigma : {0.001, 0.01, 0.05})
            for (const auto& [ratio, offset] : {std::pair{1.0, 0.0}, {1.4, 0.0}, {1.0, 0.02}}) {
                const Case c{
                    .width = size.width, .height = size.height, .truthSigma = sigma, .ratio = ratio, .offset = offset};
                // Under a noise as large as most of the light a steady difference is hidden: the next test.
                if (sigma == 0.05 && offset > 0) continue;
                const Tally t = tally(c, seed++, size.comparisons);
                SCOPED_TRACE(traceOf(c));
                print(c, t);
                EXPECT_GE(100.0 * t.covered / t.judged, 90);
                // What higher orders of the noise may hide is a bound and no spread: where it is most of an interval,
                // of large pictures with a steady difference, the interval holds always.
                if (sigma < 0.01 || offset == 0) {
                    EXPECT_LE(100.0 * t.covered / t.judged, 99);
                }
                EXPECT_GE(100.0 * t.gainCovered / t.judged, 90);
                EXPECT_EQ(t.disagree, 0) << "difference and gain tell the same";
                EXPECT_GE(t.judged, 0.9 * t.all);
                if (ratio == 1 && offset == 0) {
                    EXPECT_LE(t.percent(t.resolved), 5);
                }
                EXPECT_LE(t.percent(t.wrongSide), 1);
            }
}
// The truth's clamped noise moves every dark pixel, which a method that is off everywhere the same way meets squarely.
// Two halves cannot tell by how much: the interval holds nearly as often as it should, and says that it is the noise.
TEST(ErrorBarCoverage, NoiseBeyondTheLightIsNotTakenForAGain) {
    uint64_t seed = 100;
    for (const Size& size : sizes()) {
        const Case c{.width = size.width, .height = size.height, .truthSigma = 0.05, .offset = 0.02};
        const Tally t = tally(c, seed++, 300);
        SCOPED_TRACE(traceOf(c));
        print(c, t);
        EXPECT_GE(100.0 * t.covered / t.judged, 85);
        EXPECT_LE(t.percent(t.wrongSide), 2.5);
        EXPECT_GE(t.why[int(Unresolved::truthNoise)], 0.9 * (t.judged - t.resolved));
    }
}
TEST(ErrorBarCoverage, TheReasonIsTheRightOne) {
    // The same small difference everywhere, hidden by the truth's noise.
    Case c{.width = 96, .height = 64, .truthSigma = 0.03, .ratio = 1.1, .unevenness = 0.1, .mse = 1e-5};
    Tally t = tally(c, 201);
    EXPECT_LT(t.resolved, 0.5 * t.all) << "else there is little to be said";
    EXPECT_GE(t.why[int(Unresolved::truthNoise)], 0.9 * (t.judged - t.resolved));
    // The errors' strength from place to place hides it, under a clean truth.
    c = {.width = 96, .height = 64, .truthSigma = 0.001, .ratio = 1.1, .unevenness = 1.5};
    t = tally(c, 202);
    EXPECT_LT(t.resolved, 0.5 * t.all);
    EXPECT_GE(t.why[int(Unresolved::varies)], 0.9 * (t.judged - t.resolved));
    // A picture with one patch or two has one or two places to tell of.
    c = {.width = 16, .height = 16, .ratio = 1.4};
    t = tally(c, 203, 50);
    EXPECT_EQ(t.why[int(Unresolved::tooSmall)], 50);
    c = {.width = 64, .height = 64, .truthSigma = 0.001, .ratio = 1.4, .unevenness = 1.5, .patchPx = 48};
    t = tally(c, 204);
    EXPECT_GE(t.why[int(Unresolved::tooSmall)], 0.5 * t.all);
    EXPECT_LE(t.resolved, 0.25 * t.all);
    // Not every one of them shows that it holds four patches alone.
    c.ratio = 1;
    EXPECT_LE(tally(c, 205).resolved, 0.1 * 300);
    // Yet what is beyond doubt is said.
    c.offset = 0.1;
    t = tally(c, 206, 100);
    EXPECT_GE(t.resolved, 0.9 * t.all);
    EXPECT_EQ(t.wrongSide, 0);
}

// A window with blinds holds most of a picture's error. What every part shows is told all the same, and by how much;
// what parts disagree on is not, however the errors are spread.
TEST(ErrorBarCoverage, ErrorsThatSitInFewPlaces) {
    Random random{300};
    for (const double spread : {1.5, 2.5})
        for (const double ratio : {1.0, 0.1}) {
            const int kRuns = 400;
            int resolved = 0, wrongSide = 0, held = 0;
            for (int run = 0; run < kRuns; run++) {
                ErrorParts a{.columns = 4, .rows = 4, .squares = {}, .halves = {}, .values = {}}, b = a;
                for (int i = 0; i < 16; i++) {
                    const double strength = std::exp(spread * random.normal());
                    const double own = std::exp(0.5 * random.normal() - 0.125);
                    a.squares.push_back(strength * own),
                        b.squares.push_back(strength * ratio * std::exp(0.5 * random.normal() - 0.125));
                    for (ErrorParts* p : {&a, &b})
                        p->halves.push_back(0), p->values.push_back(1000), p->measured += p->squares.back();
                }
                const Comparison c = compareMethods({&a, 1}, {&b, 1});
                resolved += c.resolved;
                wrongSide += c.resolved && ratio != 1 && c.mseDifference < 0;
                EXPECT_EQ(c.resolved, c.gainLow > 0 || c.gainHigh < 0);
                EXPECT_TRUE(c.why == Unresolved::tooSmall || (c.gainLow <= c.gainDb && c.gainDb <= c.gainHigh));
                held += c.gainLow <= 10 * std::log10(ratio) && 10 * std::log10(ratio) <= c.gainHigh;
            }
            SCOPED_TRACE("spread " + std::to_string(spread) + ", ratio " + std::to_string(ratio));
            if (std::getenv("AA_LONG_TESTS"))
                std::printf("spread %g, ratio %g: resolved %d of %d, gain held %d\n", spread, ratio, resolved, kRuns,
                            held);
            if (ratio == 1)
                EXPECT_LE(resolved, 0.05 * kRuns);
            else
                EXPECT_GE(resolved, 0.9 * kRuns);
            EXPECT_EQ(wrongSide, 0);
            EXPECT_GE(held, 0.9 * kRuns);
        }
}

// Figures over time whose frames share their history: a first-order memory of `memory`.
TEST(ErrorBarCoverage, OverTime) {
    Random random{7};
    for (const int frames : {6, 16, 64})
        for (const double memory : {0.0, 0.3}) {
            const int kRuns = 1000;
            int covered = 0, judged = 0, told = 0, errorsCovered = 0, errorsJudged = 0;
            for (int run = 0; run < kRuns; run++) {
                std::vector<FrameSum> a, b;
                double x = random.normal(), y = random.normal();
                for (int i = 0; i < frames; i++) {
                    const double fresh = std::sqrt(1 - memory * memory);
                    x = memory * x + fresh * random.normal(), y = memory * y + fresh * random.normal();
                    a.push_back({1000 * (1 + 0.1 * x), 1000}), b.push_back({1000 * (1 + 0.1 * y), 1000});
                }
                if (const auto c = compareOverTime(a, b)) {
                    judged++, covered += c->low <= 0 && c->high >= 0, told += c->resolved;
                }
                if (const auto e = errorOverTime(a)) {
                    double mean = 0;
                    for (const FrameSum& f : a) mean += f.sum / f.count / frames;
                    errorsJudged++, errorsCovered += std::abs(mean - 1) <= *e;
                }
            }
            SCOPED_TRACE(std::to_string(frames) + " frames, memory " + std::to_string(memory));
            if (std::getenv("AA_LONG_TESTS"))
                std::printf("%d frames, memory %g: coverage %.1f %% (one method %.1f %%), judged %d of %d\n", frames,
                            memory, 100.0 * covered / judged, 100.0 * errorsCovered / errorsJudged, judged, kRuns);
            EXPECT_GE(covered, 0.9 * judged);
            EXPECT_LE(covered, 0.99 * judged);
            EXPECT_GE(errorsCovered, 0.9 * errorsJudged);
            EXPECT_GE(judged, 0.8 * kRuns);
            EXPECT_LE(told, (memory > 0 ? 0.07 : 0.05) * kRuns);
        }
}
}  // namespace
}  // namespace aa
