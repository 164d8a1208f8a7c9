// Un-jitter of the current frame (conventions 7.0): what it means (a scene, sampled at p + jitter, is shown at p), its
// signs, its edges, and the two methods of [Oliveros 2018] that need it, against a direct evaluation in double.
#include <gtest/gtest.h>

#include "methods/temporal/temporal.h"
#include "methods/temporal/temporal_test_frames.h"
#include "shot/jitter.h"

namespace aa {
namespace {
using namespace testing;
using glm::dvec2;
using Scene = std::function<double(dvec2)>;  // of a position in px

// Each texel holds the scene at its centre + jitter.
Frame sampled(int number, int w, int h, const Scene& scene, dvec2 jitterPx) {
    Frame f = temporalFrame(number, w, h,
                            [&](int x, int y, int) { return float(scene(dvec2(x + 0.5, y + 0.5) + jitterPx)); });
    f.jitterPx = jitterPx;
    return f;
}
double clampedAt(const PlaneF& p, int x, int y) { return double(p.clamped(x, y)); }
// Bilinear at (x + 0.5, y + 0.5) - jitter, each tap held to the picture.
template <class At>
double fetched(const At& at, int x, int y, dvec2 jitterPx) {
    const double px = x - jitterPx.x, py = y - jitterPx.y;
    const int ix = int(std::floor(px)), iy = int(std::floor(py));
    const double fx = px - ix, fy = py - iy;
    return (at(ix, iy) * (1 - fx) + at(ix + 1, iy) * fx) * (1 - fy) +
           (at(ix, iy + 1) * (1 - fx) + at(ix + 1, iy + 1) * fx) * fy;
}
Rgb unjittered(const Frame& f, Precision precision = Precision::fast) {
    Rgb out;
    temporal::unjitter(f.colorLinear, f.jitterPx, {.precision = precision}, out);
    return out;
}
const dvec2 kJitters[] = {{0.25, -0.125}, {-0.5, 0.5}, {0.5, -0.5}, {0.4375, 7.0 / 18}, {-0.375, -1.0 / 18}, {0, 0.3}};

TEST(Unjitter, WithoutJitterIsExact) {
    const Frame f = temporalFrame(0, 37, 11, noisePicture(3));
    EXPECT_TRUE(unjittered(f).samePixels(f.colorLinear));
    for (const char* method : {"unchartedNorm", "master", "taaSimplest", "raptor", "karis", "salvi", "falcor", "donut",
                               "accumReject", "fsr2n", "smaaT2x"}) {
        RunningMethod on = running(std::string(method) + ":unjitter=on", 37, 11),
                      off = running(std::string(method) + ":unjitter=off", 37, 11);
        for (int n = 0; n < 3; n++) {
            const Frame frame = temporalFrame(n, 37, 11, noisePicture(unsigned(n)), {0.3, -0.6});
            on.resolve(frame, {}, {}), off.resolve(frame, {}, {});
            EXPECT_TRUE(on.out.samePixels(off.out)) << method << " frame " << n;
        }
    }
}
TEST(Unjitter, ARampIsShownWhereItIs) {
    const Scene ramp = [](dvec2 p) { return 0.1 + 0.023 * p.x + 0.007 * p.y; };
    for (const dvec2 j : kJitters) {
        const Frame f = sampled(0, 24, 16, ramp, j);
        const Rgb out = unjittered(f);
        double flipped = 0;
        for (int y = 1; y < 15; y++)
            for (int x = 1; x < 23; x++) {
                EXPECT_NEAR(out.c[1].at(x, y), ramp({x + 0.5, y + 0.5}), 1e-7 + 3e-7) << j.x << " " << j.y;
                const auto at = [&](int i, int k) { return clampedAt(f.colorLinear.c[1], i, k); };
                flipped = std::max(flipped, std::fabs(fetched(at, x, y, -j) - ramp({x + 0.5, y + 0.5})));
            }
        EXPECT_GT(flipped, 3e-3) << "the other sign must not pass";
    }
}
TEST(Unjitter, BeyondThePictureTapsRepeatItsEdge) {
    for (const dvec2 j : kJitters)
        for (const auto& [w, h] : {std::pair{19, 7}, {1, 1}, {1, 9}, {16, 2}}) {
            Frame f = temporalFrame(0, w, h, noisePicture(9));
            f.jitterPx = j;
            const Rgb fast = unjittered(f), scalar = unjittered(f, Precision::scalar),
                      oracle = unjittered(f, Precision::oracle);
            EXPECT_TRUE(fast.samePixels(scalar));
            for (int y = 0; y < h; y++)
                for (int x = 0; x < w; x++) {
                    const auto at = [&](int i, int k) { return clampedAt(f.colorLinear.c[2], i, k); };
                    const double expected = fetched(at, x, y, dvec2(float(j.x), float(j.y)));
                    EXPECT_NEAR(fast.c[2].at(x, y), expected, 2e-7);
                    EXPECT_NEAR(oracle.c[2].at(x, y), expected, 6e-8);
                }
        }
}
// A window at the border reads what a picture continued by its edge shows there: each tap at its own p - j + offset.
TEST(Unjitter, WindowsAtTheBorderReadBeyondIt) {
    const int w = 19, h = 9, margin = 5;
    for (const char* text : {"karis", "salvi", "falcor", "donut", "karis:box=variance,constraint=clipMean",
                             "raptor:sharpen=0", "unchartedNoSharpen"}) {
        const std::string with = std::string(text) + (std::string(text).find(':') == std::string::npos ? ":" : ",");
        RunningMethod small = running(with + "unjitter=on", w, h),
                      large = running(with + "unjitter=on", w + 2 * margin, h + 2 * margin);
        for (int n = 0; n < 4; n++) {
            const Picture picture = noisePicture(unsigned(n));
            Frame f = temporalFrame(n, w, h, picture),
                  g = temporalFrame(n, w + 2 * margin, h + 2 * margin, [&](int x, int y, int c) {
                      return picture(std::clamp(x - margin, 0, w - 1), std::clamp(y - margin, 0, h - 1), c);
                  });
            f.jitterPx = g.jitterPx = kJitters[n];
            small.resolve(f, {}, {}), large.resolve(g, {}, {});
            for (size_t c = 0; c < 3; c++)
                for (int y = 0; y < h; y++)
                    for (int x = 0; x < w; x++)
                        ASSERT_EQ(small.out.c[c].at(x, y), large.out.c[c].at(x + margin, y + margin))
                            << text << " " << n << ": " << x << "," << y;
        }
    }
}
// The mean over a period of a resting half-plane is its samples under a tent of radius 1 px around the pixel centre:
// the published rule, from sample positions alone.
TEST(Unjitter, RestingHalfPlaneBecomesItsTentFilteredTruth) {
    const int w = 20, h = 14;
    const JitterSpec jitter{.sequence = "halton23", .period = 16};
    const Scene edge = [](dvec2 p) {
        return dot(p - dvec2(9.7, 6.4), glm::normalize(dvec2(0.83, 0.37))) > 0 ? 0.9 : 0.1;
    };
    const auto meanOf = [&](double sign) {
        RunningMethod m = running("accumReject:unjitter=on,objectIds=off,depthTest=off", w, h, true);
        for (int t = 0; t < jitter.period; t++) {
            Frame f = sampled(t, w, h, edge, jitterPx(jitter, uint64_t(t)));
            f.jitterPx *= sign;
            m.resolve(f, {}, {});
        }
        return m.out.c[0];
    };
    const PlaneF mean = meanOf(1), flipped = meanOf(-1);
    const auto tent = [](double v) { return std::max(0.0, 1 - std::fabs(v)); };
    double wrong = 0;
    for (int y = 2; y < h - 2; y++)
        for (int x = 2; x < w - 2; x++) {
            double truth = 0;
            for (int t = 0; t < jitter.period; t++)
                for (int b = -2; b <= 2; b++)
                    for (int a = -2; a <= 2; a++) {
                        const dvec2 p(x + 0.5, y + 0.5), s = p + dvec2(a, b) + jitterPx(jitter, uint64_t(t));
                        truth += edge(s) * tent(s.x - p.x) * tent(s.y - p.y) / jitter.period;
                    }
            EXPECT_NEAR(mean.at(x, y), truth, 1e-6) << x << " " << y;
            wrong = std::max(wrong, std::fabs(flipped.at(x, y) - truth));
        }
    EXPECT_GT(wrong, 0.02) << "the other sign must not pass";
}
TEST(Unjitter, GeometryComesFromTheNearestTexel) {
    Frame f = temporalFrame(0, 8, 8, noisePicture(1));
    const auto texel = [&](double x, double y) {
        f.jitterPx = {x, y};
        return temporal::unjitteredTexel(f);
    };
    EXPECT_EQ(texel(0, 0), glm::ivec2(0, 0));
    EXPECT_EQ(texel(0.5, 0.5), glm::ivec2(0, 0));
    EXPECT_EQ(texel(-0.499, 0.25), glm::ivec2(0, 0));
    EXPECT_EQ(texel(-0.5, -0.5), glm::ivec2(1, 1));  // p - j lies on the next pixel's edge, which is that pixel's
    // So does a method: depth 5 everywhere but a near column whose motion is invalid.
    for (int y = -kBorderY; y < 8 + kBorderY; y++) f.motionXPx.row(y)[4] = 1e6f;
    for (const double jitter : {-0.5, 0.5}) {
        RunningMethod m = running("uncharted:unjitter=on,dilation=none,sharpen=none", 8, 8);
        m.method->keepRejection = true;
        Frame first = f, second = f;
        first.jitterPx = second.jitterPx = {jitter, 0};
        second.number = 1, second.reset = false;
        m.resolve(first, {}, {}), m.resolve(second, {}, {});
        for (int x = 0; x < 8; x++)
            EXPECT_EQ(m.method->rejection()->at(x, 3) != 0, x == (jitter < 0 ? 3 : 4)) << jitter << " " << x;
    }
}

// ---- uncharted and master, written a second time
// ---------------------------------------------------------------------
struct Reference {
    int w, h;
    double kMin = 0.925, kMax = 0.979;
    std::vector<std::array<double, 3>> history;
    std::array<double, 3> colour(const Frame& f, int x, int y) const {
        std::array<double, 3> c;
        for (size_t k = 0; k < 3; k++) {
            const auto at = [&](int i, int j) { return clampedAt(f.colorEncoded.c[k], i, j); };
            c[k] = fetched(at, x, y, f.jitterPx);
        }
        return c;
    }
    // motion: the same everywhere. Rounded box, clip to its centre.
    void frame(const Frame& f, dvec2 motionPx) {
        std::vector<std::array<double, 3>> next(size_t(w) * size_t(h));
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++) {
                const auto c = colour(f, x, y);
                auto& out = next[size_t(y * w + x)];
                out = c;
                const double qx = x + 0.5 - motionPx.x, qy = y + 0.5 - motionPx.y;
                if (history.empty() || qx < 0 || qy < 0 || qx > w || qy > h) continue;
                std::array<double, 3> past, lo, hi;
                double reach = 0;
                for (size_t k = 0; k < 3; k++) {
                    const auto at = [&](int i, int j) {
                        return history[size_t(std::clamp(j, 0, h - 1) * w + std::clamp(i, 0, w - 1))][k];
                    };
                    past[k] = fetched(at, x, y, motionPx);
                    double loPlus = 9, hiPlus = -9, loAll = 9, hiAll = -9;
                    for (int j = -1; j <= 1; j++)
                        for (int i = -1; i <= 1; i++) {
                            const double v = colour(f, x + i, y + j)[k];
                            loAll = std::min(loAll, v), hiAll = std::max(hiAll, v);
                            if (i == 0 || j == 0) loPlus = std::min(loPlus, v), hiPlus = std::max(hiPlus, v);
                        }
                    lo[k] = (loPlus + loAll) / 2, hi[k] = (hiPlus + hiAll) / 2;
                }
                const double floorExtent = std::max(1e-8, 1e-6 * std::max({hi[0], hi[1], hi[2]}));
                for (size_t k = 0; k < 3; k++)
                    reach =
                        std::max(reach, std::fabs(past[k] - (lo[k] + hi[k]) / 2) / ((hi[k] - lo[k]) / 2 + floorExtent));
                for (size_t k = 0; k < 3; k++)
                    if (reach > 1) past[k] = (lo[k] + hi[k]) / 2 + (past[k] - (lo[k] + hi[k]) / 2) / reach;
                const auto luma = [](const auto& v) { return v[0] / 4 + v[1] / 2 + v[2] / 4; };
                const double d = std::fabs(luma(c) - luma(past)) / std::max({luma(c), luma(past), 0.2});
                const double k = kMin + (kMax - kMin) * (1 - d) * (1 - d);
                for (size_t i = 0; i < 3; i++) out[i] = past[i] + (c[i] - past[i]) * (1 - k);
            }
        history = next;
    }
};
TEST(Unjitter, UnchartedAgainstADirectEvaluation) {
    const int w = 21, h = 9;
    const dvec2 motion(0.375, -0.75);
    RunningMethod m = running("unchartedNoSharpen", w, h);
    Reference reference{w, h, {}, {}, {}};
    reference.kMin = 0.925, reference.kMax = 0.979;
    for (int n = 0; n < 6; n++) {
        Frame f = temporalFrame(n, w, h, noisePicture(unsigned(n)), motion);
        f.jitterPx = kJitters[n];
        m.resolve(f, {}, {});
        f.jitterPx = dvec2(float(f.jitterPx.x), float(f.jitterPx.y));
        reference.frame(f, motion);
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++)
                for (size_t c = 0; c < 3; c++)
                    ASSERT_NEAR(m.out.c[c].at(x, y), reference.history[size_t(y * w + x)][c], 3e-6)
                        << n << " at " << x << "," << y;
    }
}
// With everything aliased and its own sharpening off, master is the baseline with a pure 3x3 box, whatever the jitter.
TEST(Unjitter, MasterReadsTheColoursThatUnchartedReads) {
    const int w = 40, h = 18;
    RunningMethod a = running("master:minAlias=1,sharpen=none", w, h),
                  b = running("unchartedNoSharpen:neighbourhood=3x3", w, h);
    for (int n = 0; n < 6; n++) {
        Frame f = temporalFrame(n, w, h, noisePicture(unsigned(n)), {0.4, -0.3});
        f.jitterPx = kJitters[n];
        a.resolve(f, {}, {}), b.resolve(f, {}, {});
        for (size_t c = 0; c < 3; c++)
            for (int y = 0; y < h; y++)
                for (int x = 0; x < w; x++)
                    ASSERT_NEAR(a.out.c[c].at(x, y), b.out.c[c].at(x, y), 2e-6) << x << "," << y;
    }
}
// Sobel at the jittered frame's texels, then read at p - j; both pseudo-variances in the unit that was asked for.
TEST(Unjitter, MasterTermsAgainstADirectEvaluation) {
    const int w = 20, h = 10;
    const double farDepth = 40;
    const auto scene = [&](int n) {
        Frame f = temporalFrame(n, w, h, noisePicture(unsigned(n)));
        f.albedoLinear = temporalFrame(n, w, h, noisePicture(77u + unsigned(n))).colorLinear;
        const Picture depth = noisePicture(200u + unsigned(n));
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++) f.depthView.at(x, y) = depth(x, y, 0) < 0.2f ? 1e10f : 3 + 20 * depth(x, y, 1);
        f.depthView.at(3, 3) = float(farDepth);  // without a camera the farthest depth is the far plane
        f.depthView.fillBorder();
        f.jitterPx = kJitters[n];
        encodeFrame(f, {}, {});
        return f;
    };
    for (const std::string unit : {"normalised", "zfar", "world"}) {
        const auto inUnit = [&](const Frame& f, int x, int y) {
            const double z = std::min(farDepth, clampedAt(f.depthView, x, y));
            return unit == "world" ? z : unit == "zfar" ? z / farDepth : 2 * z / (z + farDepth);
        };
        RunningMethod m = running("master:sobelTemporal=off,depthUnit=" + unit, w, h);
        m.method->keepDebugLayers = true;
        for (int n = 0; n < 4; n++) {
            const Frame f = scene(n);
            m.resolve(f, {}, {});
            if (n == 0) continue;
            const auto layers = m.method->debugLayers();
            const auto layer = [&](const std::string& name) -> const PlaneF& {
                for (const auto& l : layers)
                    if (l.name == name) return l.planes[0];
                throw std::runtime_error(name);
            };
            const auto sobelAtTexel = [&](int x, int y) {
                x = std::clamp(x, 0, w - 1), y = std::clamp(y, 0, h - 1);
                const auto magnitude = [&](const auto& v) {
                    const double gx = v(x + 1, y - 1) + 2 * v(x + 1, y) + v(x + 1, y + 1) - v(x - 1, y - 1) -
                                      2 * v(x - 1, y) - v(x - 1, y + 1);
                    const double gy = v(x - 1, y - 1) + 2 * v(x, y - 1) + v(x + 1, y - 1) - v(x - 1, y + 1) -
                                      2 * v(x, y + 1) - v(x + 1, y + 1);
                    return std::hypot(gx, gy);
                };
                const auto luma = [&](const Rgb& p) {
                    return [&p](int i, int j) {
                        return clampedAt(p.c[0], i, j) / 4 + clampedAt(p.c[1], i, j) / 2 + clampedAt(p.c[2], i, j) / 4;
                    };
                };
                const double g =
                    std::clamp(0.3 * magnitude(luma(f.albedoEncoded)) + 0.7 * magnitude(luma(f.colorEncoded)) +
                                   magnitude([&](int i, int j) { return inUnit(f, i, j); }),
                               0.0, 1.0);
                return std::sqrt(g * g * (3 - 2 * g));
            };
            const glm::ivec2 texel = temporal::unjitteredTexel(f);
            for (int y = 0; y < h; y++)
                for (int x = 0; x < w; x++) {
                    double plus = 0, square = 0, own = 0;
                    for (int j = -1; j <= 1; j++)
                        for (int i = -1; i <= 1; i++) {
                            // Filtered values repeat the picture's edge.
                            const double s = fetched(sobelAtTexel, std::clamp(x + i, 0, w - 1),
                                                     std::clamp(y + j, 0, h - 1), f.jitterPx);
                            square += s / 9;
                            if (i == 0 || j == 0) plus += s / 5;
                            if (i == 0 && j == 0) own = s;
                        }
                    ASSERT_NEAR(layer("sobelAverage").at(x, y), plus + (square - plus) * std::min(own, 1.0), 4e-6)
                        << unit << " " << n << " at " << x << "," << y;
                    double mean = 0, lo = 1e9, hi = -1e9;
                    for (int j = -1; j <= 1; j++)
                        for (int i = -1; i <= 1; i++) {
                            const double z = inUnit(f, x + texel.x + i, y + texel.y + j);
                            mean += z / 9, lo = std::min(lo, z), hi = std::max(hi, z);
                        }
                    const double D = std::min(std::fabs(lo - mean), std::fabs(hi - mean));
                    if (D < 0.0025) continue;  // beside the threshold, where float and double may differ
                    const double expected = std::pow((inUnit(f, x + texel.x, y + texel.y) - mean) / D, 2);
                    ASSERT_NEAR(layer("depthPseudoVariance").at(x, y), expected, 1e-3 * (1 + expected))
                        << unit << " " << n << " at " << x << "," << y;
                }
        }
    }
}

}  // namespace
}  // namespace aa
