// Test support for the spatial methods: images, frames and runs of a method by its specification.
#pragma once
#include <random>

#include "methods/method.h"
#include "methods/methods_under_test.h"

namespace aa::testing {

// STEP (conventions 15): 64 x 9, 1 for y < 4 and, where x >= 32, also for y = 4; else 0.
inline Rgb stepImage() {
    Rgb image(64, 9);
    for (auto& p : image.c)
        for (int y = 0; y < 9; y++)
            for (int x = 0; x < 64; x++) p.at(x, y) = y < 4 || (y == 4 && x >= 32) ? 1.0f : 0.0f;
    return image;
}
// Half-planes, discs and thin lines of random colours over each other, point-sampled, 8-bit codes.
inline Rgb randomShapes(int width, int height, unsigned seed) {
    std::mt19937 random(seed);
    auto uniform = [&](double lo, double hi) { return lo + (hi - lo) * (random() * (1.0 / 4294967296.0)); };
    Rgb image(width, height, 0.5f);
    for (int k = 0; k < 24; k++) {
        const double cx = uniform(0, width), cy = uniform(0, height), angle = uniform(0, 6.283185307179586);
        const double nx = std::cos(angle), ny = std::sin(angle), size = uniform(2, 0.3 * width);
        const int kind = int(uniform(0, 3));
        float colour[3];
        for (float& c : colour) c = float(std::floor(uniform(0, 256)) / 255);
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) {
                const double dx = x + 0.5 - cx, dy = y + 0.5 - cy, n = dx * nx + dy * ny, t = dy * nx - dx * ny;
                const bool inside = kind == 0   ? std::abs(n) < size * 0.5 && std::abs(t) < size
                                    : kind == 1 ? dx * dx + dy * dy < size * size * 0.25
                                                : std::abs(n) < 0.8;
                if (inside)
                    for (size_t c = 0; c < 3; c++) image.c[c].at(x, y) = colour[c];
            }
    }
    return image;
}
// A random 8-bit code per pixel and channel.
inline Rgb randomCodes(int width, int height, unsigned seed) {
    std::mt19937 random(seed);
    Rgb image(width, height);
    for (auto& p : image.c)
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) p.at(x, y) = float(random() >> 24) / 255.0f;
    return image;
}
// A frame whose encoded colour is `encoded` exactly.
inline Frame frameOf(const Rgb& encoded) {
    Frame f;
    f.width = encoded.width();
    f.height = encoded.height();
    f.reset = true;
    f.passes = Pass::color;
    f.colorEncoded = encoded;
    f.colorEncoded.fillBorder();
    decode(f.colorEncoded, {}, {}, f.colorLinear);
    return f;
}
inline Exec execOf(Precision precision, Isa isa = bestIsa()) {
    Exec exec;
    exec.precision = precision;
    exec.isa = isa;
    return exec;
}
// The output of a freshly created method, in its output space.
inline Rgb resolveOnce(std::string_view spec, const Frame& frame, const Exec& exec = {}) {
    const auto method = specUnderTest(spec).create({.width = frame.width, .height = frame.height, .isStatic = true});
    Rgb out(frame.width, frame.height);
    method->resolve(frame, exec, out);
    return out;
}
inline Rgb resolveOnce(std::string_view spec, const Rgb& encoded, const Exec& exec = {}) {
    return resolveOnce(spec, frameOf(encoded), exec);
}
inline double largestDifference(const Rgb& a, const Rgb& b) {
    double largest = 0;
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < a.height(); y++)
            for (int x = 0; x < a.width(); x++)
                largest = std::max(largest, double(std::abs(a.c[c].at(x, y) - b.c[c].at(x, y))));
    return largest;
}

}  // namespace aa::testing
