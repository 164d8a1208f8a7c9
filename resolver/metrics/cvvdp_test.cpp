#include "metrics/cvvdp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "image/error.h"
#include "metrics/cvvdp_constants.h"

namespace aa {
namespace {
using nlohmann::json;

// The sequences of tests/reference/cvvdp_reference.py, which says what they are.
unsigned noise(unsigned x, unsigned y, unsigned t, unsigned c, unsigned seed) {
    unsigned h = x * 374761393u + y * 668265263u + t * 2246822519u + c * 3266489917u + seed * 2654435761u;
    h = (h ^ (h >> 13)) * 1274126177u;
    return (h ^ (h >> 16)) & 255;
}
struct Formula {
    int width, height;
    std::string kind;
    int amount;
    float scale = 1;
    int picture(int x, int y, int t, int c) const {
        const int squares = (((x + 2 * t) / 8 + y / 8) & 1) * 40;
        return 30 + x * 120 / width + squares + 10 * c * (y * 3 / height) +
               int(noise(unsigned(x), unsigned(y), 0, unsigned(c), 1)) * 16 / 256;
    }
    int wrong(int x, int y, int t, int c) const {
        const auto grain = [&](int time) {
            return int(noise(unsigned(x), unsigned(y), unsigned(time), unsigned(c), 2)) * (2 * amount + 1) / 256 -
                   amount;
        };
        const int own = picture(x, y, t, c);
        if (kind == "grain") return own + grain(t);
        if (kind == "texture") return own + grain(0);
        if (kind == "flicker") return own + amount * (1 - 2 * (t & 1));
        if (kind == "tint") return own + amount * (1 - c);
        if (kind == "shift") return picture(x + amount, y, t, c);
        EXPECT_EQ(kind, "patch");
        return own + (x > width / 2 && y > height / 2 ? amount : 0);
    }
    Rgb frame(int t, bool test) const {
        Rgb image(width, height);
        for (int c = 0; c < 3; c++)
            for (int y = 0; y < height; y++)
                for (int x = 0; x < width; x++) {
                    const int code = test ? wrong(x, y, t, c) : picture(x, y, t, c);
                    image.c[size_t(c)].at(x, y) = float(std::clamp(code, 0, 255)) / 255.0f * scale;
                }
        image.fillBorder();
        return image;
    }
};
struct Judged {
    std::vector<std::vector<double>> frames;
    std::vector<double> overall;
    std::vector<PlaneF> maps;
};
Judged judge(const Formula& f, SequenceSetting setting, int frames, const Exec& exec) {
    setting.width = f.width, setting.height = f.height, setting.still = frames == 1;
    const auto reference = cvvdp(setting);
    const auto test = reference->test();
    Judged judged;
    for (int t = 0; t < frames; t++) {
        const Rgb r = f.frame(t, false), own = f.frame(t, true);
        reference->add({r, &r}, exec);
        judged.frames.push_back(test->add({own, &own}, exec));
        if (setting.withMaps) judged.maps.push_back(test->latestMap(exec));
    }
    judged.overall = test->overall();
    return judged;
}
json vectors() {
    const char* const file = AA_SOURCE_DIR "/tests/reference/cvvdp_vectors.json";
    std::ifstream in(file);
    if (!in) throw std::runtime_error(std::string(file) + " is missing");
    return json::parse(in).at("sequences");
}
Formula formulaOf(const json& v) {
    return {v.at("width"), v.at("height"), v.at("kind"), v.at("amount"), v.value("scale", 1.0f)};
}
SequenceSetting settingOf(const json& v) {
    SequenceSetting s;
    s.viewing = {&displayModelByName(v.at("display").get<std::string>()), v.at("fps")};
    s.withMaps = v.contains("map");
    return s;
}

TEST(Cvvdp, AgreesWithTheReferenceProgram) {
    const json all = vectors();
    EXPECT_GE(all.size(), 14u);
    for (const auto& v : all)
        for (const auto precision : {Precision::fast, Precision::oracle}) {
            SCOPED_TRACE(v.at("name").get<std::string>());
            Exec exec;
            exec.precision = precision;
            const Judged found = judge(formulaOf(v), settingOf(v), v.at("frames"), exec);
            EXPECT_NEAR(found.overall[0], v.at("jod").get<double>(), 1e-4);
            const std::vector<double> perFrame = v.value("perFrame", std::vector<double>{});
            for (size_t i = 0; i < perFrame.size(); i++) EXPECT_NEAR(found.frames[i][0], perFrame[i], 1e-4) << i;
            const std::vector<std::array<double, 2>> maps = v.value("map", std::vector<std::array<double, 2>>{});
            for (size_t i = 0; i < maps.size(); i++) {
                double sum = 0, most = 0;
                for (int y = 0; y < found.maps[i].height(); y++)
                    for (int x = 0; x < found.maps[i].width(); x++) {
                        const double lost = double(found.maps[i].at(x, y));
                        sum += lost, most = std::max(most, lost);
                    }
                // The reference keeps its map in half floats.
                EXPECT_NEAR(sum / (found.maps[i].width() * found.maps[i].height()), maps[i][0], 0.003) << i;
                EXPECT_NEAR(most, maps[i][1], 0.01) << i;
            }
        }
}
TEST(Cvvdp, IdenticalIsExactlyTen) {
    const Formula f{70, 50, "tint", 0};
    const SequenceSetting setting{.withMaps = true};
    for (const int frames : {1, 5}) {
        const Judged found = judge(f, setting, frames, {});
        for (const double v : found.overall) EXPECT_EQ(v, 10.0);
        for (const auto& frame : found.frames)
            for (const double v : frame) EXPECT_EQ(v, 10.0);
        EXPECT_TRUE(found.maps.back().samePixels(PlaneF(70, 50)));
    }
}
// Each kind of error takes most from the channel that is there for it.
TEST(Cvvdp, ChannelsTellErrorsApart) {
    enum { all, sustained, redGreen, yellowViolet, transient };
    const auto least = [](const std::vector<double>& jod) {
        return std::min_element(jod.begin() + 1, jod.end()) - jod.begin();
    };
    const auto of = [](const std::string& kind, int amount) {
        return judge({96, 64, kind, amount}, {}, 8, {}).overall;
    };
    EXPECT_EQ(least(of("flicker", 4)), transient);
    EXPECT_EQ(least(of("texture", 20)), sustained);
    EXPECT_GT(of("tint", 8)[transient], 9.99);
    EXPECT_LT(of("tint", 8)[redGreen], 9.9);
    for (const std::string kind : {"flicker", "texture", "tint"})
        for (size_t c = 1; c <= 4; c++) EXPECT_GE(of(kind, 8)[c], of(kind, 8)[all]) << kind << c;
}
// The same grain, once standing and once new in every frame, has the same squared error and is not the same to see;
// likewise a sequence at another distance or frame rate.
TEST(Cvvdp, TimeAndDistanceCount) {
    const auto jod = [](const std::string& kind, const char* display, double fps) {
        return judge({96, 64, kind, 12}, {.viewing = {&displayModelByName(display), fps}}, 12, {}).overall[0];
    };
    EXPECT_LT(jod("texture", "standard_4k", 60), jod("grain", "standard_4k", 60) - 0.05);
    EXPECT_LT(jod("texture", "standard_fhd", 30), jod("texture", "standard_4k", 30) - 0.05);
    EXPECT_NE(jod("grain", "standard_4k", 60), jod("grain", "standard_4k", 24));
}
TEST(Cvvdp, SameBitsEverywhere) {
    const Formula f{301, 43, "shift", 1};  // more than one strip
    const SequenceSetting setting{.withMaps = true};
    const Judged first = judge(f, setting, 3, {bestIsa(), Precision::scalar, false});
    for (const Isa isa : kIsas)
        for (const bool parallel : {false, true}) {
            if (!isaSupported(isa)) continue;
            const Judged found = judge(f, setting, 3, {isa, Precision::fast, parallel});
            EXPECT_EQ(found.overall, first.overall);
            EXPECT_EQ(found.frames, first.frames);
            EXPECT_TRUE(found.maps.back().samePixels(first.maps.back()));
        }
}
TEST(Cvvdp, AnySizeAndHostileValues) {
    for (const auto& [w, h] : {std::pair{1, 1}, {1, 40}, {3, 3}, {4, 4}, {7, 5}, {15, 15}, {520, 7}}) {
        const Judged found = judge({w, h, "grain", 30}, {.withMaps = true}, 3, {});
        for (const double v : found.overall) EXPECT_TRUE(std::isfinite(v)) << w << "x" << h;
    }
    Rgb bad = Formula{40, 30, "tint", 0}.frame(0, true);
    const Rgb good = bad;
    bad.c[0].at(5, 5) = NAN, bad.c[1].at(6, 6) = INFINITY, bad.c[2].at(7, 7) = -INFINITY, bad.c[0].at(8, 8) = 1e30f;
    for (const char* display : {"standard_4k", "standard_hdr_linear"}) {
        const double jod = cvvdpOfStill(bad, good, displayModelByName(display), {});
        EXPECT_TRUE(jod < 10 && jod > -100) << display << jod;
    }
}
// One reference serves many tests, and what one of them is told changes nothing for the others.
TEST(Cvvdp, TestsDoNotDisturbEachOther) {
    const Formula a{60, 40, "grain", 20}, b{60, 40, "flicker", 5};
    SequenceSetting setting{.width = 60, .height = 40};
    const auto reference = cvvdp(setting);
    const auto testA = reference->test(), testB = reference->test();
    for (int t = 0; t < 6; t++) {
        const Rgb r = a.frame(t, false);
        reference->add({r}, {});
        testA->add({a.frame(t, true)}, {});
        testB->add({b.frame(t, true)}, {});
    }
    EXPECT_EQ(testA->overall(), judge(a, {}, 6, {}).overall);
    EXPECT_EQ(testB->overall(), judge(b, {}, 6, {}).overall);
}
TEST(Cvvdp, ConstantsAgreeWithTheirFormulas) {
    using namespace cvvdp_constants;
    double sum = 0;
    for (int i = -kBlurReach; i <= kBlurReach; i++) sum += std::exp(-i * i / 18.0);
    for (int i = 0; i <= kBlurReach; i++) EXPECT_NEAR(kBlur[i], std::exp(-i * i / 18.0) / sum, 1e-15);
    for (int c = 0; c < kChannels; c++) EXPECT_NEAR(kEpsilonQ[c] / std::pow(kEpsilon, kMaskQ[c]), 1, 1e-9);
    EXPECT_NEAR(kEpsilonP / std::pow(kEpsilon, kMaskP), 1, 1e-9);
    EXPECT_NEAR(kEpsilonFourthRoot, std::pow(kEpsilon, 0.25), 1e-15);
    EXPECT_NEAR(kMaskGain, std::pow(10, -0.7954971194267273), 1e-15);
    EXPECT_NEAR(kMostDifference, std::pow(10, 2.5642454624176025), 1e-10);
    EXPECT_NEAR(kCsfFirstLog2, std::log2(kCsfLuminance[0]), 1e-14);
    EXPECT_NEAR(kCsfStepsPerLog2, (kCsfSize - 1) / std::log2(kCsfLuminance[1] / kCsfLuminance[0]), 1e-14);
    // Most sensitive, luminance of a monitor: to some cycles per degree; and less to high ones than the table's others.
    const auto& achromatic = kLogSensitivity[0][22];  // 148 cd/m2
    const auto peak = std::max_element(std::begin(achromatic), std::end(achromatic)) - std::begin(achromatic);
    const double peakFrequency = 0.1 * std::pow(640, double(peak) / 31);
    EXPECT_TRUE(peakFrequency > 1 && peakFrequency < 6) << peakFrequency;
}
TEST(DisplayModel, PixelsPerDegree) {
    // 30 inches along the diagonal of 3840 x 2160 px: a pixel of 0.173 mm, seen from 0.7472 m.
    const double pixel = 30 * 0.0254 / std::hypot(3840, 2160);
    EXPECT_NEAR(displayModelByName("standard_4k").pixelsPerDegree(),
                1 / (2 * std::atan(pixel / 2 / 0.7472) * 180 / std::numbers::pi), 1e-9);
    EXPECT_NEAR(displayModelByName("standard_4k").pixelsPerDegree(), 75.4, 0.05);
    EXPECT_NEAR(displayModelByName("standard_fhd").pixelsPerDegree(), 37.8, 0.1);
    EXPECT_NEAR(displayModelByName("standard_hmd").pixelsPerDegree(), 13.2, 0.1);
    EXPECT_THROW(displayModelByName("standard_8k"), UsageError);
}
}  // namespace
}  // namespace aa
