#include "study/stability_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shot/jitter.h"
#include "shot/synth/drawn_frames.h"

namespace aa::stability {
namespace {

double chance(uint32_t seed, uint64_t key) {  // [0, 1)
    SplitMix64 g(uint64_t(seed) << 40 ^ key);
    g.next();
    return double(g.uniform());
}
uint64_t keyOf(int frame, int x, int y, size_t channel) {
    return ((uint64_t(uint32_t(frame)) * 8192 + uint64_t(uint32_t(y))) * 8192 + uint64_t(uint32_t(x))) * 4 + channel;
}
Frame encoded(Frame frame) {
    encodeFrame(frame, {}, {.parallel = false});
    return frame;
}
// A picture of pixels and not of a scene: each has one value, `code` of 255, wherever in it is asked.
Frame pixelFrame(int number, int width, int height, const std::function<double(int x, int y)>& code,
                 const std::vector<glm::dvec2>& subSamplesPx) {
    Rgb codes(width, height), light;
    for (PlaneF& p : codes.c)
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) p.at(x, y) = float(code(x, y) / 255);
    decode(codes, {}, {.parallel = false}, light);
    light.fillBorder();
    const DrawnScene flat = [](double, double) -> Surface { return {{0, 0, 0}, 5, {0, 0, 1}, 1}; };
    Frame frame = drawFrame(flat, width, height, number, {0, 0}, {0, 0}, subSamplesPx);
    frame.colorLinear = frame.albedoLinear = light;
    for (SubSample& s : frame.subSamples) s.colorLinear = light;
    return encoded(std::move(frame));
}
// Applies `change(value, plane index, x, y)` to every value of every given plane.
template <class Change>
void change(std::vector<PlaneF*> planes, const Change& by) {
    for (size_t k = 0; k < planes.size(); k++) {
        PlaneF& p = *planes[k];
        if (p.empty()) continue;
        for (int y = 0; y < p.height(); y++)
            for (int x = 0; x < p.width(); x++) p.at(x, y) = by(p.at(x, y), k, x, y);
        p.fillBorder();
    }
}
std::vector<PlaneF*> coloursOf(Frame& f) {
    std::vector<PlaneF*> planes;
    const auto add = [&](Rgb& colour) {
        for (PlaneF& p : colour.c) planes.push_back(&p);
    };
    add(f.colorLinear), add(f.albedoLinear);
    for (SubSample& s : f.subSamples) add(s.colorLinear);
    return planes;
}
}  // namespace

std::vector<Frame> wideLightFrames(unsigned seed, const std::vector<glm::dvec2>& subSamplesPx) {
    std::vector<Frame> frames;
    for (int n = 1; n <= kWideLightFrames; n++)
        frames.push_back(encoded(drawFrameByChance(
            seed, lightByChance(1e-6, 1e6), [](SplitMix64& g) { return motionByChance(g, 0.1, 3); }, kWideLightWidth,
            kWideLightHeight, n, jitterPx({.period = 16}, uint64_t(n - 1)), subSamplesPx)));
    return frames;
}

ShotInfo restingInfo(const Frame& frame) {
    return {.width = frame.width,
            .height = frame.height,
            .jitterPeriod = kRestPeriod,
            .isStatic = true,
            .frameCount = kRestPeriod,
            .subSamplePositionsPx = frame.subSamplePositionsPx};
}

namespace {
// `code` of the pixels that are looked at, by their place among each other.
Frame amongOthers(int number, int width, int height, const std::function<double(int x, int y)>& code,
                  const std::vector<glm::dvec2>& subSamplesPx) {
    constexpr double kBeside = 230, kAbove = 26, kOther = 128;
    return pixelFrame(
        number, width, height,
        [&](int x, int y) {
            const bool column = x % kEvery == 0, row = y % kEvery == 0;
            return column && row ? code(x / kEvery, y / kEvery) : row ? kBeside : column ? kAbove : kOther;
        },
        subSamplesPx);
}
}  // namespace
Frame stallFrame(int number, double code, const std::vector<glm::dvec2>& subSamplesPx) {
    return amongOthers(
        number, kStallWidth, kStallHeight, [=](int, int) { return code; }, subSamplesPx);
}
Frame gradientFrame(int number, const std::vector<glm::dvec2>& subSamplesPx) {
    return amongOthers(
        number, kGradientWidth, kGradientHeight, [](int x, int y) { return 128 + 0.025 * x + 0.012 * y; },
        subSamplesPx);
}
Rgb lookedAt(const Rgb& image) {
    Rgb r(image.width() / kEvery, image.height() / kEvery);
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < r.height(); y++)
            for (int x = 0; x < r.width(); x++) r.c[c].at(x, y) = image.c[c].at(kEvery * x, kEvery * y);
    r.fillBorder();
    return r;
}

// A tilted quad and a disc before a dark wall.
Frame restingFrame(int number, const std::vector<glm::dvec2>& subSamplesPx) {
    const DrawnScene scene = [](double x, double y) -> Surface {
        if (std::hypot(x - 30.3, y - 17.7) < 8.4) return {{0.9f, 0.2f, 0.1f}, 4, {0, 0, 1}, 2};
        if (0.31 * x + y > 11.2 && y - 0.2 * x < 25.1) return {{0.2f, 0.5f, 0.8f}, 6, {0, 0, 1}, 1};
        return {{0.05f, 0.06f, 0.04f}, 20, {0, 0, 1}, 3};
    };
    return encoded(drawFrame(scene, kRestWidth, kRestHeight, number,
                             jitterPx({.period = kRestPeriod}, uint64_t(number - 1)), {0, 0}, subSamplesPx));
}
void addFireflies(Frame& frame) {
    change(coloursOf(frame), [](float v, size_t, int x, int y) { return x % 8 == 4 && y % 8 == 4 ? kFirefly : v; });
    encodeFrame(frame, {}, {.parallel = false});
}

void addGrain(Frame& frame, uint32_t seed) {
    change(coloursOf(frame), [&](float v, size_t k, int x, int y) {
        return float(double(v) * (0.98 + 0.04 * chance(seed + uint32_t(k) * 977, keyOf(frame.number, x, y, k % 3))));
    });
    encodeFrame(frame, {}, {.parallel = false});
}

Frame movedByOneUlp(const Frame& frame, uint32_t seed) {
    Frame moved = frame;
    constexpr float inf = std::numeric_limits<float>::infinity();
    change(coloursOf(moved), [&](float v, size_t k, int x, int y) {
        if (!(v > 0)) return v;  // beside 0 lies the least denormal, which is no change
        return std::nextafterf(v, chance(seed + uint32_t(k) * 977, keyOf(frame.number, x, y, 3)) < 0.5 ? -inf : inf);
    });
    encodeFrame(moved, {}, {.parallel = false});
    return moved;
}

Frame movedByShare(const Frame& frame, double share, uint32_t seed, int draw) {
    Frame moved = frame;
    std::vector<PlaneF*> planes = coloursOf(moved);
    for (PlaneF& p : moved.normalWorld.c) planes.push_back(&p);
    for (PlaneF* p : {&moved.depthView, &moved.motionXPx, &moved.motionYPx, &moved.edgeXPx, &moved.edgeYPx})
        planes.push_back(p);
    for (SubSample& s : moved.subSamples) {
        planes.push_back(&s.depthView);
        for (PlaneF& p : s.normalWorld.c) planes.push_back(&p);
    }
    const double turned = draw % 2 == 0 ? share : -share;
    change(planes, [&](float v, size_t k, int x, int y) {
        if (!(std::abs(v) < kInvalidMotionPx)) return v;
        const bool up =
            chance(seed + uint32_t(draw / 2) * 7919 + uint32_t(k) * 977, keyOf(frame.number, x, y, 3)) < 0.5;
        return float(double(v) * (1 + (up ? turned : -turned)));
    });
    encodeFrame(moved, {}, {.parallel = false});
    return moved;
}

}  // namespace aa::stability
