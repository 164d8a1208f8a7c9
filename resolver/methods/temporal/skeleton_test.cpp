// What the property tests (tests/property) cannot know: the method's own definition. They run over the skeletons, too.
#include "methods/temporal/skeleton.h"

#include <gtest/gtest.h>

#include "methods/temporal/temporal_test_frames.h"

namespace aa {
namespace {
using namespace testing;

// A flat picture beside which a brighter and a darker pixel open the clamp's box.
Picture temporalSkeletonPicture(float value) {
    return [value](int x, int y, int) { return (x + y) % 2 ? value : x % 4 < 2 ? 0.0f : 1.0f; };
}
float temporalSkeletonCount(const RunningMethod& m, int x, int y) {
    for (const auto& layer : m.method->debugLayers())
        if (layer.name == "sampleCount") return layer.planes[0].at(x, y);
    return -1;
}

TEST(TemporalSkeleton, RestIsARunningMeanAndThenExponential) {
    RunningMethod m = running("temporalSkeleton:mostSamples=4", 16, 8, true);
    m.method->keepDebugLayers = true;
    double expected = 0;
    for (int n = 0; n < 8; n++) {
        const float value = 0.3f + 0.05f * float(n % 3);
        m.resolve(temporalFrame(n, 16, 8, temporalSkeletonPicture(value)), {}, {});
        expected += (double(value) - expected) / std::min(n + 1, 4);
        EXPECT_NEAR(m.out.c[0].at(6, 3), expected, 1e-6) << "frame " << n;
        EXPECT_EQ(temporalSkeletonCount(m, 6, 3), float(std::min(n + 1, 4))) << "frame " << n;
    }
}
// The count travels with the surface; what enters the picture starts at 1. The wrong sign of motion fails here.
TEST(TemporalSkeleton, CountsFollowTheMotion) {
    RunningMethod m = running("temporalSkeleton", 16, 8);
    m.method->keepDebugLayers = true;
    for (int n = 0; n < 3; n++) m.resolve(temporalFrame(n, 16, 8, noisePicture(1), {n ? 2.0 : 0.0, 0}), {}, {});
    EXPECT_EQ(temporalSkeletonCount(m, 0, 4), 1);  // entered in this frame
    EXPECT_EQ(temporalSkeletonCount(m, 2, 4), 2);  // in the last one
    EXPECT_EQ(temporalSkeletonCount(m, 9, 4), 3);
}
TEST(TemporalSkeleton, HistoryOutsideTheNeighbourhoodIsClamped) {
    RunningMethod m = running("temporalSkeleton", 16, 8);
    m.resolve(temporalFrame(0, 16, 8, [](int, int, int) { return 1.0f; }), {}, {});
    m.resolve(temporalFrame(1, 16, 8, [](int, int, int) { return 0.25f; }), {}, {});
    EXPECT_EQ(m.out.c[0].at(6, 3), 0.25f);
}
// A reset forgets both histories: the count, too.
TEST(TemporalSkeleton, ResetStartsTheCountAfresh) {
    RunningMethod m = running("temporalSkeleton", 16, 8);
    m.method->keepDebugLayers = true;
    for (int n = 0; n < 4; n++) m.resolve(temporalFrame(n % 3, 16, 8, noisePicture(2)), {}, {});
    EXPECT_EQ(temporalSkeletonCount(m, 6, 3), 1);
}

}  // namespace
}  // namespace aa
