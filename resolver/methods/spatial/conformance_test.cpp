// FXAA and SMAA against references written without the kernels, on seeded images of several kinds that nothing was
// tuned on: at most 1 code of 255 apart, encoded, outside the ties of decisions 37.
#include <gtest/gtest.h>

#include <cmath>

#include "methods/spatial/fxaa_reference.h"
#include "methods/spatial/smaa_reference.h"
#include "methods/spatial/spatial_testing.h"
#include "shot/synth/synth.h"

namespace aa {
namespace {
using namespace aa::testing;

struct Picture {
    std::string kind;
    Rgb image;  // encoded
};
double uniform(std::mt19937& random) { return random() * (1.0 / 4294967296.0); }

Rgb randomValues(int width, int height, unsigned seed) {  // not of 8 bits: no exact ties
    std::mt19937 random(seed);
    Rgb image(width, height);
    for (auto& p : image.c)
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) p.at(x, y) = float(uniform(random));
    return image;
}
// Rows of dot-matrix glyphs, 5 x 7 dots of 1 or 2 px, in dark ink on paper that shades off.
Rgb textLike(int width, int height, unsigned seed) {
    std::mt19937 random(seed);
    Rgb image(width, height);
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++)
                image.c[c].at(x, y) = float(0.8 + 0.15 * std::sin(0.013 * x + 0.02 * y + double(c)));
    const int dot = 1 + int(seed % 2);
    for (int top = 2; top + 7 * dot < height; top += 10 * dot)
        for (int left = 2; left + 5 * dot < width; left += 7 * dot) {
            const double ink = 0.4 * uniform(random);
            for (int j = 0; j < 7; j++)
                for (int i = 0; i < 5; i++) {
                    if (random() % 2) continue;
                    for (int y = top + j * dot; y < top + (j + 1) * dot; y++)
                        for (int x = left + i * dot; x < left + (i + 1) * dot; x++)
                            for (size_t c = 0; c < 3; c++) image.c[c].at(x, y) = float(ink * (0.8 + 0.1 * double(c)));
                }
        }
    return image;
}
// Smooth ramps of all directions, cut by a few shallow steps.
Rgb gradients(int width, int height, unsigned seed) {
    std::mt19937 random(seed);
    Rgb image(width, height);
    double a[3], b[3], cut[4], slope[4], size[4];
    for (int c = 0; c < 3; c++) a[c] = uniform(random) * 0.06 - 0.03, b[c] = uniform(random) * 0.06 - 0.03;
    for (int k = 0; k < 4; k++)
        cut[k] = height * uniform(random), slope[k] = uniform(random) - 0.5, size[k] = 0.3 * uniform(random) - 0.15;
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) {
                double v = 0.5 + a[c] * (x - width / 2.0) * 0.3 + b[c] * (y - height / 2.0) * 0.3;
                for (int k = 0; k < 4; k++) v += y + slope[k] * x > cut[k] ? size[k] * (1 + 0.2 * double(c)) : 0;
                image.c[c].at(x, y) = float(std::clamp(v, 0.0, 1.0));
            }
    return image;
}
Rgb synthetic(const std::string& scene, unsigned seed) {
    SynthOptions o;
    o.scene = scene, o.width = 112, o.height = 80, o.frames = 1, o.jitter = "none", o.seed = seed;
    Rgb encoded;
    encode(SynthShot(o).frame(0).colorLinear, {}, {}, encoded);
    return encoded;
}
const std::vector<Picture>& pictures() {
    static const std::vector<Picture> all = [] {
        std::vector<Picture> p;
        for (unsigned seed = 101; seed < 105; seed++) {
            p.push_back({"noise", seed % 2 ? randomCodes(61, 47, seed) : randomValues(61, 47, seed)});
            p.push_back({"polygons", randomShapes(113, 71, seed)});
            p.push_back({"text", textLike(97, 62, seed)});
            p.push_back({"gradients", gradients(90, 81, seed)});
        }
        for (const char* scene : {"half_planes", "circles", "thin_lines", "moving", "clutter"})
            p.push_back({"synth", synthetic(scene, 7)});
        for (auto& picture : p) picture.image.fillBorder();
        return p;
    }();
    return all;
}
int code(double v) { return int(std::floor(255 * std::clamp(v, 0.0, 1.0) + 0.5)); }
int largestCodeDifference(const Rgb& out, int x, int y, const std::array<double, 3>& expected) {
    int worst = 0;
    for (size_t c = 0; c < 3; c++)
        worst = std::max(worst, std::abs(code(double(out.c[c].at(x, y))) - code(expected[c])));
    return worst;
}

struct Counts {
    size_t pixels = 0, changed = 0, ties = 0;
    int worst = 0;
    void add(const Picture& p, const Rgb& out, int x, int y, const std::array<double, 3>& expected, bool tie) {
        pixels++;
        changed += out.c[1].at(x, y) != p.image.c[1].at(x, y);
        ties += tie;
        if (!tie) worst = std::max(worst, largestCodeDifference(out, x, y, expected));
    }
};
template <class Reference>
void compare(const std::string& spec, const Picture& p, Reference&& reference) {
    const Rgb out = resolveOnce(spec, p.image);
    Counts n;
    for (int y = 0; y < p.image.height(); y++)
        for (int x = 0; x < p.image.width(); x++) {
            const auto expected = reference.pixel(x, y);
            n.add(p, out, x, y, expected, reference.lastWasNearTie());
        }
    EXPECT_LE(n.worst, 1) << spec << " on " << p.kind;
    if (p.kind != "gradients") {
        EXPECT_GT(n.changed, 100u) << spec << " on " << p.kind;
    }
    EXPECT_LT(double(n.ties), 0.05 * double(n.pixels)) << spec << " on " << p.kind;
}

// Cumulative distances of the search patterns [Lottes 2011].
const std::pair<const char*, std::vector<double>> kDistances311[] = {
    {"10", {1.5, 4.5, 16.5}},
    {"11", {1, 2.5, 5.5, 17.5}},
    {"12", {1, 2.5, 4.5, 8.5, 20.5}},
    {"13", {1, 2.5, 4.5, 6.5, 10.5, 22.5}},
    {"14", {1, 2.5, 4.5, 6.5, 8.5, 12.5, 24.5}},
    {"15", {1, 2.5, 4.5, 6.5, 8.5, 10.5, 14.5, 26.5}},
    {"20", {1.5, 3.5, 11.5}},
    {"21", {1, 2.5, 4.5, 12.5}},
    {"22", {1, 2.5, 4.5, 6.5, 14.5}},
    {"23", {1, 2.5, 4.5, 6.5, 8.5, 16.5}},
    {"24", {1, 2.5, 4.5, 6.5, 8.5, 11.5, 19.5}},
    {"25", {1, 2.5, 4.5, 6.5, 8.5, 10.5, 14.5, 22.5}},
    {"26", {1, 2.5, 4.5, 6.5, 8.5, 10.5, 12.5, 16.5, 24.5}},
    {"27", {1, 2.5, 4.5, 6.5, 8.5, 10.5, 12.5, 14.5, 18.5, 26.5}},
    {"28", {1, 2.5, 4.5, 6.5, 8.5, 10.5, 12.5, 14.5, 16.5, 20.5, 28.5}},
    {"29", {1, 2.5, 4.5, 6.5, 8.5, 10.5, 12.5, 14.5, 16.5, 18.5, 22.5, 30.5}},
    {"39", {1, 2, 3, 4, 5, 6.5, 8.5, 10.5, 12.5, 14.5, 18.5, 26.5}},
};
TEST(Conformance, Fxaa311EveryPreset) {
    for (const auto& [preset, distances] : kDistances311) {
        std::vector<double> steps;
        for (size_t k = 0; k < distances.size(); k++) steps.push_back(distances[k] - (k ? distances[k - 1] : 0));
        for (const auto& p : pictures())
            compare(std::string("fxaa311:preset=") + preset, p, Reference311(p.image, steps, 0.75, 0.166, 0.0833));
    }
}
TEST(Conformance, Fxaa1EveryPreset) {
    for (int preset = 0; preset <= 5; preset++)
        for (const auto& p : pictures())
            compare("fxaa1:preset=" + std::to_string(preset), p, ReferenceFxaa1(p.image, preset));
}
TEST(Conformance, FxaaCsBothPresets) {
    for (const auto& p : pictures()) {
        const Frame f = frameOf(p.image);
        const std::vector<double> d25 = {1, 2.5, 4.5, 6.5, 8.5, 10.5, 14.5, 22.5},
                                  d39 = {1, 2, 3, 4, 5, 6.5, 8.5, 10.5, 12.5, 14.5, 18.5, 26.5};
        compare("fxaacs:blendSpace=encoded", p, ReferenceFxaaCs(f.colorLinear, p.image, d25));
        compare("fxaacs:blendSpace=encoded,preset=39", p, ReferenceFxaaCs(f.colorLinear, p.image, d39));
        auto longer = d39;
        longer.back() = 36.5;
        compare("fxaacs:blendSpace=encoded,preset=39,longest=36.5", p, ReferenceFxaaCs(f.colorLinear, p.image, longer));
    }
}

// An edge within 1e-6 of a threshold may be decided otherwise in float, and moves the ends of lines far away: such
// pictures are left out, and enough of every kind must remain.
TEST(Conformance, Smaa1xEveryPresetAndBothWeights) {
    struct Preset {
        const char* spec;
        double threshold;
        int steps, diagonal;
        double rounding;
        bool colour;
    };
    for (const Preset& preset : {Preset{"preset=LOW", .15, 4, 0, -1, false},
                                 {"preset=MEDIUM", .1, 8, 0, -1, false},
                                 {"preset=HIGH", .1, 16, 8, .25, false},
                                 {"preset=ULTRA", .05, 32, 16, .25, false},
                                 {"preset=ULTRA,edges=colour", .05, 32, 16, .25, true}})
        for (const bool unorm8 : {false, true}) {
            std::map<std::string, int> compared;
            for (const auto& p : pictures()) {
                const ReferenceSmaa reference(p.image, preset.threshold, preset.steps, preset.diagonal, preset.rounding,
                                              preset.colour, unorm8);
                if (reference.nearTies > 0) continue;
                compared[p.kind]++;
                const std::string spec =
                    std::string("smaa1x:blendSpace=encoded,") + preset.spec + (unorm8 ? ",weights=unorm8" : "");
                const Rgb out = resolveOnce(spec, p.image);
                Counts n;
                for (int y = 0; y < p.image.height(); y++)
                    for (int x = 0; x < p.image.width(); x++) n.add(p, out, x, y, reference.pixel(x, y), false);
                EXPECT_LE(n.worst, 1) << spec << " on " << p.kind;
                if (p.kind != "gradients") {
                    EXPECT_GT(n.changed, 100u) << spec << " on " << p.kind;
                }
            }
            for (const char* kind : {"polygons", "text", "gradients", "synth"})
                EXPECT_GE(compared[kind], 2) << preset.spec << " " << kind;
            EXPECT_GE(compared["noise"], 1) << preset.spec;
        }
}
// The comparison can fail: the neighbouring preset is farther away than one code.
TEST(Conformance, WrongPresetIsSeen) {
    int worst = 0;
    for (const auto& p : pictures()) {
        const Rgb out = resolveOnce("fxaa311:preset=23", p.image);
        Reference311 reference(p.image, {1, 1.5, 2, 2, 2, 3, 8}, 0.75, 0.166, 0.0833);
        for (int y = 0; y < p.image.height(); y++)
            for (int x = 0; x < p.image.width(); x++) {
                const auto expected = reference.pixel(x, y);
                if (!reference.lastWasNearTie()) worst = std::max(worst, largestCodeDifference(out, x, y, expected));
            }
    }
    EXPECT_GT(worst, 1);
}

}  // namespace
}  // namespace aa
