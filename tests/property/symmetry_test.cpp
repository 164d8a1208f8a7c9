// Mirror and quarter-turn symmetry of the methods that read one image. A method that lacks it says so in its
// descriptor.
#include <gtest/gtest.h>

#include <random>

#include "frames.h"
#include "methods/asymmetry.h"
#include "methods/methods_under_test.h"

namespace aa::testing {
namespace {

std::vector<std::string> imageMethods() {
    std::vector<std::string> ids;
    for (const auto& m : methodsUnderTest())
        if (m.family == "spatial" && specUnderTest(m.id).passes() == PassSet(Pass::color)) ids.emplace_back(m.id);
    return ids;
}
constexpr int kSize = 96;
// Discs, bars and triangles of random colours and sub-pixel places.
Rgb picture(unsigned seed) {
    std::mt19937 random(seed);
    const auto uniform = [&](double lo, double hi) { return lo + (hi - lo) * (random() * (1.0 / 4294967296.0)); };
    Rgb image(kSize, kSize, 0.3f);
    for (int k = 0; k < 22; k++) {
        const double cx = uniform(0, kSize), cy = uniform(0, kSize), a = uniform(0, 6.2831853), size = uniform(3, 26);
        const int kind = int(uniform(0, 3));
        float colour[3];
        for (float& c : colour) c = float(uniform(0, 1));
        for (int y = 0; y < kSize; y++)
            for (int x = 0; x < kSize; x++) {
                const double dx = x + 0.5 - cx, dy = y + 0.5 - cy, n = dx * std::cos(a) + dy * std::sin(a),
                             t = dy * std::cos(a) - dx * std::sin(a);
                const bool inside = kind == 0   ? std::hypot(dx, dy) < size / 2
                                    : kind == 1 ? std::abs(n) < 0.9 && std::abs(t) < size
                                                : n > 0 && n < size && std::abs(t) < n / 2;
                for (size_t c = 0; inside && c < 3; c++) image.c[c].at(x, y) = colour[c];
            }
    }
    return image;
}
Rgb mirrored(const Rgb& image) {
    Rgb r(kSize, kSize);
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < kSize; y++)
            for (int x = 0; x < kSize; x++) r.c[c].at(kSize - 1 - x, y) = image.c[c].at(x, y);
    return r;
}
Rgb turned(const Rgb& image) {
    Rgb r(kSize, kSize);
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < kSize; y++)
            for (int x = 0; x < kSize; x++) r.c[c].at(y, kSize - 1 - x) = image.c[c].at(x, y);
    return r;
}
Rgb filtered(const std::string& id, const Rgb& encoded) {
    Subject s = makeSubject(id, kSize, kSize);
    Frame f;
    f.width = f.height = kSize;
    f.reset = true;
    f.passes = Pass::color;
    f.colorEncoded = encoded;
    f.colorEncoded.fillBorder();
    decode(f.colorEncoded, {}, {}, f.colorLinear);
    s.running.resolve(f, {}, {});
    return s.running.shown();
}
// Share of pixels of the pictures that end otherwise when the picture is transformed first.
double asymmetry(const std::string& id, Rgb (*transform)(const Rgb&)) {
    double far = 0, all = 0;
    for (unsigned seed = 1; seed <= 6; seed++) {
        const Rgb image = picture(seed);
        const Rgb a = transform(filtered(id, image)), b = filtered(id, transform(image));
        for (int y = 0; y < kSize; y++)
            for (int x = 0; x < kSize; x++, all++) far += std::abs(a.c[1].at(x, y) - b.c[1].at(x, y)) > 1e-4f;
    }
    return far / all;
}

class Symmetry : public ::testing::TestWithParam<std::string> {};

TEST_P(Symmetry, HoldsWhereNoAsymmetryIsStated) {
    const double mirror = asymmetry(GetParam(), mirrored), turn = asymmetry(GetParam(), turned);
    RecordProperty("mirror", std::to_string(mirror));
    RecordProperty("turn", std::to_string(turn));
    std::printf("  %s: mirrored %.4f %%, turned %.4f %% of the pixels differ\n", GetParam().c_str(), 100 * mirror,
                100 * turn);
    if (knownAsymmetry(GetParam()).empty()) {
        const std::string what = " picture gives another result: mend the order of sums and ties in " +
                                 fileOf(GetParam()) + " and its kernel, or say in resolver/methods/asymmetry.cpp why";
        EXPECT_EQ(mirror, 0) << "a mirrored" << what;
        EXPECT_EQ(turn, 0) << "a turned" << what;
    } else {
        EXPECT_GT(mirror + turn, 0) << "the asymmetry stated in resolver/methods/asymmetry.cpp is gone";
        EXPECT_LT(mirror + turn, 0.25);
    }
}
INSTANTIATE_TEST_SUITE_P(Methods, Symmetry, ::testing::ValuesIn(imageMethods()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace aa::testing
