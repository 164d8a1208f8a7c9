// Frames for the tests of temporal methods: any picture, one motion, one jitter.
#pragma once
#include <cmath>
#include <functional>
#include <random>

#include "methods/driver.h"
#include "methods/methods_under_test.h"

namespace aa::testing {

using Picture = std::function<float(int x, int y, int channel)>;

inline Frame temporalFrame(int number, int w, int h, const Picture& picture, glm::dvec2 motionPx = {0, 0}) {
    Frame f;
    f.number = number;
    f.width = w, f.height = h;
    f.reset = number == 0;
    f.passes = Pass::color | Pass::depth | Pass::motion | Pass::object | Pass::albedo;
    f.colorLinear = Rgb(w, h);
    f.depthView = PlaneF(w, h, 5.0f);
    f.objectId = PlaneU(w, h, 1);
    f.motionXPx = PlaneF(w, h, float(motionPx.x)), f.motionYPx = PlaneF(w, h, float(motionPx.y));
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++) f.colorLinear.c[c].at(x, y) = picture(x, y, int(c));
    f.colorLinear.fillBorder();
    f.albedoLinear = f.colorLinear;
    encodeFrame(f, {}, {});
    return f;
}
inline Picture noisePicture(unsigned seed) {
    return [seed](int x, int y, int c) {
        uint32_t v = seed * 2654435761u + uint32_t(x) * 7919u + uint32_t(y) * 104729u + uint32_t(c) * 15485863u;
        for (int round = 0; round < 3; round++) v = (v ^ (v >> 15)) * 0x2c1b3c6du + 0x9e3779b9u;
        return float(v >> 8) / float(1 << 24);
    };
}
inline RunningMethod running(const std::string& text, int w, int h, bool isStatic = false) {
    return RunningMethod(specUnderTest(text), {.width = w,
                                               .height = h,
                                               .jitterPeriod = 16,
                                               .isStatic = isStatic,
                                               .frameCount = 16,
                                               .subSamplePositionsPx = {{0.25, 0.25}, {-0.25, -0.25}}});
}

}  // namespace aa::testing
