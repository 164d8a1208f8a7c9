#include "shot/synth/drawn_frames.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "image/input_policy.h"
#include "shot/pass_table.h"
#include "shot/sanitise.h"

namespace aa {

Camera orthographicCamera(int w, int h, double unitsPerPixel) {
    Camera c;
    c.kind = "orthographic";
    c.nearClip = 0.1;
    c.farClip = 100;
    c.projection = glm::dmat4(1.0);
    c.projection[0][0] = 2 / (unitsPerPixel * w);
    c.projection[1][1] = 2 / (unitsPerPixel * h);
    c.projection[2][2] = -2.0 / (c.farClip - c.nearClip);
    c.projection[3][2] = -(c.farClip + c.nearClip) / (c.farClip - c.nearClip);
    return c;
}

Frame drawFrame(const DrawnScene& scene, int w, int h, int number, glm::dvec2 jitterPx, glm::dvec2 motionPx,
                const std::vector<glm::dvec2>& subSamplesPx) {
    Frame f;
    f.number = number;
    f.width = w;
    f.height = h;
    f.reset = number == 1;
    f.jitterPx = jitterPx;
    f.camera = orthographicCamera(w, h, 1);
    if (!f.reset) f.previousCamera = f.camera;
    for (const auto& p : allPasses()) f.passes |= p.pass;
    f.colorLinear = f.albedoLinear = f.normalWorld = Rgb(w, h);
    f.depthView = f.motionXPx = f.motionYPx = f.edgeXPx = f.edgeYPx = PlaneF(w, h);
    f.objectId = f.subSampleMask = PlaneU(w, h);
    f.subSamplePositionsPx = subSamplesPx;
    f.subSamples.resize(f.subSamplePositionsPx.size());
    for (auto& s : f.subSamples) s = {PlaneF(w, h), Rgb(w, h), PlaneU(w, h), Rgb(w, h)};
    for (int i = 0; i < 12; i++) {  // each ray at another depth
        const float x = float(w) * (0.5f + 0.6f * float(std::cos(i * 0.53))),
                    y = float(h) * (0.5f + 0.6f * float(std::sin(i * 0.53)));
        f.segments.push_back({float(w) * 0.4f, float(h) * 0.45f, 2.0f + float(i), x, y, 3.0f});
    }
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            const Surface s = scene(x + 0.5 + jitterPx.x, y + 0.5 + jitterPx.y);
            for (int c = 0; c < 3; c++) {
                f.colorLinear.c[size_t(c)].at(x, y) = s.color[c];
                f.albedoLinear.c[size_t(c)].at(x, y) = s.color[c];
                f.normalWorld.c[size_t(c)].at(x, y) = s.normalWorld[c];
            }
            f.depthView.at(x, y) = s.depthView;
            f.objectId.at(x, y) = s.objectId;
            f.motionXPx.at(x, y) = float(motionPx.x);
            f.motionYPx.at(x, y) = float(motionPx.y);
            f.edgeXPx.at(x, y) = 0.5f;
            f.edgeYPx.at(x, y) = 0.5f;
            uint32_t mask = 0;
            for (size_t k = 0; k < f.subSamples.size(); k++) {
                const auto o = f.subSamplePositionsPx[k];
                const Surface t = scene(x + 0.5 + jitterPx.x + o.x, y + 0.5 + jitterPx.y + o.y);
                for (int c = 0; c < 3; c++) {
                    f.subSamples[k].colorLinear.c[size_t(c)].at(x, y) = t.color[c];
                    f.subSamples[k].normalWorld.c[size_t(c)].at(x, y) = t.normalWorld[c];
                }
                f.subSamples[k].depthView.at(x, y) = t.depthView;
                f.subSamples[k].objectId.at(x, y) = t.objectId;
                if (t.objectId == s.objectId) mask |= 1u << k;
            }
            f.subSampleMask.at(x, y) = mask;
        }
    for (Rgb* i : {&f.colorLinear, &f.albedoLinear, &f.normalWorld}) i->fillBorder();
    for (PlaneF* p : {&f.depthView, &f.motionXPx, &f.motionYPx, &f.edgeXPx, &f.edgeYPx}) p->fillBorder();
    f.objectId.fillBorder();
    f.subSampleMask.fillBorder();
    for (auto& s : f.subSamples)
        s.colorLinear.fillBorder(), s.normalWorld.fillBorder(), s.depthView.fillBorder(), s.objectId.fillBorder();
    return f;
}

float logUniform(SplitMix64& g, double least, double most) {
    return float(std::exp(std::log(least) + double(g.uniform()) * (std::log(most) - std::log(least))));
}
DrawnScene drawnByChance(unsigned seed, const SurfaceDraw& draw) {
    return [=](double x, double y) {
        SplitMix64 g(uint64_t(seed) << 40 ^ uint64_t(uint32_t(int(std::floor(x * 4)) * 7919)) << 8 ^
                     uint64_t(uint32_t(int(std::floor(y * 4)) * 104729)));
        g.next();
        return draw(g);
    };
}
Surface surfaceByChance(SplitMix64& g, glm::vec3 color, float depth) {
    const glm::vec3 n{g.uniform() - 0.5f, g.uniform() - 0.5f, g.uniform() + 0.01f};  // braces: drawn from the left
    const bool background = depth >= 1e9f;
    return {color, background ? kBackgroundDepth : depth, background ? glm::vec3(0) : glm::normalize(n),
            background ? 0u : 1 + uint32_t(g.next() >> 61)};
}
SurfaceDraw lightByChance(double least, double most) {
    return [=](SplitMix64& g) {
        const glm::vec3 c{logUniform(g, least, most), logUniform(g, least, most), logUniform(g, least, most)};
        return surfaceByChance(g, c, g.uniform() < 0.2f ? kBackgroundDepth : 1 + 9 * g.uniform());
    };
}
glm::vec2 motionByChance(SplitMix64& g, double least, double most) {
    const float length = logUniform(g, least, most), angle = 6.2831853f * g.uniform();
    return {length * std::cos(angle), length * std::sin(angle)};
}

Frame drawFrameByChance(unsigned seed, const SurfaceDraw& draw, const std::function<glm::vec2(SplitMix64&)>& motionPx,
                        int w, int h, int number, glm::dvec2 jitterPx, const std::vector<glm::dvec2>& subSamplesPx) {
    const unsigned key = seed * 131 + unsigned(number);
    Frame f = drawFrame(drawnByChance(key, draw), w, h, number, jitterPx, {0, 0}, subSamplesPx);
    SplitMix64 g(key);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            const glm::vec2 m = motionPx(g);
            f.motionXPx.at(x, y) = m.x, f.motionYPx.at(x, y) = m.y;
            f.edgeXPx.at(x, y) = g.uniform() - 0.5f, f.edgeYPx.at(x, y) = g.uniform() - 0.5f;
        }
    for (PlaneF* p : {&f.motionXPx, &f.motionYPx, &f.edgeXPx, &f.edgeYPx}) p->fillBorder();
    const auto limit = [](Rgb& colour) {
        sanitiseColour(colour, false, InputPolicy::sanitise, ColourUse::method, {"", {"R", "G", "B"}});
        colour.fillBorder();
    };
    limit(f.colorLinear), limit(f.albedoLinear);
    for (auto& s : f.subSamples) limit(s.colorLinear);
    return f;
}

}  // namespace aa
