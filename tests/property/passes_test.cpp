// What a method asks for is all that it reads: with frames that hold nothing else its pictures are the same.
#include <gtest/gtest.h>

#include "frames.h"

namespace aa::testing {
namespace {

void leaveOut(const std::vector<PlaneRef>& planes) {
    for (const PlaneRef& p : planes) std::visit([]<class P>(P* plane) { *plane = P(); }, p);
}
// As the reader leaves a frame of which only these passes are wanted.
void keepOnly(PassSet passes, Frame& frame) {
    const auto isLeftOut = [&](const PassInfo& info, const ChannelGroup& group) {
        return !passes.hasAnyOf(info.pass) || !passes.has(group.share);
    };
    for (const PassInfo& info : allPasses()) {
        for (const auto* groups : {&info.groups, &info.shared})
            for (const ChannelGroup& g : *groups) {
                if (!isLeftOut(info, g)) continue;
                if (g.ofFrame) leaveOut(g.ofFrame(frame));
                for (SubSample& s : frame.subSamples)
                    if (g.ofSubSample) leaveOut(g.ofSubSample(s));
                if (info.isList) frame.segments.clear();
            }
    }
    if (!passes.hasAnyOf(Pass::subsamples | Pass::subsampleColor))
        frame.subSamples.clear(), frame.subSamplePositionsPx.clear();
    frame.passes = passes;
}
// "" or in what the pictures or the debug layers differ.
std::string differenceOf(const Subject& a, const Subject& b) {
    if (!a.running.out.samePixels(b.running.out)) return "the picture";
    const std::vector<DebugLayer> of = a.running.method->debugLayers(), other = b.running.method->debugLayers();
    if (of.size() != other.size()) return "the number of debug layers";
    for (size_t i = 0; i < of.size(); i++)
        for (size_t p = 0; p < of[i].planes.size(); p++)
            if (!of[i].planes[p].samePixels(other[i].planes[p])) return "debug layer " + of[i].name;
    return "";
}

TEST(Passes, AMethodReadsOnlyWhatItAsksFor) {
    const int w = 61, h = 37;
    for (const std::string& text : withEveryStage()) {
        Subject whole = makeSubject(text, w, h), asked = makeSubject(text, w, h);
        for (Subject* s : {&whole, &asked}) s->running.method->keepDebugLayers = true;
        const PassSet passes = whole.running.spec.passes();
        for (int n = 1; n <= 3; n++) {
            Frame f = renderFrame(shapes({1.3 * n, 0.4 * n}), w, h, n, halton(n), {1.3, 0.4}, whole.samples);
            step(whole, f);
            keepOnly(passes, f);
            step(asked, f);
            ASSERT_EQ(differenceOf(whole, asked), "") << text << ", frame " << n << ", asks for " << listOf(passes);
        }
    }
}
// A pass that is missed is seen.
TEST(Passes, AMethodThatAsksForTooLittleIsFound) {
    Subject whole = makeSubject("gbaa", 40, 24), asked = makeSubject("gbaa", 40, 24);
    Frame f = renderFrame(shapes(), 40, 24, 1, {0, 0}, {0, 0}, whole.samples);
    step(whole, f);
    for (PlaneF* p : {&f.edgeXPx, &f.edgeYPx}) *p = PlaneF(40, 24, 0.1f);
    step(asked, f);
    EXPECT_EQ(differenceOf(whole, asked), "the picture");
}

}  // namespace
}  // namespace aa::testing
