#include "methods/reference/accum.h"

#include <gtest/gtest.h>

#include "image/colour.h"
#include "image/error.h"
#include "methods/temporal/temporal_test_frames.h"

namespace aa {
namespace {
using namespace testing;

// The mean of the first `samples` frames in linear light, exact in double, and nothing after them.
TEST(Accum, MeanOfTheFirstFrames) {
    for (const int samples : {1, 5, 16}) {
        RunningMethod m = running("accum:samples=" + std::to_string(samples), 9, 7, true);
        Rgb last;
        for (int n = 0; n < 20; n++) {
            m.resolve(temporalFrame(n, 9, 7, noisePicture(unsigned(n))), {}, {});
            const int count = std::min(n + 1, samples);
            for (size_t c = 0; c < 3; c++)
                for (int y = 0; y < 7; y++)
                    for (int x = 0; x < 9; x++) {
                        double mean = 0;
                        for (int k = 0; k < count; k++) mean += double(noisePicture(unsigned(k))(x, y, int(c))) / count;
                        ASSERT_FLOAT_EQ(m.out.c[c].at(x, y), float(mean)) << samples << " frame " << n;
                    }
        }
    }
}
// A firefly counts in full, in any frame; and a reset forgets everything.
TEST(Accum, FirefliesAndResets) {
    RunningMethod m = running("accum", 3, 2, true);
    for (int n = 0; n < 128; n++)
        m.resolve(temporalFrame(n, 3, 2, [n](int, int, int) { return n == 77 ? 1e6f : 0.0f; }), {}, {});
    EXPECT_EQ(m.out.c[1].at(1, 1), 7812.5f);
    const Frame cut = temporalFrame(0, 3, 2, noisePicture(4));
    m.resolve(cut, {}, {});
    EXPECT_TRUE(m.out.samePixels(cut.colorLinear));
}
// Light of 1 and 0.25 in turn: display values 1 and 0.5371.
TEST(Accum, EncodedAveragesDisplayValues) {
    RunningMethod encoded = running("accum:space=encoded", 3, 2, true);
    for (int n = 0; n < 8; n++) {
        Frame f = temporalFrame(n, 3, 2, [n](int, int, int) { return n % 2 ? 1.0f : 0.25f; });
        encode(f.colorLinear, {}, {}, f.colorEncoded);
        encoded.resolve(f, {}, {});
    }
    EXPECT_NEAR(encoded.out.c[0].at(1, 1), (1 + 0.5370987) / 2, 1e-6);
}
TEST(Accum, MovingShotsAreInputErrors) { EXPECT_THROW(running("accum", 8, 8, false), InputError); }

}  // namespace
}  // namespace aa
