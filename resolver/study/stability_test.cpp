// The measuring itself, on methods whose answer is known.
#include "study/stability.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "methods/driver.h"
#include "study/stability_frames.h"

namespace aa {
namespace {
using namespace stability;

// A method that is a function of one value, of the precision and of how many frames came before.
using Function = std::function<float(float value, bool isDouble, int before)>;
class OfValue : public Method {
  public:
    explicit OfValue(Function f) : f_(std::move(f)) {}
    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        before_ = frame.reset ? 0 : before_ + 1;
        for (size_t c = 0; c < 3; c++)
            for (int y = 0; y < frame.height; y++)
                for (int x = 0; x < frame.width; x++)
                    out.c[c].at(x, y) =
                        f_(frame.colorLinear.c[c].at(x, y), exec.precision == Precision::oracle, before_);
    }

  private:
    Function f_;
    int before_ = 0;
};
MethodSpec known(const Function& f, bool temporal = false) {
    auto own = std::make_shared<MethodDescriptor>();
    own->id = "known", own->family = temporal ? "temporal" : "spatial";
    own->passes = Pass::color;
    own->temporal = temporal;
    own->create = [f](const Params&, const ShotInfo&) { return std::make_unique<OfValue>(f); };
    MethodSpec spec;
    spec.text = "known", spec.method = own.get(), spec.owner = own;
    return spec;
}
std::vector<Frame> framesOf(float value, int count = 1) {
    std::vector<Frame> frames;
    for (int n = 1; n <= count; n++) {
        Frame f;
        f.number = n, f.width = 16, f.height = 8, f.reset = n == 1;
        f.passes = Pass::color;
        f.colorLinear = Rgb(16, 8, value);
        encodeFrame(f, {}, {});
        frames.push_back(f);
    }
    return frames;
}
const ShotInfo kInfo{.width = 16, .height = 8};

TEST(Stability, DeviationIsWhatFloatAdds) {
    // One value of 128 is off by four units in the last place of 0.7 (2^-24), the others by one.
    int count = 0;
    const MethodSpec m =
        known([&](float v, bool isDouble, int) { return isDouble ? v : v + (count++ == 5 ? 4 : 1) * 0x1p-24f; });
    const Deviation d = deviation(m, m, framesOf(0.7f), kInfo);
    EXPECT_DOUBLE_EQ(d.max, 4 * 0x1p-24);
    EXPECT_NEAR(d.rms, 0x1p-24 * std::sqrt((383 + 16) / 384.0), 1e-12);
    EXPECT_EQ(d.ulp, 1);
    EXPECT_EQ(d.ulpMost, 4);
    EXPECT_EQ(d.notFinite, 0u);
    // Above 1 differences are relative; a value that is none in one form is counted, and is in no other figure.
    const MethodSpec bright = known([](float v, bool isDouble, int) { return isDouble ? v : v * 1.5f; });
    EXPECT_DOUBLE_EQ(deviation(bright, bright, framesOf(1000), kInfo).max, 0.5);
    const MethodSpec broken = known([](float v, bool isDouble, int) { return isDouble ? v : NAN; });
    EXPECT_EQ(deviation(broken, broken, framesOf(0.7f), kInfo).notFinite, 384u);
    EXPECT_EQ(deviation(broken, broken, framesOf(0.7f), kInfo).max, 0);
}

TEST(Stability, AmplificationCountsUnitsInTheLastPlace) {
    const MethodSpec copy = known([](float v, bool, int) { return v; });
    const Amplification same = amplification(copy, framesOf(0.7f, 3), kInfo, 1);
    EXPECT_EQ(same.most, std::vector<double>(3, 1.0));
    EXPECT_EQ(same.rms, std::vector<double>(3, 1.0));
    // What is left of 0.8 has units a sixteenth as large: 0.05 lies four binades below.
    const MethodSpec difference = known([](float v, bool, int) { return v - 0.75f; });
    EXPECT_EQ(amplification(difference, framesOf(0.8f), kInfo, 1).largest(), 16);
    // A change that doubles with each frame; the squares in `rms` see it, too.
    const MethodSpec growing = known([](float v, bool, int before) { return 0.7f + (v - 0.7f) * float(1 << before); });
    EXPECT_EQ(amplification(growing, framesOf(0.7f, 4), kInfo, 1).most, (std::vector<double>{1, 2, 4, 8}));
    // Nothing is added to black.
    EXPECT_EQ(amplification(copy, framesOf(0), kInfo, 1).largest(), 0);
}

TEST(Stability, TiesAreThePixelsThatJump) {
    std::vector<Frame> frames = framesOf(0.4f);
    const auto put = [&](int x, float v) {
        for (auto& p : frames[0].colorLinear.c) p.at(x, 3) = v;
    };
    put(2, 0.5f), put(5, 0.5f * (1 + 0.5e-6f)), put(7, 0.5f * (1 - 0.5e-6f));  // within a millionth of the threshold
    put(9, 0.5f * (1 + 2e-6f)), put(11, 0.5f * (1 - 2e-6f));                   // not
    const MethodSpec edge = known([](float v, bool, int) { return v >= 0.5f ? 1.0f : 0.0f; });
    const Ties t = ties(edge, frames, kInfo, 1);
    EXPECT_EQ(t.pixels, 3u);
    EXPECT_EQ(t.of, 128u);
    // What follows its input smoothly has no ties, as long as its slope is below 100; nor has a clip, which is
    // continuous.
    EXPECT_EQ(ties(known([](float v, bool, int) { return 50 * v; }), frames, kInfo, 1).pixels, 0u);
    EXPECT_EQ(ties(known([](float v, bool, int) { return std::min(v, 0.5f); }), frames, kInfo, 1).pixels, 0u);
}
// Rounding is no decision: only the double form is asked.
TEST(Stability, TiesAreOfTheDoubleForm) {
    const MethodSpec noisy =
        known([](float v, bool isDouble, int) { return isDouble ? v : std::floor(v * 1e7f) * 1e-3f; });
    EXPECT_EQ(ties(noisy, framesOf(0.4f), kInfo, 1).pixels, 0u);
}

// (c - h) (1 - k) below half a code never reaches a stored byte: of eight codes, steps of 0.24 show one and keep none.
TEST(Stability, AHistoryOfBytesStalls) {
    const MethodSpec slow = parseMethod("unchartedNoSharpen:kmin=0.97,kmax=0.97");
    EXPECT_NEAR(settling(*withHistory(slow, "8"), 128).stallCodes, 0.97 * 8, 1e-3);
    EXPECT_NEAR(settling(slow, 128).stallCodes, 8 * std::pow(0.97, 256), 1e-3);
    // Steps of 2.4 codes arrive, but for the last that is less than half a code.
    const MethodSpec fast = parseMethod("unchartedNoSharpen:kmin=0.7,kmax=0.7,historyBits=8");
    EXPECT_LE(settling(fast, 128).stallCodes, 0.7 * 0.5 / 0.3 + 1e-3);
    EXPECT_GT(settling(fast, 128).stallCodes, 0.1);
}
// What is shown is 0.97 of a gradient of codes: a sawtooth of 0.29 RMS, of which a blur of 4 px leaves 0.18 at 36 px.
TEST(Stability, BytesBandAndFloatsDoNot) {
    const MethodSpec slow = parseMethod("unchartedNoSharpen:kmin=0.97,kmax=0.97");
    EXPECT_LT(settling(slow, 128).bandingCodes, 1e-4);
    EXPECT_NEAR(settling(*withHistory(slow, "8"), 128).bandingCodes, 0.17, 0.04);
}
TEST(Stability, DriftIsTheChangeOfTheMean) {
    const MethodSpec drifting = known([](float v, bool, int before) { return v * (1 + 1e-4f * float(before)); }, true);
    // Frames 497 to 512 against 241 to 256, counted from 0.
    EXPECT_NEAR(settling(drifting, 512).drift, (1 + 503.5e-4) / (1 + 247.5e-4) - 1, 2e-5);
    EXPECT_NEAR(settling(parseMethod("taaSimplest"), 512).drift, 0, 1e-6);
}

// Of a history of weight k a light of 1e6 leaves (1 - k) k^n 1e6 after n frames. The darkest wall, 0.04, shows half a
// code for the last time while that is 6.8e-4 and more.
TEST(Stability, AnExponentialHistoryRecoversWhenItsFormulaSays) {
    const Recovery half = recovery(parseMethod("taaSimplest:k=0.5"), 512);
    EXPECT_EQ(half.tried, 448);
    EXPECT_EQ(half.frames, 29);  // 0.5^30 1e6 = 9.3e-4, and half of that in the next frame
    const Recovery slower = recovery(parseMethod("taaSimplest:k=0.8"), 512);
    ASSERT_TRUE(slower.frames);
    EXPECT_NEAR(*slower.frames, std::log(6.83e-4 / (0.2 * 1e6)) / std::log(0.8), 1);
    EXPECT_EQ(recovery(parseMethod("noaa"), 512).frames, 0);
    EXPECT_FALSE(recovery(parseMethod("taaSimplest:k=0.999"), 512).frames);
}

TEST(Stability, WideLightSeesRelativeErrors) {
    const MethodSpec off = known([](float v, bool isDouble, int) { return isDouble ? v : v * 1.01f; });
    EXPECT_NEAR(wideLightError(off).ofValue, 0.01, 1e-6);
    const MethodSpec dark = known([](float v, bool isDouble, int) { return isDouble ? v : v + 1e-3f; });
    EXPECT_GT(wideLightError(dark).ofValue, 1);
    EXPECT_LT(wideLightError(dark).ofLargest, 1e-4);
    const MethodSpec broken = known([](float v, bool isDouble, int) { return isDouble ? v : INFINITY; });
    EXPECT_EQ(wideLightError(broken).ofValue, INFINITY);
}

TEST(Stability, HistoriesAreTheSameMethodOtherwise) {
    EXPECT_FALSE(withHistory(parseMethod("karis"), "8"));  // linear light
    EXPECT_FALSE(withHistory(parseMethod("fxaa311"), "16f"));
    EXPECT_TRUE(withHistory(parseMethod("fxaa311"), "32f"));
    const auto narrow = withHistory(parseMethod("uncharted:kmin=0.5,historyBits=8,dither=on"), "16f");
    ASSERT_TRUE(narrow);
    EXPECT_EQ(narrow->params().choice("historyBits"), "16f");
    EXPECT_TRUE(narrow->params().flag("dither"));
    const auto wide = withHistory(*narrow, "32f");
    EXPECT_EQ(wide->params().choice("historyBits"), "32f");
    EXPECT_EQ(wide->params().real("kmin"), 0.5);
}

TEST(Stability, TheStudyIsTheSameForAnyThreads) {
    StabilityOptions o;
    for (const char* text : {"noaa", "fxaa311", "uncharted", "sraa", "gpaa"}) o.methods.push_back(parseMethod(text));
    o.width = 48, o.height = 27, o.frames = 16, o.longFrames = 128;
    o.noDevice = "none here";
    size_t steps = 0;
    Progress counted;
    counted.step = [&](const std::string&) { steps++; };
    const StabilityResults parallel = measureStability(o, counted);
    EXPECT_EQ(steps, 5u);
    o.exec.parallel = false;
    const StabilityResults alone = measureStability(o, {});
    EXPECT_EQ(toJsonText(parallel), toJsonText(alone));
    const auto& m = parallel.methods;
    EXPECT_EQ(m[0].lanes.max, 0);
    EXPECT_EQ(m[0].amplification.largest(), 1);
    EXPECT_FALSE(m[1].settling);
    ASSERT_TRUE(m[2].settling && m[2].settlingHalf && m[2].settlingByte && m[2].recovery);
    EXPECT_GT(m[2].byte->max, m[2].half->max);
    EXPECT_GT(m[2].half->max, m[2].lanes.max);
    EXPECT_EQ(m[2].amplification.most.size(), 16u);
    EXPECT_EQ(m[1].amplification.most.size(), size_t(kStatelessFrames));
    const std::string text = toText(parallel), page = toMarkdown(parallel);
    for (const char* words : {"uncharted", "GPU forms left out: none here.", "stall, codes"}) {
        EXPECT_NE(text.find(words), std::string::npos) << words;
        EXPECT_NE(page.find(words), std::string::npos) << words;
    }
    EXPECT_NE(page.find("| `salvi` | 0.02 |"), std::string::npos);  // the written bounds
    // Stopped, it holds what is done and says so.
    Progress stopped;
    size_t done = 0;
    stopped.step = [&](const std::string&) { done++; };
    stopped.interrupted = [&] { return done >= 2; };
    const StabilityResults part = measureStability(o, stopped);
    EXPECT_FALSE(part.complete);
    EXPECT_EQ(part.methods.size(), 2u);
}

}  // namespace
}  // namespace aa
