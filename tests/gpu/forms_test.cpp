// Every method's shaders against its kernels, at its defaults and with every choice of its parameters: ordinary
// pictures, sizes down to one pixel, and the torture set (conventions 12). Vulkan's validation layer is on where it is
// installed.
#include <gtest/gtest.h>

#include <set>

#include "../property/frames.h"
#include "gpu/method.h"

namespace aa::testing {
namespace {

// Methods that run on the processor alone.
const std::set<std::string_view> kWithoutShader = {};
TEST(FormsOf, EveryMethod) {
    for (const auto& m : registry())
        EXPECT_NE(gpu::hasForm(m.id), kWithoutShader.contains(m.id))
            << m.id << ": give it a form (resolver/gpu/forms/, CONTRIBUTING.md), or name it in kWithoutShader here";
}

// One device for all tests: null where there is none.
gpu::Session* session() {
    static const auto made = []() -> std::unique_ptr<gpu::Session> {
        try {
            return std::make_unique<gpu::Session>(gpu::Settings{.device = "vulkan", .validate = true});
        } catch (const gpu::DeviceError&) {
        }
        try {  // without the layer
            return std::make_unique<gpu::Session>(gpu::Settings{.device = "vulkan"});
        } catch (const gpu::DeviceError&) {
            return {};
        }
    }();
    return made.get();
}

// The two forms of one method, fed with the same frames.
struct Pair {
    Subject kernels;
    RunningMethod shaders;
};
Pair makePair(const std::string& text, int w, int h) {
    Subject kernels = makeSubject(text, w, h, registry());
    const ShotInfo info{.width = w,
                        .height = h,
                        .jitterPeriod = 16,
                        .isStatic = true,
                        .frameCount = 16,
                        .subSamplePositionsPx = pattern(kernels.samples)};
    const MethodSpec spec = kernels.running.spec;
    return {std::move(kernels), RunningMethod(spec, gpu::create(*session(), spec, info))};
}
struct Difference {
    double most = 0, share = 0;  // by max(1, |kernel's|); share of pixels above 1/255
    bool finite = true;
    int x = 0, y = 0;
};
Difference stepBoth(Pair& p, Frame f) {
    encodeFrame(f, {}, {});
    p.kernels.running.resolve(f, {}, {});
    p.shaders.resolve(f, {}, {});
    Difference d;
    size_t above = 0;
    for (int y = 0; y < f.height; y++)
        for (int x = 0; x < f.width; x++) {
            double here = 0;
            for (size_t c = 0; c < 3; c++) {
                const double e = double(p.kernels.running.out.c[c].at(x, y)), g = double(p.shaders.out.c[c].at(x, y));
                if (!std::isfinite(g)) d.finite = false;
                here = std::max(here, std::abs(e - g) / std::max(1.0, std::abs(e)));
            }
            if (here > d.most) d.most = here, d.x = x, d.y = y;
            above += here > 1.0 / 255;
        }
    d.share = double(above) / (double(f.width) * f.height);
    return d;
}

class Forms : public ::testing::TestWithParam<std::string> {
  protected:
    void SetUp() override {
        if (!session()) GTEST_SKIP() << "no Vulkan device here";
        if (!gpu::hasForm(method().id)) GTEST_SKIP() << "no shader";
    }
    const MethodDescriptor& method() const { return *parseMethod(GetParam()).method; }
    // Of ordinary pictures over a few frames. Narrow histories round where the last digit differs: half a step.
    double tolerance() const {
        const auto has = [&](const char* words) { return GetParam().find(words) != std::string::npos; };
        if (has("historyBits=8")) return 1.5 / 255;
        if (has("historyBits=16f") || has("dither=on")) return 2e-3;
        return 3e-5;
    }
};

// One pair for all sizes: making a pipeline costs more than running it.
TEST_P(Forms, ShadersAgreeWithKernels) {
    Pair p = makePair(GetParam(), 67, 43);
    for (int n = 1; n <= 6; n++) {
        const Difference d = stepBoth(p, renderFrame(n == 4 ? noise(5) : shapes({1.3 * n, 0.4 * n}), 67, 43, n,
                                                     halton(n), {1.3, 0.4}, p.kernels.samples));
        EXPECT_TRUE(d.finite) << "frame " << n;
        // A search may end elsewhere at an exact tie.
        if (method().family == "spatial")
            EXPECT_LE(d.share, 2e-4) << "frame " << n << " (" << d.x << ", " << d.y << ") " << d.most;
        else
            EXPECT_LE(d.most, tolerance()) << "frame " << n << " (" << d.x << ", " << d.y << ")";
    }
    for (const auto& [w, h] : {std::pair(1, 1), {1, 7}, {7, 1}, {3, 3}, {17, 5}})
        for (int n = 1; n <= 3; n++) {  // frame 1 drops the history
            const Difference d =
                stepBoth(p, renderFrame(noise(unsigned(n)), w, h, n, halton(n), {0.37, -0.6}, p.kernels.samples));
            EXPECT_TRUE(d.finite) << w << "x" << h << " frame " << n;
            EXPECT_LE(d.most, std::max(tolerance(), 1e-4)) << w << "x" << h << " frame " << n;
        }
}
INSTANTIATE_TEST_SUITE_P(Methods, Forms, ::testing::ValuesIn([] {
                             std::vector<std::string> specs;
                             for (const auto& text : allSpecs())
                                 if (text.find("keleton") == std::string::npos) specs.push_back(text);
                             return specs;
                         }()),
                         [](const auto& info) {
                             std::string name;
                             for (const char c : info.param)
                                 name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
                             return name + "_" + std::to_string(info.index);
                         });

// ---- torture --------------------------------------------------------------------------------------------------------
class Torture : public Forms {};

constexpr int kW = 21, kH = 13;
Frame painted(Pair& p, int n, const std::function<float(int x, int y, int c)>& colour, glm::dvec2 motionPx) {
    Frame f = renderFrame(constantScene({0.5f, 0.5f, 0.5f}), kW, kH, n, halton(n), motionPx, p.kernels.samples);
    const auto paint = [&](Rgb& image) {
        for (size_t c = 0; c < 3; c++)
            for (int y = 0; y < kH; y++)
                for (int x = 0; x < kW; x++) image.c[c].at(x, y) = colour(x, y, int(c));
        image.fillBorder();
    };
    paint(f.colorLinear), paint(f.albedoLinear);
    for (auto& s : f.subSamples) paint(s.colorLinear);
    return f;
}
float uniform(int x, int y, int c) { return SplitMix64(uint64_t(x + 64 * y + 4096 * c)).uniform(); }

TEST_P(Torture, Constants) {  // T1 to T3
    for (const float v : {0.0f, 0.5f, method().id == "donut" ? 1e4f : 1e6f}) {
        Pair p = makePair(GetParam(), kW, kH);
        for (int n = 1; n <= 6; n++) {
            const Difference d = stepBoth(p, painted(p, n, [&](int, int, int) { return v; }, {0.3, -0.4}));
            ASSERT_TRUE(d.finite) << v;
            ASSERT_LE(d.most, 3e-5) << v << " frame " << n;
        }
    }
}
TEST_P(Torture, ExtremeColours) {  // T4, T5, T7, T8, T13
    const std::function<float(int, int, int)> pictures[] = {
        [](int x, int y, int) { return float((x + y) % 2); },
        [](int x, int y, int) { return x == 9 && y == 6 ? 1e6f : 0.0f; },
        [](int x, int y, int c) { return 1e-42f * float(x + 30 * y + c); },
        [](int x, int y, int c) { return float(std::pow(10.0, 12 * double(uniform(x, y, c)) - 6)); },
        [](int x, int y, int c) { return 65504.0f + 1000.0f * float((x + y + c) % 3); },
    };
    for (const auto& picture : pictures) {
        Pair p = makePair(GetParam(), kW, kH);
        for (int n = 1; n <= 6; n++) {
            const Difference d = stepBoth(p, painted(p, n, picture, {0.7 * (n % 2), -0.45}));
            ASSERT_TRUE(d.finite) << "picture " << &picture - pictures << " frame " << n;
        }
    }
}
TEST_P(Torture, BrokenPixels) {  // T6: what the reader would have replaced
    Pair p = makePair(GetParam(), kW, kH);
    for (int n = 1; n <= 8; n++) {
        Frame f = painted(p, n, uniform, {0.4, 0.2});
        if (n <= 3)
            for (Rgb* image : {&f.colorLinear, &f.albedoLinear}) {
                image->c[0].at(5, 5) = NAN, image->c[1].at(9, 4) = INFINITY, image->c[2].at(12, 7) = -1;
                image->fillBorder();
            }
        const Difference d = stepBoth(p, f);
        // A sum holds what it was given.
        if (n > 3 && method().temporal && method().id != "accum") {
            ASSERT_TRUE(d.finite) << "frame " << n;
        }
    }
}
TEST_P(Torture, ExtremeDepthAndMotion) {  // T9 to T11, T15
    for (int kind = 0; kind < 6; kind++) {
        Pair p = makePair(GetParam(), kW, kH);
        for (int n = 1; n <= 5; n++) {
            const glm::dvec2 motion = kind == 2   ? glm::dvec2(double(NAN), 0)
                                      : kind == 3 ? glm::dvec2(n % 2 ? 1e30 : -1e30, 1e30)
                                      : kind == 4 ? glm::dvec2(kW, -kH)
                                      : kind == 5 ? glm::dvec2(2, -1)
                                                  : glm::dvec2(0.4, 0.4);
            Frame f = painted(p, n, uniform, motion);
            for (int y = 0; y < kH; y++)
                for (int x = 0; x < kW; x++) {
                    const float z = kind == 0 ? kBackgroundDepth : (x + y + n) % 2 ? 5.0f : kBackgroundDepth;
                    f.depthView.at(x, y) = z;
                    f.objectId.at(x, y) = z < 1e9f;
                }
            f.depthView.fillBorder(), f.objectId.fillBorder();
            for (auto& s : f.subSamples) s.depthView = f.depthView, s.objectId = f.objectId;
            const Difference d = stepBoth(p, f);
            ASSERT_TRUE(d.finite) << "kind " << kind << " frame " << n;
            if (method().family != "spatial") {
                ASSERT_LE(d.most, 1e-4) << "kind " << kind << " frame " << n;
            }
        }
    }
}
TEST_P(Torture, ManyStillFrames) {  // T14: no drift apart
    if (!method().temporal) GTEST_SKIP();
    Pair p = makePair(GetParam(), kW, kH);
    for (int n = 1; n <= 200; n++) {
        Frame f = painted(p, n, uniform, {0, 0});
        f.jitterPx = halton(n % 16 + 1);
        const Difference d = stepBoth(p, f);
        ASSERT_LE(d.most, 3e-5) << "frame " << n;
    }
}
TEST_P(Torture, FastStaysFinite) {
    static const auto fast = [] {
        return session() ? std::make_unique<gpu::Session>(
                               gpu::Settings{.device = "vulkan", .precision = gpu::Precision::fast})
                         : nullptr;
    }();
    Subject subject = makeSubject(GetParam(), kW, kH, registry());
    const MethodSpec spec = subject.running.spec;
    RunningMethod shaders(spec, gpu::create(*fast, spec,
                                            {.width = kW,
                                             .height = kH,
                                             .jitterPeriod = 16,
                                             .isStatic = true,
                                             .frameCount = 16,
                                             .subSamplePositionsPx = pattern(subject.samples)}));
    Pair p{std::move(subject), std::move(shaders)};
    for (int n = 1; n <= 4; n++) {
        const Difference d = stepBoth(
            p, painted(p, n, [&](int x, int y, int c) { return n == 3 ? 1e6f * uniform(x, y, c) : uniform(x, y, c); },
                       {0.4, -0.3}));
        ASSERT_TRUE(d.finite) << "frame " << n;
    }
}
INSTANTIATE_TEST_SUITE_P(Methods, Torture, ::testing::ValuesIn([] {
                             std::vector<std::string> ids;
                             for (const auto& m : registry()) ids.emplace_back(m.id);
                             return ids;
                         }()),
                         [](const auto& info) { return info.param; });

TEST(Large, EightK) {
    if (!session()) GTEST_SKIP() << "no Vulkan device here";
    constexpr int w = 7680, h = 4320;
    Frame f;
    f.width = w, f.height = h, f.reset = true;
    f.colorLinear = Rgb(w, h);
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++) f.colorLinear.c[c].at(x, y) = float((x / 64 + y / 64 + int(c)) % 2);
    f.colorLinear.fillBorder();
    const MethodSpec spec = parseMethod("noaa");
    RunningMethod noaa(spec, gpu::create(*session(), spec, {.width = w, .height = h}));
    noaa.resolve(f, {}, {});
    EXPECT_TRUE(noaa.out.samePixels(f.colorLinear));
}

}  // namespace
}  // namespace aa::testing
