// Small frames with every pass, for tests that run over all registered methods.
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>

#include "image/error.h"
#include "methods/driver.h"
#include "methods/methods_under_test.h"
#include "shot/pass_table.h"

namespace aa::testing {

// Offsets from the pixel centre in 1/16 px, D3D11 standard patterns (conventions 2).
inline constexpr int kQuincunx = 0;  // in place of a number of samples: the pattern of that name
inline std::vector<glm::dvec2> pattern(int samples) {
    if (samples == kQuincunx) return {{0, 0}, {-0.5, -0.5}};
    static const int p2[] = {4, 4, -4, -4}, p4[] = {-2, -6, 6, -2, -6, 2, 2, 6},
                     p8[] = {1, -3, -1, 3, 5, 1, -3, -5, -5, 5, -7, -1, 3, 7, 7, -7},
                     p16[] = {1,  1, -1, -3, -3, 2,  4,  -1, -5, -2, 2, 5,  5, 3, 3,  -5,
                              -2, 6, 0,  -7, -4, -6, -6, 4,  -8, 0,  7, -4, 6, 7, -7, -8};
    const int* p = samples == 2 ? p2 : samples == 4 ? p4 : samples == 8 ? p8 : p16;
    std::vector<glm::dvec2> r;
    for (int i = 0; i < samples; i++) r.emplace_back(p[2 * i] / 16.0, p[2 * i + 1] / 16.0);
    return r;
}

// What lies at a continuous position of the un-jittered picture.
struct Surface {
    glm::vec3 color;
    float depthView;
    glm::vec3 normalWorld;
    uint32_t objectId;
};
using Scene = std::function<Surface(double x, double y)>;

// An orthographic camera whose view space is the pixel grid: x right, y up, looking along -z.
inline Camera pixelCamera(int w, int h) {
    Camera c;
    c.kind = "orthographic";
    c.nearClip = 0.1;
    c.farClip = 100;
    c.projection = glm::dmat4(1.0);
    c.projection[0][0] = 2.0 / w;
    c.projection[1][1] = 2.0 / h;
    c.projection[2][2] = -2.0 / (c.farClip - c.nearClip);
    c.projection[3][2] = -(c.farClip + c.nearClip) / (c.farClip - c.nearClip);
    return c;
}

inline Frame renderFrame(const Scene& scene, int w, int h, int number, glm::dvec2 jitterPx, glm::dvec2 motionPx,
                         int samples) {
    Frame f;
    f.number = number;
    f.width = w;
    f.height = h;
    f.reset = number == 1;
    f.jitterPx = jitterPx;
    f.camera = pixelCamera(w, h);
    if (!f.reset) f.previousCamera = f.camera;
    for (const auto& p : allPasses()) f.passes |= p.pass;
    f.colorLinear = f.albedoLinear = f.normalWorld = Rgb(w, h);
    f.depthView = f.motionXPx = f.motionYPx = f.edgeXPx = f.edgeYPx = PlaneF(w, h);
    f.objectId = f.subSampleMask = PlaneU(w, h);
    f.subSamplePositionsPx = pattern(samples);
    f.subSamples.resize(f.subSamplePositionsPx.size());
    for (auto& s : f.subSamples) s = {PlaneF(w, h), Rgb(w, h), PlaneU(w, h), Rgb(w, h)};
    for (int i = 0; i < 12; i++) {  // a star that crosses the picture, each ray at another depth
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

// A tilted quad and a disc before a dark background, translated by `at`.
inline Scene shapes(glm::dvec2 at = {0, 0}) {
    return [at](double x, double y) -> Surface {
        const double u = x - at.x, v = y - at.y;
        if (std::hypot(u - 20.3, v - 12.7) < 7.4) return {{0.9f, 0.2f, 0.1f}, 4.0f, {0, 0, 1}, 2};
        if (0.31 * u + v > 9.2 && v - 0.2 * u < 21.1)
            return {{0.2f, 0.5f, 0.8f}, 6.0f + float(0.01 * u), {0.0099995f, 0, 0.99995f}, 1};
        return {{0.05f, 0.06f, 0.04f}, 1e10f, {0, 0, 0}, 0};
    };
}
inline Scene constantScene(glm::vec3 color) {
    return [color](double, double) -> Surface { return {color, 5.0f, {0, 0, 1}, 1}; };
}
// Vigna's splitmix64: good numbers from any seed at once, where an mt19937 first fills 2.5 KB of state.
class SplitMix64 {
  public:
    explicit SplitMix64(uint64_t seed) : state_(seed) {}
    uint64_t next() {
        uint64_t z = state_ += 0x9E3779B97F4A7C15ull;
        z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9ull;
        z = (z ^ z >> 27) * 0x94D049BB133111EBull;
        return z ^ z >> 31;
    }
    float uniform() { return float(next() >> 40) * 0x1p-24f; }  // [0, 1)

  private:
    uint64_t state_;
};
// Uncorrelated values: every branch of every method is visited.
inline Scene noise(unsigned seed) {
    return [seed](double x, double y) -> Surface {
        SplitMix64 g(uint64_t(seed) << 32 ^
                     uint64_t(uint32_t(int(std::floor(x)) * 7919 + int(std::floor(y)) * 104729)));
        const float r = g.uniform(), gr = g.uniform(), b = g.uniform(), z = 1 + 9 * g.uniform();
        const uint32_t id = uint32_t(g.next() >> 62);
        return {{r, gr, b}, id == 0 ? 1e10f : z, id == 0 ? glm::vec3(0) : glm::vec3(0, 0, 1), id};
    };
}

// Halton(2, 3) from index 1, minus 0.5 (conventions 6).
inline glm::dvec2 halton(int n) {
    auto inverse = [](int i, int base) {
        double f = 1, r = 0;
        for (; i > 0; i /= base) f /= base, r += f * (i % base);
        return r;
    };
    return {inverse(n, 2) - 0.5, inverse(n, 3) - 0.5};
}

// "name=value," that makes a parameter act, and before it what makes that one act; empty where the defaults do.
inline std::string condition(const MethodDescriptor& method, const ParamSpec& param) {
    const size_t eq = param.onlyWhen.find('=');
    if (eq == std::string_view::npos) return "";
    const std::string_view name = param.onlyWhen.substr(0, eq);
    for (const ParamSpec& other : method.params) {
        if (other.name != name) continue;
        const std::string before = condition(method, other);
        std::string_view values = param.onlyWhen.substr(eq + 1), first;
        while (!values.empty()) {
            const size_t bar = std::min(values.find('|'), values.size());
            const std::string_view value = values.substr(0, bar);
            if (value == other.defaultValue) return before;
            if (first.empty() && std::count(other.choices.begin(), other.choices.end(), value)) first = value;
            values.remove_prefix(std::min(bar + 1, values.size()));
        }
        return before + std::string(name) + "=" + std::string(first) + ",";
    }
    return "";
}
// Every method at its defaults, and once with every value of every choice and flag.
inline std::vector<std::string> allSpecs() {
    std::vector<std::string> specs;
    for (const auto& m : methodsUnderTest()) {
        specs.emplace_back(m.id);
        for (const auto& p : m.params)
            for (const auto& value : p.choices) {
                if (value == p.defaultValue) continue;
                const std::string text =
                    std::string(m.id) + ":" + condition(m, p) + std::string(p.name) + "=" + std::string(value);
                try {
                    specUnderTest(text);
                    specs.push_back(text);
                } catch (const UsageError&) {
                }
            }
    }
    specs.emplace_back("inside:motionBlur=1");  // off by default
    return specs;
}

// "resolver/methods/spatial/x.cpp:40", for messages: the file to touch.
inline std::string fileOf(const std::string& text) { return specUnderTest(text).method->writtenAt.text(); }

// A method with the number of sub-samples that it accepts.
struct Subject {
    RunningMethod running;
    int samples;
};
inline Subject makeSubject(const std::string& text, int w, int h,
                           const std::vector<MethodDescriptor>& among = methodsUnderTest()) {
    const MethodSpec spec = parseMethod(text, among);
    std::string why;
    for (int samples : {8, 4, 2, 16, kQuincunx}) try {
            return {RunningMethod(spec, {.width = w,
                                         .height = h,
                                         .jitterPeriod = 16,
                                         .isStatic = true,
                                         .frameCount = 16,
                                         .subSamplePositionsPx = pattern(samples)}),
                    samples};
        } catch (const std::runtime_error& e) {
            why = e.what();
        }
    throw std::runtime_error(text + ": accepts no sub-sample pattern: " + why);
}
inline const Rgb& step(Subject& s, Frame f, const Exec& exec = {}) {
    encodeFrame(f, {}, exec);
    s.running.resolve(f, {}, exec);
    return s.running.out;
}

}  // namespace aa::testing
