#include "methods/stages/fill.h"

#include <gtest/gtest.h>

#include "image/error.h"
#include "methods/temporal/temporal_test_frames.h"

namespace aa {
namespace {
using namespace testing;

// The left part of the image has no history (its surface comes from outside); the rest moves by 7 px.
TEST(Fill, ExactlyTheRejectedPixelsAreFilled) {
    const int w = 48, h = 24;
    RunningMethod plain = running("unchartedNoSharpen", w, h),
                  filled = running("unchartedNoSharpen+fill=fxaa311", w, h), filler = running("fxaa311", w, h);
    const Picture blocks = [](int x, int y, int c) { return ((x / 5 + y / 3 + c) % 3) * 0.4f; };
    for (int n = 0; n < 3; n++) {
        const Frame f = temporalFrame(n, w, h, [&](int x, int y, int c) { return blocks(x - 7 * n, y, c); }, {7, 0});
        for (auto* m : {&plain, &filled, &filler}) m->resolve(f, {}, {});
        int changed = 0;
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++) {
                const bool rejected = n == 0 || float(x) + 0.5f < 7;
                const float expected = (rejected ? filler : plain).out.c[0].at(x, y);
                ASSERT_EQ(filled.out.c[0].at(x, y), expected) << n << " " << x << "," << y;
                changed += plain.out.c[0].at(x, y) != filler.out.c[0].at(x, y) && rejected;
            }
        EXPECT_GT(changed, 0) << "the test must be able to fail";
    }
}
TEST(Fill, SpacesAreConverted) {
    const int w = 32, h = 16;
    RunningMethod filled = running("accumReject+fill=fxaa311", w, h), filler = running("fxaa311", w, h);
    const Frame f = temporalFrame(0, w, h, [](int x, int, int) { return x < 15 ? 0.1f : 0.8f; });
    filled.resolve(f, {}, {});
    filler.resolve(f, {}, {});
    for (int x = 0; x < w; x++) EXPECT_NEAR(filled.shown().c[0].at(x, 8), filler.shown().c[0].at(x, 8), 1e-6);
}
TEST(Fill, RefusesWhatCannotBeFilled) {
    EXPECT_THROW(running("fxaa311+fill=fxaa311", 8, 8), UsageError);
    EXPECT_THROW(running("uncharted+fill=taaSimplest", 8, 8), UsageError);
    EXPECT_THROW(parseMethod("uncharted+fill=nothing"), UsageError);
}
}  // namespace
}  // namespace aa
