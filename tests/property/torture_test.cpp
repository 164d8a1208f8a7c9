// Extremes that no scene has and every method must bear, at its defaults, with every choice of every parameter, with
// every stage, in float and in double: sizes, motion, depth, light, denormals, and long sequences.
//
// Of finite input comes finite output, of light that is not negative none that is, weights lie in [0, 1], and float
// keeps to double. New methods and parameters are tried unasked. AA_TORTURE=long tries more seeds and sizes, and
// 100,000 frames in place of 3,000.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>

#include "frames.h"
#include "methods/float_bounds.h"
#include "methods/stage.h"
#include "study/stability.h"

namespace aa::testing {
namespace {

bool isLong() {
    const char* word = std::getenv("AA_TORTURE");
    return word && std::string_view(word) == "long";
}

// ---- what the methods are given -------------------------------------------------------------------------------------
using Draw = SurfaceDraw;
Draw fireflies(float value) {
    return [=](SplitMix64& g) {
        const auto channel = [&] { return g.uniform() < 0.1f ? value : 0.0f; };
        return surfaceByChance(g, {channel(), channel(), channel()}, 5);
    };
}
Draw depths(double least, double most) {
    return [=](SplitMix64& g) {
        return surfaceByChance(g, {g.uniform(), g.uniform(), g.uniform()}, logUniform(g, least, most));
    };
}

struct Case {
    std::string name;
    int width, height, frames;
    Draw draw;
    std::function<glm::vec2(SplitMix64&)> motionPx;
};
std::vector<Case> cases() {
    const auto rest = [](SplitMix64&) { return glm::vec2(0); };
    const auto some = [](SplitMix64& g) { return motionByChance(g, 0.1, 3); };
    const Draw wide = lightByChance(1e-6, 1e6);
    std::vector<Case> all = {
        {"1x1", 1, 1, 3, wide, some},
        {"1x7", 1, 7, 2, wide, some},
        {"7x1", 7, 1, 2, wide, some},
        {"3x3", 3, 3, 2, wide, some},
        {"odd", 17, 5, 2, wide, some},
        {"black", 9, 7, 2, lightByChance(1e-45, 1e-45), some},
        {"denormals", 9, 7, 2, lightByChance(1e-44, 1e-38), some},
        {"light up to the largest float", 9, 7, 3, lightByChance(1e-30, 3e38), some},
        {"fireflies of 1e18", 9, 7, 3, fireflies(1e18f), some},
        {"fireflies of 1e30", 9, 7, 2, fireflies(1e30f), some},
        {"fireflies of 1e6", 9, 7, 3, fireflies(1e6f), rest},
        {"motion from 0.001 to 1e6 px", 9, 7, 4, wide, [](SplitMix64& g) { return motionByChance(g, 1e-3, 1e6); }},
        {"motion that is no number", 9, 7, 3, wide,
         [](SplitMix64& g) { return g.uniform() < 0.3f ? glm::vec2(NAN, 1) : glm::vec2(1e30f, -1e30f); }},
        {"depth from 1e-10 to 1e10", 9, 7, 3, depths(1e-10, 1e10), some},
        {"depth of 1e-10", 9, 7, 2, depths(1e-10, 1e-10), some},
    };
    if (!isLong()) return all;
    for (const auto& [w, h] : {std::pair{2, 2}, {64, 1}, {1, 64}, {31, 33}, {65, 17}})
        all.push_back({std::to_string(w) + "x" + std::to_string(h), w, h, 6, wide, some});
    return all;
}

std::vector<Frame> makeFrames(const Case& c, unsigned seed, int samples) {
    std::vector<Frame> frames;
    for (int n = 1; n <= c.frames; n++) {
        frames.push_back(
            drawFrameByChance(seed, c.draw, c.motionPx, c.width, c.height, n, halton(n), pattern(samples)));
        encodeFrame(frames.back(), {}, {});
    }
    return frames;
}
// The methods of one pattern share them.
const std::vector<Frame>& framesOf(const Case& c, unsigned seed, int samples) {
    static std::map<std::tuple<std::string, unsigned, int>, std::vector<Frame>> made;
    auto& frames = made[{c.name, seed, samples}];
    if (frames.empty()) frames = makeFrames(c, seed, samples);
    return frames;
}

// ---- what is asked of them ------------------------------------------------------------------------------------------
// Filters with negative lobes, and what sharpens: their overshoot is theirs. Parts of the specification.
constexpr std::pair<const char*, const char*> kMayBeNegative[] = {
    {"mitchell", "negative lobes"},
    {"catmullRom", "negative lobes"},
    {"cubic", "negative lobes"},
    {"sinc", "negative lobes"},
    {"lanczos", "negative lobes"},
    {"Free", "negative lobes, not clamped"},
    {"historyClamp=off", "negative lobes, not clamped"},
};
const char* mayBeNegative(const std::string& text) {
    for (const auto& [part, why] : kMayBeNegative)
        if (text.find(part) != std::string::npos) return why;
    return nullptr;
}
bool isWeight(const std::string& layer) {
    for (const char* word : {"weight", "Weight", "share", "Share", "feedback", "blendAmount"})
        if (layer.find(word) != std::string::npos) return true;
    return false;
}
// Of an image: "" or what is wrong with its first bad value.
std::string faultOf(const Rgb& image, bool negativeAllowed) {
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < image.height(); y++)
            for (int x = 0; x < image.width(); x++) {
                const float v = image.c[c].at(x, y);
                if (std::isfinite(v) && (v >= 0 || negativeAllowed)) continue;
                return std::to_string(v) + " at (" + std::to_string(x) + ", " + std::to_string(y) + "), channel " +
                       std::to_string(c);
            }
    return "";
}
std::string faultOf(const std::vector<DebugLayer>& layers) {
    for (const auto& layer : layers)
        for (const auto& plane : layer.planes)
            for (int y = 0; isWeight(layer.name) && y < plane.height(); y++)
                for (int x = 0; x < plane.width(); x++)
                    if (!(plane.at(x, y) >= 0 && plane.at(x, y) <= 1))
                        return "weight " + std::to_string(plane.at(x, y)) + " in layer '" + layer.name + "'";
    return "";
}

// Counts, over all tests of this process.
struct Tally {
    size_t cases = 0;
    std::clock_t start = std::clock();
    void print(const char* what) const {
        std::printf("torture, %s: %zu cases, %.1f s of processor time\n", what, cases,
                    double(std::clock() - start) / CLOCKS_PER_SEC);
    }
};

// "" or what is wrong, and in which frame.
std::string faultOf(const std::string& text, const Case& c, unsigned seed, Precision precision) {
    Subject s = makeSubject(text, c.width, c.height);
    s.running.method->keepDebugLayers = true;
    Exec exec{.precision = precision, .parallel = false};
    for (const Frame& f : framesOf(c, seed, s.samples)) {
        s.running.resolve(f, f.display, exec);
        std::string fault = faultOf(s.running.out, mayBeNegative(text));
        if (fault.empty()) fault = faultOf(s.running.method->debugLayers());
        if (!fault.empty()) return text + ", " + c.name + ", frame " + std::to_string(f.number) + ": " + fault;
    }
    return "";
}
TEST(Torture, FiniteNotNegativeAndWeightsWithinOne) {
    Tally tally;
    std::map<std::string, int> faults;
    for (const auto& text : withEveryStage())
        for (const Case& c : cases())
            for (unsigned seed = 1; seed <= (isLong() ? 16u : 3u); seed++)
                for (const Precision precision : {Precision::fast, Precision::oracle}) {
                    tally.cases++;
                    const std::string fault = faultOf(text, c, seed, precision);
                    if (fault.empty()) continue;
                    if (++faults[c.name] <= 40) ADD_FAILURE() << fault << " (" << fileOf(text) << ")";
                }
    tally.print("finite, not negative, weights");
}

// The widest picture, one pixel high, and the highest: at the defaults.
TEST(Torture, LongestSides) {
    Tally tally;
    for (const auto& m : methodsUnderTest())
        for (const auto& [w, h] : {std::pair{16384, 1}, {1, 16384}}) {
            if (h > 1 && !isLong()) continue;
            tally.cases++;
            const Case c{
                std::to_string(w) + "x" + std::to_string(h), w, h, 2, lightByChance(1e-3, 1e3), [](SplitMix64& g) {
                    return motionByChance(g, 1e-3, 1e5);
                }};
            EXPECT_EQ(faultOf(std::string(m.id), c, 1, Precision::fast), "");
        }
    tally.print("longest sides");
}

// A history that runs on: no drift to NaN, no step that stalls above what it was given.
TEST(Torture, LongSequences) {
    Tally tally;
    const Case c{"4x4", 4, 4, 16, lightByChance(1e-6, 1e6), [](SplitMix64& g) { return motionByChance(g, 0.01, 2); }};
    const int frames = isLong() ? 100000 : 3000;
    for (const auto& m : methodsUnderTest()) {
        if (!m.temporal) continue;
        tally.cases++;
        const std::string text(m.id);
        Subject s = makeSubject(text, c.width, c.height);
        const auto& period = framesOf(c, 1, s.samples);
        for (int n = 0; n < frames; n++) {
            const Frame& f = period[size_t(n) % period.size()];
            if (n > 0 && f.reset) continue;  // one sequence
            s.running.resolve(f, f.display, {.parallel = false});
            const std::string fault = faultOf(s.running.out, false);
            ASSERT_EQ(fault, "") << text << " frame " << n;
        }
    }
    tally.print("long sequences");
}

// ---- float against double -------------------------------------------------------------------------------------------
TEST(Torture, FloatKeepsToDouble) {
    Tally tally;
    for (const auto& m : methodsUnderTest()) {
        tally.cases++;
        const FloatBound* bound = writtenFloatBound(m.id);
        const WideLightError e = wideLightError(specUnderTest(m.id));
        const double found = bound ? e.ofLargest : e.ofValue, allowed = bound ? bound->ofLargest : kFloatBound;
        EXPECT_LE(found, allowed) << m.id << ": " << e.ofValue << " of the value, " << e.ofLargest
                                  << " of the largest around (" << m.writtenAt.text() << ")";
        // A bound that is not needed would hide the next fault.
        if (bound) {
            EXPECT_GT(e.ofValue, kFloatBound) << m.id << ": keeps to " << kFloatBound << " without its bound";
        }
    }
    tally.print("float against double");
}

}  // namespace
}  // namespace aa::testing
