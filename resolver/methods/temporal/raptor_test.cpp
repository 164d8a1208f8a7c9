// The book's listings [Castorina 2023], evaluated directly in double, against what `raptor` does with the same options.
#include "methods/temporal/raptor.h"

#include <gtest/gtest.h>

#include <numbers>

#include "image/error.h"
#include "methods/method.h"
#include "methods/temporal/temporal_test_frames.h"

namespace aa {
namespace {
using namespace testing;

constexpr int kRaptorWidth = 29, kRaptorHeight = 17;
using Colour = std::array<double, 3>;
using Image = std::vector<Colour>;

template <class F>
Colour each(const F& f) {
    return {f(0u), f(1u), f(2u)};
}
double saturated(double x) { return std::min(std::max(x, 0.0), 1.0); }
double luma(const Colour& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }
double largest(const Colour& c) { return std::max({c[0], c[1], c[2]}); }
const Colour& at(const Image& image, int x, int y) {
    return image[size_t(std::clamp(y, 0, kRaptorHeight - 1) * kRaptorWidth + std::clamp(x, 0, kRaptorWidth - 1))];
}
Image imageOf(const Rgb& rgb) {
    Image image;
    for (int y = 0; y < kRaptorHeight; y++)
        for (int x = 0; x < kRaptorWidth; x++)
            image.push_back(each([&](size_t c) { return double(rgb.c[c].at(x, y)); }));
    return image;
}

// sample_history_color and sample_texture_catmull_rom at the continuous position (x, y).
Colour history(const Image& image, const Params& p, double x, double y) {
    const int ix = int(std::floor(x - 0.5)), iy = int(std::floor(y - 0.5));
    const double fx = x - 0.5 - ix, fy = y - 0.5 - iy;
    const auto weights = [&](double f) -> std::array<double, 4> {
        if (p.choice("history") == "bilinear") return {0, 1 - f, f, 0};
        return {-f / 2 + f * f - f * f * f / 2, 1 - 2.5 * f * f + 1.5 * f * f * f, f / 2 + 2 * f * f - 1.5 * f * f * f,
                -f * f / 2 + f * f * f / 2};
    };
    const auto wx = weights(fx), wy = weights(fy);
    Colour sum{};
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++)
            for (size_t c = 0; c < 3; c++)
                sum[c] += wx[size_t(i)] * wy[size_t(j)] * at(image, ix - 1 + i, iy - 1 + j)[c];
    return sum;
}
// subsample_filter, as printed: the argument is twice the distance of the pixels.
double subsampleFilter(const std::string& filter, double distance) {
    const double x = 2 * distance;
    const auto cubic = [&](double b, double c) {
        if (x < 1) return ((12 - 9 * b - 6 * c) * x * x * x + (-18 + 12 * b + 6 * c) * x * x + 6 - 2 * b) / 6;
        if (x < 2)
            return ((-b - 6 * c) * x * x * x + (6 * b + 30 * c) * x * x + (-12 * b - 48 * c) * x + 8 * b + 24 * c) / 6;
        return 0.0;
    };
    if (filter == "none") return distance;
    if (filter == "mitchell") return cubic(1.0 / 3, 1.0 / 3);
    if (filter == "catmullRom") return cubic(0, 0.5);
    const double t = std::numbers::pi * x;
    return 0.35875 + 0.48829 * std::cos(t) + 0.14128 * std::cos(2 * t) + 0.01168 * std::cos(3 * t);
}
// Toward the box's centre, with the code's 1e-8.
Colour clipAabb(const Colour& lo, const Colour& hi, const Colour& h) {
    const Colour centre = each([&](size_t c) { return 0.5 * (lo[c] + hi[c]); });
    const double unit =
        largest(each([&](size_t c) { return std::fabs((h[c] - centre[c]) / (0.5 * (hi[c] - lo[c]) + 1e-8)); }));
    return unit > 1 ? each([&](size_t c) { return centre[c] + (h[c] - centre[c]) / unit; }) : h;
}
Colour toYCoCg(const Colour& c) {
    return {c[0] / 4 + c[1] / 2 + c[2] / 4, c[0] / 2 - c[2] / 2, -c[0] / 4 + c[1] / 2 - c[2] / 4};
}
Colour toRgb(const Colour& c) { return {c[0] + c[1] - c[2], c[0] + c[2], c[0] - c[1] - c[2]}; }

// The printed TAA shader for one pixel; `now` and `past` in RGB.
Colour printedPixel(const Frame& f, const Image& now, const Image& past, const Params& p, int x, int y) {
    int closestX = x, closestY = y;
    if (p.choice("dilation") == "closest3x3")
        for (int i = -1; i <= 1; i++)
            for (int j = -1; j <= 1; j++) {
                const int nx = std::clamp(x + i, 0, kRaptorWidth - 1), ny = std::clamp(y + j, 0, kRaptorHeight - 1);
                if (f.depthView.at(nx, ny) < f.depthView.at(closestX, closestY)) closestX = nx, closestY = ny;
            }
    const double qx = x + 0.5 - double(f.motionXPx.at(closestX, closestY)),
                 qy = y + 0.5 - double(f.motionYPx.at(closestX, closestY));

    const bool ycocg = p.flag("ycocg");
    const auto space = [&](const Colour& c) { return ycocg ? toYCoCg(c) : c; };
    Colour total{}, m1{}, m2{}, lo{1e4, 1e4, 1e4}, hi{-1e4, -1e4, -1e4};
    double weightTotal = 0;
    for (int i = -1; i <= 1; i++)
        for (int j = -1; j <= 1; j++) {
            const Colour c = space(at(now, x + i, y + j));
            const double w = subsampleFilter(p.choice("currentFilter"), std::hypot(i, j));
            weightTotal += w;
            for (size_t k = 0; k < 3; k++) {
                total[k] += c[k] * w, m1[k] += c[k], m2[k] += c[k] * c[k];
                lo[k] = std::min(lo[k], c[k]), hi[k] = std::max(hi[k], c[k]);
            }
        }
    const Colour current = each([&](size_t c) { return total[c] / weightTotal; });
    // Radiance is never negative (conventions 8): the one place where the book's YCoCg, which prints no way back, is
    // ours.
    const auto result = [&](const Colour& c) {
        const Colour rgb = ycocg ? toRgb(c) : c;
        return each([&](size_t k) { return std::max(rgb[k], 0.0); });
    };
    if (!(qx >= 0 && qx <= kRaptorWidth && qy >= 0 && qy <= kRaptorHeight)) return result(current);
    if (ycocg)
        for (size_t k = 1; k < 3; k++) {
            const double chroma = 0.125 * (hi[0] - lo[0]);
            lo[k] = current[k] - chroma, hi[k] = current[k] + chroma;
        }

    Colour h = space(history(past, p, qx, qy));
    const Colour mu = each([&](size_t c) { return m1[c] / 9; }),
                 sigma = each([&](size_t c) { return std::sqrt(std::fabs(m2[c] / 9 - mu[c] * mu[c])); }),
                 low = each([&](size_t c) { return mu[c] - p.real("gamma") * sigma[c]; }),
                 high = each([&](size_t c) { return mu[c] + p.real("gamma") * sigma[c]; });
    const std::string& constraint = p.choice("constraint");
    if (constraint == "clamp" || constraint == "varianceClipClamp")
        h = each([&](size_t c) { return std::min(std::max(h[c], lo[c]), hi[c]); });
    if (constraint == "clip") h = clipAabb(lo, hi, h);
    if (constraint == "varianceClip" || constraint == "varianceClipClamp") h = clipAabb(low, high, h);

    Colour currentWeight{0.1, 0.1, 0.1}, historyWeight{0.9, 0.9, 0.9};
    const bool difference = p.choice("lumaDiff") == "printed";
    if (p.flag("temporalFiltering"))
        for (size_t c = 0; c < 3; c++) {
            const double t = saturated(std::fabs(hi[c] - lo[c]) / current[c]);
            historyWeight[c] = saturated(0.25 + (0.85 - 0.25) * t), currentWeight[c] = 1 - historyWeight[c];
        }
    if (p.flag("inverseLuminance") || difference) {
        const auto compressed = [&](const Colour& c) {
            return each([&](size_t k) { return c[k] / (largest(c) + 1); });
        };
        const double lumaCurrent = ycocg ? compressed(current)[0] : luma(compressed(current)),
                     lumaHistory = ycocg ? compressed(h)[0] : luma(compressed(h));
        if (difference) {
            const double d = std::fabs(lumaCurrent - lumaHistory) / std::max({lumaCurrent, lumaHistory, 0.2}),
                         k = (1 - d) * (1 - d);
            historyWeight = {1 - k, 1 - k, 1 - k}, currentWeight = {k, k, k};
        }
        for (size_t c = 0; c < 3; c++) currentWeight[c] /= 1 + lumaCurrent, historyWeight[c] /= 1 + lumaHistory;
    }
    return result(each([&](size_t c) {
        return (current[c] * currentWeight[c] + h[c] * historyWeight[c]) /
               std::max(currentWeight[c] + historyWeight[c], 0.00001);
    }));
}
Image sharpened(const Image& image, double amount) {
    Image out = image;
    for (int y = 0; y < kRaptorHeight; y++)
        for (int x = 0; x < kRaptorWidth; x++) {
            double average = 0;
            for (int i = -1; i <= 1; i++)
                for (int j = -1; j <= 1; j++) average += luma(at(image, x + i, y + j)) / 9;
            const double own = luma(at(image, x, y)), final = std::max(own + (own - average) * amount, 0.0);
            for (double& c : out[size_t(y * kRaptorWidth + x)]) c *= final / own;
        }
    return out;
}

// Random colours in (0, 1), depths and motions up to 2.5 px.
Frame randomFrame(int n, glm::dvec2 jitterPx) {
    const Picture colours = noisePicture(unsigned(20 + n)), depths = noisePicture(unsigned(40 + n));
    Frame f = temporalFrame(n, kRaptorWidth, kRaptorHeight,
                            [&](int x, int y, int c) { return 0.02f + 0.9f * colours(x, y, c); });
    f.jitterPx = jitterPx;
    for (int y = 0; y < kRaptorHeight; y++)
        for (int x = 0; x < kRaptorWidth; x++) {
            f.depthView.at(x, y) = 1 + 9 * depths(x, y, 0);
            f.motionXPx.at(x, y) = 5 * depths(x, y, 1) - 2.5f;
            f.motionYPx.at(x, y) = 5 * depths(x, y, 2) - 2.5f;
        }
    f.depthView.fillBorder(), f.motionXPx.fillBorder(), f.motionYPx.fillBorder();
    return f;
}
// Largest difference between `options` of raptor and the listings with the options `printed`.
double differenceFromBook(const std::string& options, const std::string& printed) {
    const Params p = parseMethod("raptor:" + printed).params();
    RunningMethod m = running("raptor:" + options, kRaptorWidth, kRaptorHeight);
    const Frame first = randomFrame(0, {}), second = randomFrame(1, {0.3, -0.2});
    m.resolve(first, {}, {});
    m.resolve(second, {}, {});
    const Image now = imageOf(second.colorLinear), past = imageOf(first.colorLinear);
    Image expected;
    for (int y = 0; y < kRaptorHeight; y++)
        for (int x = 0; x < kRaptorWidth; x++) expected.push_back(printedPixel(second, now, past, p, x, y));
    if (p.real("sharpen") > 0) expected = sharpened(expected, p.real("sharpen"));
    double most = 0;
    const Image found = imageOf(m.out);
    for (size_t i = 0; i < found.size(); i++)
        for (size_t c = 0; c < 3; c++) most = std::max(most, std::fabs(found[i][c] - expected[i][c]));
    return most;
}

// The whole shader, and each of its steps alone or exchanged, with everything else as printed.
TEST(Raptor, PublishedStepsOfTheBook) {
    const std::string whole = "filterDomain=printed,historyClamp=off,lumaDiff=printed";
    const std::string base = "filterDomain=printed,lumaDiff=off,sharpen=0,";
    const std::string plain = base + "temporalFiltering=off,inverseLuminance=off,";
    const std::vector<std::string> settings = {
        whole, whole + ",sharpen=0.1", whole + ",sharpen=0", whole + ",dilation=none", whole + ",ycocg=on",
        "filterDomain=printed,history=bilinear,lumaDiff=printed",
        // resolve: fixed weights, temporal filter, inverse luminance, both
        plain + "historyClamp=off", base + "historyClamp=off,inverseLuminance=off,contrastDivisor=printed",
        base + "historyClamp=off,temporalFiltering=off", base + "historyClamp=off,contrastDivisor=printed",
        base + "historyClamp=off,contrastDivisor=printed,ycocg=on",
        // constraints
        plain + "history=bilinear,constraint=none", plain + "historyClamp=off,constraint=clamp",
        plain + "historyClamp=off,constraint=clip", plain + "historyClamp=off,constraint=varianceClip",
        plain + "historyClamp=off,constraint=varianceClipClamp,gamma=0.75",
        plain + "historyClamp=off,constraint=clip,ycocg=on",
        // scene sampling
        plain + "historyClamp=off,currentFilter=none", plain + "historyClamp=off,currentFilter=catmullRom",
        plain + "historyClamp=off,currentFilter=blackmanHarris"};
    for (const std::string& options : settings) EXPECT_LT(differenceFromBook(options, options), 2e-5) << options;
}
// The reference can tell our guards from the printed steps, and the printed form from the corrected one.
TEST(Raptor, OwnGuardsDifferFromThePrintedSteps) {
    const std::string plain =
        "filterDomain=printed,lumaDiff=off,sharpen=0,temporalFiltering=off,inverseLuminance=off,constraint=none";
    EXPECT_GT(differenceFromBook(plain, plain + ",historyClamp=off"), 1e-2);
    const std::string contrast = "filterDomain=printed,lumaDiff=off,sharpen=0,ycocg=on,historyClamp=off";
    EXPECT_GT(differenceFromBook(contrast, contrast + ",contrastDivisor=printed"), 1e-2);
    const std::string whole = "filterDomain=printed,historyClamp=off,sharpen=0,lumaDiff=printed";
    EXPECT_GT(differenceFromBook(whole + ",lumaDiffWeights=off", whole), 1e-2);
    EXPECT_GT(differenceFromBook("filterDomain=printed,historyClamp=off,sharpen=0", whole), 1e-2);
}
// The filtered colour of negative lobes: held within the window, or not.
TEST(Raptor, CurrentClampHoldsTheFiltersOvershoot) {
    const auto overshoot = [](const std::string& options) {
        RunningMethod m = running(
            "raptor:constraint=none,lumaDiff=off,temporalFiltering=off,inverseLuminance=off,"
            "sharpen=0,currentFilter=catmullRom" +
                options,
            9, 9);
        for (int n = 0; n < 2; n++) {  // history outside: the filtered colour itself
            Frame f =
                temporalFrame(n, 9, 9, [](int x, int y, int) { return x == 4 && y == 4 ? 1.0f : 0.5f; }, {100, 0});
            m.resolve(f, {}, {});
        }
        float least = 1;
        for (int y = 0; y < 9; y++)
            for (int x = 0; x < 9; x++) least = std::min(least, m.out.c[0].at(x, y));
        return 0.5f - least;
    };
    EXPECT_LE(overshoot(""), 1e-6f);
    EXPECT_GT(overshoot(",currentClamp=off"), 0.01f);
}

TEST(Raptor, OptionsWithoutEffectAreRefused) {
    for (const char* text :
         {"raptor:temporalFiltering=off", "raptor:inverseLuminance=off", "raptor:contrastDivisor=printed",
          "raptor:lumaDiff=off,temporalFiltering=off,contrastDivisor=printed",  // a condition's own condition
          "raptor:lumaDiff=off,lumaDiffWeights=off", "raptor:filterDomain=printed,currentClamp=off",
          "raptor:history=bilinear,historyClamp=off", "taaSimplest:historyClamp=off", "salvi:neighbourhood=plus",
          "falcor:neighbourhood=3x3", "donut:neighbourhood=3x3"})
        EXPECT_THROW(parseMethod(text), UsageError) << text;
    for (const char* text : {"raptor:lumaDiff=off,contrastDivisor=printed", "salvi:box=intersection,neighbourhood=plus",
                             "karis:neighbourhood=plus", "taaSimplest:history=catmullRom5,historyClamp=off"})
        EXPECT_NO_THROW(parseMethod(text)) << text;
}

}  // namespace
}  // namespace aa
