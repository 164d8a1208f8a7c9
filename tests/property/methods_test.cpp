// Properties that every registered method must have, at its defaults and with every choice of its parameters.
#include <gtest/gtest.h>

#include "frames.h"
#include "methods/method.h"
#include "methods/methods_under_test.h"

namespace aa::testing {
namespace {

class EveryMethod : public ::testing::TestWithParam<std::string> {};

bool allFinite(const Rgb& image) {
    for (const auto& p : image.c)
        for (int y = 0; y < p.height(); y++)
            for (int x = 0; x < p.width(); x++)
                if (!std::isfinite(p.at(x, y))) return false;
    return true;
}
const MethodDescriptor& method(const std::string& text) { return *specUnderTest(text).method; }

TEST_P(EveryMethod, ConstantStaysConstant) {
    // Codes lie beside the constant, and chance sets neighbours apart: a clip to a flat box leaves of that what it
    // tolerates (1e-6), and sharpening multiplies it.
    const auto has = [](const char* words) { return GetParam().find(words) != std::string::npos; };
    const float tolerance = has("dither=on") ? 1e-5f : has("historyBits=8") ? 5e-6f : 2e-6f;
    for (const float v : {0.0f, 0.25f, 1.0f}) {
        Subject s = makeSubject(GetParam(), 40, 24);
        for (int n = 1; n <= 4; n++) {
            const Rgb out = step(
                s, renderFrame(constantScene({v, v * 0.5f, v * 0.25f}), 40, 24, n, halton(n), {0.3, -0.6}, s.samples));
            Rgb expected(40, 24);
            for (size_t c = 0; c < 3; c++) expected.c[c] = PlaneF(40, 24, v * (c == 0 ? 1.0f : c == 1 ? 0.5f : 0.25f));
            if (specUnderTest(GetParam()).outputSpace() == Space::encoded) {
                const Rgb linear = expected;
                encode(linear, {}, {}, expected);
            }
            for (size_t c = 0; c < 3; c++)
                for (int y = 0; y < 24; y++)
                    for (int x = 0; x < 40; x++)
                        ASSERT_NEAR(out.c[c].at(x, y), expected.c[c].at(x, y), tolerance) << n << " " << x << "," << y;
        }
    }
}

// Un-jitter (conventions 7.0) in every method that offers it: a picture that rises evenly is shown where it is, in
// every frame, whatever its jitter. The other sign, or none, would miss by up to 0.006.
TEST(Unjitter, ARestingRampIsShownWhereItIs) {
    const int w = 40, h = 24;
    const Scene ramp = [](double x, double y) -> Surface {
        return {glm::vec3(float(0.2 + 0.006 * x + 0.004 * y)), 5.0f, {0, 0, 1}, 1};
    };
    size_t count = 0;
    for (const auto& m : methodsUnderTest()) {
        const auto has = [&](std::string_view name) {
            return std::any_of(m.params.begin(), m.params.end(), [&](const auto& p) { return p.name == name; });
        };
        if (!m.temporal) continue;
        ASSERT_TRUE(has("unjitter") || has("unjitterColor") || m.id == "accum")
            << m.writtenAt.text() << ": temporal, but without temporal::unjitterParam() in .params";
        if (!has("unjitter")) continue;
        count++;
        std::string text = std::string(m.id) + ":unjitter=on";
        for (const auto& p : m.params)
            if (p.name == "sharpen") text += p.type == ParamSpec::Type::choice ? ",sharpen=none" : ",sharpen=0";
        Subject s = makeSubject(text, w, h);
        // Four buffers at places of their own: asaa is centred once all of them are filled.
        const int settled = m.id == "asaa" ? 10 : 1;
        for (int n = 1; n <= 16; n++) {
            Frame f = renderFrame(ramp, w, h, n, halton(n), {0, 0}, s.samples);
            const DisplayChain identity{.transfer = Transfer::identity};
            encodeFrame(f, identity, {});
            s.running.resolve(f, f.display, {});
            for (int y = 5; y < h - 5 && n >= settled; y++)
                for (int x = 5; x < w - 5; x++)
                    ASSERT_NEAR(s.running.out.c[1].at(x, y), ramp(x + 0.5, y + 0.5).color[1], 3e-4)
                        << text << " frame " << n << " at " << x << "," << y;
        }
    }
    EXPECT_GE(count, 15u);
}

// With the identity transfer linear and displayed are one: a method that encodes or decodes by itself, whatever the
// frame's chain says, shows another constant. Exposure is applied once, before.
TEST_P(EveryMethod, DisplayedValuesAreOneSpace) {
    const float tolerance = GetParam().find("dither=on") != std::string::npos ? 1e-5f : 2e-6f;
    Subject s = makeSubject(GetParam(), 40, 24);
    for (int n = 1; n <= 3; n++) {
        Frame f = renderFrame(constantScene({0.125f, 0.25f, 0.0625f}), 40, 24, n, halton(n), {0.3, -0.6}, s.samples);
        encodeFrame(f, {.exposure = 1, .transfer = Transfer::identity}, {});
        s.running.resolve(f, f.display, {});
        for (size_t c = 0; c < 3; c++)
            for (int y = 0; y < 24; y++)
                for (int x = 0; x < 40; x++)
                    ASSERT_NEAR(s.running.shown().c[c].at(x, y),
                                c == 0   ? 0.25f
                                : c == 1 ? 0.5f
                                         : 0.125f,
                                tolerance)
                        << n << " " << x << "," << y;
    }
}

TEST_P(EveryMethod, AnySizeWorksAndFiniteInGivesFiniteOut) {
    const std::pair<int, int> sizes[] = {{1, 1}, {1, 7}, {7, 1}, {2, 2}, {3, 3}, {17, 5}, {33, 19}};
    const double motions[] = {0.0, 0.37, -1e30, 17.0};
    for (const auto& [w, h] : sizes) {
        Subject s = makeSubject(GetParam(), w, h);
        for (int n = 1; n <= 6; n++) {
            Frame f =
                renderFrame(noise(unsigned(n)), w, h, n, halton(n), {motions[n % 4], motions[(n / 2) % 4]}, s.samples);
            if (n == 3) f.colorLinear.c[0].at(w / 2, h / 2) = 1e6f;  // firefly
            if (n == 4) f.colorLinear.c[1].at(0, 0) = 1e-42f;        // denormal
            if (n == 5) f.motionXPx.at(0, 0) = NAN;                  // invalid motion rejects history
            f.colorLinear.fillBorder();
            f.motionXPx.fillBorder();
            ASSERT_TRUE(allFinite(step(s, f))) << w << "x" << h << " frame " << n;
        }
    }
}

// A picture's memory comes as it was left. The width is a whole number of lanes: nothing is written beyond it.
TEST_P(EveryMethod, WhatThePictureHeldBeforeIsNowhereInIt) {
    const int w = 64, h = 20;
    Subject clean = makeSubject(GetParam(), w, h), used = makeSubject(GetParam(), w, h);
    for (int n = 1; n <= 3; n++) {
        const Frame f =
            renderFrame(n == 2 ? noise(7) : shapes({0.7 * n, 0}), w, h, n, halton(n), {0.7, 0}, clean.samples);
        clean.running.out = Rgb(w, h), used.running.out = Rgb(w, h, NAN);
        ASSERT_TRUE(step(used, f).samePixels(step(clean, f))) << "frame " << n;
    }
}

TEST_P(EveryMethod, SameBitsForThreadsInstructionSetsAndScalar) {
    Subject reference = makeSubject(GetParam(), 67, 43);
    std::vector<Rgb> expected;
    std::vector<Frame> frames;
    for (int n = 1; n <= 4; n++) {
        frames.push_back(renderFrame(n == 3 ? noise(5) : shapes({1.3 * n, 0.4 * n}), 67, 43, n, halton(n), {1.3, 0.4},
                                     reference.samples));
        expected.push_back(step(reference, frames.back(), {.precision = Precision::scalar, .parallel = false}));
    }
    for (const Isa isa : kIsas) {
        if (!isaSupported(isa)) continue;
        for (const Precision precision : {Precision::fast, Precision::scalar})
            for (const bool parallel : {false, true}) {
                Subject s = makeSubject(GetParam(), 67, 43);
                for (size_t n = 0; n < frames.size(); n++)
                    ASSERT_TRUE(step(s, frames[n], {.isa = isa, .precision = precision, .parallel = parallel})
                                    .samePixels(expected[n]))
                        << name(isa) << (precision == Precision::fast ? " lanes" : " scalar")
                        << (parallel ? " parallel" : "") << " frame " << n + 1;
            }
    }
}

// The double form may decide an exact tie otherwise, so a small share of pixels may differ more.
TEST_P(EveryMethod, LanesAgreeWithDouble) {
    Subject lanes = makeSubject(GetParam(), 67, 43), oracle = makeSubject(GetParam(), 67, 43);
    Exec exact;
    exact.precision = Precision::oracle;
    size_t far = 0, all = 0;
    for (int n = 1; n <= 3; n++) {
        const Frame f = renderFrame(shapes({1.3 * n, 0.4 * n}), 67, 43, n, halton(n), {1.3, 0.4}, lanes.samples);
        const Rgb a = step(lanes, f);
        const Rgb b = step(oracle, f, exact);
        for (size_t c = 0; c < 3; c++)
            for (int y = 0; y < 43; y++)
                for (int x = 0; x < 67; x++, all++) far += !(std::fabs(a.c[c].at(x, y) - b.c[c].at(x, y)) <= 3e-5f);
    }
    EXPECT_LE(double(far), 0.002 * double(all));
}

// conventions 12: a blend stays within what it blends; a checkerboard, noise, lone bright and dark pixels. Filters with
// negative lobes and sharpening may leave it.
TEST_P(EveryMethod, BlendsStayWithinTheirInput) {
    const MethodSpec spec = specUnderTest(GetParam());
    if (spec.method->temporal) GTEST_SKIP() << "the torture set of the temporal methods bounds them";
    for (const char* overshooting : {"mitchell", "catmullRom", "cubic", "sinc", "lanczos"})
        if (GetParam().find(overshooting) != std::string::npos) GTEST_SKIP() << "negative lobes";
    const auto flat = [](double v) { return Surface{glm::vec3(float(v)), 5.0f, {0, 0, 1}, 1 + uint32_t(v * 8)}; };
    const Scene checker = [&](double x, double y) {
        return flat((int(std::floor(x)) + int(std::floor(y))) % 2 ? 0.875 : 0.25);
    };
    const Scene points = [&](double x, double y) {
        const int i = int(std::floor(x)) % 7, j = int(std::floor(y)) % 5;
        return flat(i == 3 && j == 2 ? 0.875 : i == 5 && j == 4 ? 0.25 : 0.5);
    };
    const Scene noisy = [&](double x, double y) { return flat(0.25 + 0.625 * double(noise(3)(x, y).color.x)); };
    for (const Scene& scene : {checker, points, noisy}) {
        Subject s = makeSubject(GetParam(), 40, 24);
        const Rgb out = step(s, renderFrame(scene, 40, 24, 1, {0, 0}, {0, 0}, s.samples));
        float least = 0.25f, most = 0.875f;
        if (spec.outputSpace() == Space::encoded) {
            Rgb encoded;
            encode(Rgb(2, 1, least), {}, {}, encoded), least = encoded.c[0].at(0, 0);
            encode(Rgb(2, 1, most), {}, {}, encoded), most = encoded.c[0].at(0, 0);
        }
        for (const auto& p : out.c)
            for (int y = 0; y < 24; y++)
                for (int x = 0; x < 40; x++) {
                    ASSERT_GE(p.at(x, y), least - 1e-6f) << x << "," << y;
                    ASSERT_LE(p.at(x, y), most + 1e-6f) << x << "," << y;
                }
    }
}

TEST_P(EveryMethod, ResetForgetsTheHistory) {
    Subject used = makeSubject(GetParam(), 48, 30), fresh = makeSubject(GetParam(), 48, 30);
    for (int n = 1; n <= 3; n++)
        step(used, renderFrame(noise(unsigned(n)), 48, 30, n, halton(n), {0.5, 0.5}, used.samples));
    const Frame first = renderFrame(shapes(), 48, 30, 1, {0, 0}, {0, 0}, used.samples);
    const Rgb a = step(used, first);
    EXPECT_TRUE(a.samePixels(step(fresh, first)));
}

TEST_P(EveryMethod, NanDoesNotOutliveItsFrame) {
    Subject s = makeSubject(GetParam(), 32, 20);
    if (method(GetParam()).id == "accum")
        GTEST_SKIP() << "a sum holds what it was given; the reader's sanitiser stands before it";
    for (int n = 1; n <= 4; n++) {
        Frame f = renderFrame(shapes(), 32, 20, n, halton(n), {0, 0}, s.samples);
        if (n == 2) {
            f.colorLinear.c[1].at(15, 9) = NAN;
            f.colorLinear.c[0].at(3, 3) = INFINITY;
            f.colorLinear.fillBorder();
        }
        const Rgb out = step(s, f);
        if (n == 2) continue;
        ASSERT_TRUE(allFinite(out)) << "frame " << n;
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, EveryMethod, ::testing::ValuesIn(allSpecs()), [](const auto& info) {
    std::string s = info.param;
    for (char& c : s)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    return s;
});

}  // namespace
}  // namespace aa::testing
