#include <gtest/gtest.h>

#include <cmath>

#include "image/colour.h"
#include "methods/spatial/smaa.h"
#include "methods/spatial/spatial_testing.h"

namespace aa {
namespace {
using namespace aa::testing;

constexpr int kLevels = 240;

// Shown values with steps of about `step` at many levels, sideways and downwards.
PlaneF stepsAtManyLevels(float step, unsigned seed) {
    std::mt19937 random(seed);
    PlaneF shown(61, kLevels);
    for (int y = 0; y < kLevels; y++)
        for (int x = 0; x < shown.width(); x++) {
            const float about = step * (0.97f + 0.06f * float(random() >> 24) / 255.0f);
            shown.at(x, y) = 0.8f * float(y / 6) / (kLevels / 6) + ((x / 3 + y / 3) % 2 ? about : 0.0f);
        }
    return shown;
}
// Its linear colours, which `chain` shows as `shown`; an object every 6 px.
Frame frameShown(const PlaneF& shown, const DisplayChain& chain) {
    Rgb grey;
    for (auto& plane : grey.c) plane = shown;
    Frame frame = frameOf(grey);
    frame.display = chain;
    frame.objectId = PlaneU(frame.width, frame.height);
    for (int y = 0; y < frame.height; y++)
        for (int x = 0; x < frame.width; x++) {
            frame.objectId.at(x, y) = uint32_t(x / 6);
            for (auto& plane : frame.colorLinear.c) {
                float& c = plane.at(x, y);
                if (chain.toneMap == ToneMap::reinhard) c /= 1.0f - c;
                c /= std::exp2(chain.exposure);
            }
        }
    frame.objectId.fillBorder();
    frame.colorLinear.fillBorder();
    return frame;
}
struct EdgesAndResult {
    DebugLayer edges;
    Rgb out;
};
EdgesAndResult blended(Smaa& smaa, const Frame& frame, const Rgb& shown) {
    EdgesAndResult r{{}, Rgb(frame.width, frame.height)};
    const Rgb* const images[] = {&shown};
    smaa.blend(images, r.out, {});
    r.edges = smaa.debugLayers()[0];
    return r;
}

// Lumas of linear colours are computed where rough ones leave room for an edge: none may be missed.
TEST(SmaaEdges, OfLinearColoursAreThoseOfWhatIsShown) {
    for (const std::string threshold : {"0.001", "0.03", "0.1", "0.2"})
        for (const std::string predication : {"", ",predication=object"})
            for (const DisplayChain& chain : {DisplayChain{}, DisplayChain{1.5f, ToneMap::reinhard}}) {
                const std::string text = "smaa1x:preset=custom,searchSteps=4,threshold=" + threshold + predication;
                const Params p = specUnderTest(text).params();
                const float step = std::stof(threshold) * (predication.empty() ? 1.0f : 2.0f * (1 - 0.4f));
                const Frame frame = frameShown(stepsAtManyLevels(step, 5), chain);
                Rgb shown;
                encode(frame.colorLinear, chain, {}, shown);
                Smaa ofLinear(p), ofShown(p);
                ofLinear.keepDebugLayers = ofShown.keepDebugLayers = true;
                ofLinear.findEdgesOfLinear(frame, frame.colorLinear, {0, 0}, {});
                ofShown.findEdges(frame, shown, {0, 0}, {});
                const EdgesAndResult found = blended(ofLinear, frame, shown), wanted = blended(ofShown, frame, shown);
                size_t edges = 0;
                for (int y = 0; y < frame.height; y++)
                    for (int x = 0; x < frame.width; x++) edges += wanted.edges.planes[0].at(x, y) > 0;
                EXPECT_GT(edges, 300u) << text;
                for (size_t c = 0; c < 2; c++)
                    EXPECT_TRUE(found.edges.planes[c].samePixels(wanted.edges.planes[c])) << text;
                EXPECT_TRUE(found.out.samePixels(wanted.out)) << text;
            }
}

}  // namespace
}  // namespace aa
