#include "study/machine_load.h"

#include <gtest/gtest.h>

#include <sstream>

namespace aa {
namespace {

TEST(MachineLoad, ReadsWhatTheSystemCounts) {
    // Idle and waiting for a disk is not busy; a guest's time is in the user's already.
    std::istringstream stat(
        "cpu  100 20 30 9000 500 4 6 40 70 0\ncpu0 1 1 1 1 1 1 1 1\ncpu1 1 1 1 1 1 1 1 1\nintr 5\n");
    const auto found = busySeconds(stat, 100);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->processors, 2);
    EXPECT_DOUBLE_EQ(found->busy, 2.0);
    std::istringstream other("no processors here\n"), shortLine("cpu 1 2 3\ncpu0 1 2 3\n");
    EXPECT_FALSE(busySeconds(other, 100));
    EXPECT_FALSE(busySeconds(shortLine, 100));
}

TEST(MachineLoad, SaysNothingOfAMoment) { EXPECT_FALSE(LoadWatch().sofar()); }

TEST(MachineLoad, ATenthOfTheMachineDisturbs) {
    EXPECT_FALSE((OtherPrograms{.processors = 8, .busy = 0.7}).disturb());
    EXPECT_TRUE((OtherPrograms{.processors = 2, .busy = 0.7}).disturb());
}

}  // namespace
}  // namespace aa
