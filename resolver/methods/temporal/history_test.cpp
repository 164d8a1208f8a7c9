#include "methods/temporal/history.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "image/error.h"
#include "methods/temporal/temporal_test_frames.h"
#include "shot/patterns.h"

namespace aa {
namespace {
using namespace testing;
using ::testing::HasSubstr;

Frame sized(int number, int w, int h, bool reset = false) {
    Frame f;
    f.number = number, f.width = w, f.height = h, f.reset = reset;
    return f;
}
void fill(PlaneF& plane, float value) {
    for (int y = 0; y < plane.height(); y++) std::fill_n(plane.row(y), plane.width(), value);
}
// A frame that writes `value` into all of `kept`.
void writeFrame(History& history, Kept<PlaneF>& kept, const Frame& frame, float value) {
    history.begin(frame, "mine");
    fill(kept.next(), value);
    history.end();
}

TEST(History, FirstFrameIsFreshAndTheNextFindsWhatItWrote) {
    History history;
    Kept<PlaneF> depth{history};
    history.begin(sized(7, 5, 3), "mine");  // without `reset`: there is nothing to continue
    EXPECT_TRUE(history.fresh());
    EXPECT_FALSE(depth.filled());
    EXPECT_EQ(depth.previous().width(), 5);
    EXPECT_EQ(depth.previous().height(), 3);
    EXPECT_EQ(depth.previous().at(4, 2), 0);
    fill(depth.next(), 2);
    EXPECT_EQ(depth.previous().at(4, 2), 0);
    history.end();
    EXPECT_EQ(depth.latest().at(4, 2), 2);
    EXPECT_TRUE(depth.filled());

    history.begin(sized(8, 5, 3), "mine");
    EXPECT_FALSE(history.fresh());
    EXPECT_EQ(history.framesSinceReset(), 1);
    EXPECT_TRUE(depth.filled());
    EXPECT_EQ(depth.age(), 1);
    EXPECT_EQ(depth.previous().at(4, 2), 2);
    EXPECT_NE(&depth.previous(), &depth.next());
}
TEST(History, AnotherSizeIsRefusedAndLeavesTheHistoryAsItWas) {
    History history;
    Kept<PlaneF> depth{history};
    writeFrame(history, depth, sized(1, 5, 3), 2);
    try {
        history.begin(sized(2, 6, 3), "mine");
        FAIL();
    } catch (const InputError& e) {
        EXPECT_STREQ(e.what(),
                     "mine: frame 2 is 6x3, its history is 5x3; set `reset` on the frame where the size changes");
    }
    EXPECT_THROW(history.begin(sized(2, 5, 4), "mine"), InputError);
    history.begin(sized(2, 5, 3), "mine");
    EXPECT_EQ(history.framesSinceReset(), 1);
    EXPECT_EQ(depth.previous().at(4, 2), 2);
}
TEST(History, ResetDropsAndTakesAnotherSize) {
    History history;
    Kept<PlaneF> depth{history};
    for (int n = 0; n < 3; n++) writeFrame(history, depth, sized(n, 5, 3), 2);
    EXPECT_EQ(history.framesSinceReset(), 2);
    history.begin(sized(3, 5, 3, true), "mine");
    EXPECT_TRUE(history.fresh());
    EXPECT_FALSE(depth.filled());
    history.end();  // and this frame wrote nothing
    history.begin(sized(4, 5, 3), "mine");
    EXPECT_FALSE(history.fresh());
    EXPECT_FALSE(depth.filled());
    history.begin(sized(5, 8, 4, true), "mine");
    EXPECT_TRUE(history.fresh());
    EXPECT_EQ(depth.previous().width(), 8);
    EXPECT_EQ(depth.next().height(), 4);
    EXPECT_EQ(depth.previous().at(7, 3), 0);
}
TEST(History, PlanesOfSeveralKindsKeepTheirOwn) {
    History history;
    Kept<PlaneF> depth{history};
    Kept<PlaneU> id{history};
    Kept<RgbaPlane> colour{history};
    Kept<Rgb> velocity{history};
    for (int n = 0; n < 2; n++) {
        history.begin(sized(n, 2, 2), "mine");
        if (n > 0) {
            EXPECT_EQ(depth.previous().at(1, 1), 0.5f);
            EXPECT_EQ(id.previous().at(1, 1), 4000000000u);
            EXPECT_EQ(colour.previous().row(1)[7], 0.25f);  // alpha of the last pixel
            EXPECT_EQ(velocity.previous().c[1].at(1, 1), 3);
        }
        depth.next().at(1, 1) = 0.5f;
        id.next().at(1, 1) = 4000000000u;
        colour.next().row(1)[7] = 0.25f;
        velocity.next().c[1].at(1, 1) = 3;
        history.end();
    }
    EXPECT_EQ(history.bytes(), 2 * (2 * PlaneF(2, 2).bytes() + RgbaPlane(2, 2).bytes() + Rgb(2, 2).bytes()));
}
TEST(History, BordersRepeatTheEdgeOfWhatWasWritten) {
    History history;
    Kept<PlaneF> swapped{history}, written{history};
    history.begin(sized(0, 3, 2), "mine");
    for (PlaneF* plane : {&swapped.next(), &written.inPlace()})
        for (int y = 0; y < 2; y++)
            for (int x = 0; x < 3; x++) plane->at(x, y) = float(1 + x + 10 * y);
    history.end();
    for (const PlaneF* plane : {&swapped.latest(), &written.latest()}) {
        EXPECT_EQ(plane->at(-kBorderX, -kBorderY), 1);
        EXPECT_EQ(plane->at(3, 0), 3);
        EXPECT_EQ(plane->at(2 + kBorderX, 1 + kBorderY), 13);
    }
}
TEST(History, PlanesAreMadeWhenTheyAreAskedFor) {
    History history;
    Kept<PlaneF> unused{history}, single{history}, pair{history};
    const size_t plane = PlaneF(5, 3).bytes();
    history.begin(sized(0, 5, 3), "mine");
    EXPECT_EQ(history.bytes(), 0u);
    single.previous(), single.inPlace();
    EXPECT_EQ(history.bytes(), plane);
    pair.previous(), pair.next();
    history.end();
    EXPECT_EQ(history.bytes(), 3 * plane);
}
TEST(History, OnlyTheSlotThatIsWrittenIsReplaced) {
    History history;
    Kept<PlaneF> buffers{history, 3};
    for (int n = 0; n < 5; n++) {
        const size_t slot = size_t(n % 3);
        history.begin(sized(n, 5, 3), "mine");
        for (size_t i = 0; i < 3; i++) {
            const int writtenIn = n - 1 - (n - 1 - int(i) + 3) % 3;  // the last frame before n with n % 3 == i
            buffers.previous(i);
            ASSERT_EQ(buffers.filled(i), writtenIn >= 0) << n << ' ' << i;
            if (writtenIn < 0) continue;
            EXPECT_EQ(buffers.age(i), n - writtenIn) << n << ' ' << i;
            EXPECT_EQ(buffers.previous(i).at(4, 2), float(writtenIn)) << n << ' ' << i;
        }
        fill(buffers.next(slot), float(n));
        history.end();
        EXPECT_EQ(buffers.latest(slot).at(4, 2), float(n));
    }
    EXPECT_EQ(history.bytes(), 4 * PlaneF(5, 3).bytes());
}
TEST(History, ColourHistoryServesPlanesBesideTheBlend) {
    ColourHistory history;
    Kept<PlaneF> count{history};
    const Frame first = sized(0, 5, 3), second = sized(1, 5, 3);
    TemporalIn in;
    history.begin(first, "mine", in);
    EXPECT_EQ(in.history, nullptr);
    in.next[4] = 0.75f;  // red of pixel (1, 0)
    fill(count.next(), 1);
    history.end({}, {});
    EXPECT_EQ(history.latest().at(1, 0), 0.75f);
    history.begin(second, "mine", in);
    ASSERT_NE(in.history, nullptr);
    EXPECT_EQ(in.history[4], 0.75f);
    EXPECT_EQ(count.previous().at(0, 0), 1);
    count.next();
    EXPECT_EQ(history.bytes(), 2 * (RgbaPlane(5, 3).bytes() + PlaneF(5, 3).bytes()));
}
TEST(History, EveryMethodRefusesAnotherSizeWithoutReset) {
    for (const auto& method : registry()) {
        if (method.family != "temporal") continue;
        SCOPED_TRACE(method.id);
        const auto positionsPx = patternPositionsPx(method.id == "smaa4x" ? "d3d4" : "d3d2");
        RunningMethod m(parseMethod(method.id), {.width = 20,
                                                 .height = 20,
                                                 .jitterPeriod = 16,
                                                 .isStatic = false,
                                                 .frameCount = 16,
                                                 .subSamplePositionsPx = positionsPx});
        const auto resolve = [&](int n, int w, bool reset) {
            Frame f = temporalFrame(n, w, 20, noisePicture(1));
            f.reset = reset;
            f.subSamplePositionsPx = positionsPx;
            f.subSamples.assign(positionsPx.size(), {f.depthView, Rgb(w, 20), f.objectId, f.colorLinear});
            m.resolve(f, {}, {});
        };
        resolve(0, 20, true);
        try {
            resolve(1, 24, false);
            ADD_FAILURE() << "accepted";
        } catch (const InputError& e) {
            EXPECT_THAT(e.what(), HasSubstr(": frame 1 is 24x20, its history is 20x20; set `reset`"));
        }
        EXPECT_NO_THROW(resolve(1, 20, false));
        EXPECT_NO_THROW(resolve(2, 24, true));
    }
}
}  // namespace
}  // namespace aa
