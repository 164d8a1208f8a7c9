// Small frames with every pass, for tests that run over all registered methods.
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>

#include "image/error.h"
#include "methods/driver.h"
#include "methods/methods_under_test.h"
#include "methods/stage.h"
#include "shot/pass_table.h"
#include "shot/synth/drawn_frames.h"

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

using Scene = DrawnScene;

inline Frame renderFrame(const Scene& scene, int w, int h, int number, glm::dvec2 jitterPx, glm::dvec2 motionPx,
                         int samples) {
    return drawFrame(scene, w, h, number, jitterPx, motionPx, pattern(samples));
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
// These, and every stage behind methods of several kinds.
inline std::vector<std::string> withEveryStage() {
    std::vector<std::string> specs = allSpecs();
    const char* const before[] = {"noaa", "ssaa", "smaa1x", "karis", "inside"};
    for (const auto& stage : stages()) {
        std::vector<std::string> values(stage.value.choices.begin(), stage.value.choices.end());
        if (stage.valueIsMethod) values = {"fxaa311", "smaa1x"};
        if (stage.value.type == ParamSpec::Type::real && values.empty()) values = {"0.5", "16"};
        for (const char* method : before)
            for (const auto& value : values) {
                const std::string text = std::string(method) + "+" + std::string(stage.value.name) + "=" + value;
                try {
                    makeSubject(text, 4, 4);
                    specs.push_back(text);
                } catch (const std::runtime_error&) {  // this stage does not serve this method
                }
            }
    }
    return specs;
}
inline const Rgb& step(Subject& s, Frame f, const Exec& exec = {}) {
    encodeFrame(f, {}, exec);
    s.running.resolve(f, {}, exec);
    return s.running.out;
}

}  // namespace aa::testing
