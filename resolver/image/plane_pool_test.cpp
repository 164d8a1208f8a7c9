#include "image/plane_pool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "image/plane.h"

namespace aa {
namespace {

TEST(PlanePool, APlaneTakesWhatAnotherOfItsSizeGaveBack) {
#ifdef AA_SANITIZED
    GTEST_SKIP() << "without the pool";
#endif
    PlaneF a(1000, 300, 3);
    const float* const memory = a.row(0);
    a = PlaneF();
    const PlaneF other(1000, 301), same(1000, 300);
    EXPECT_NE(other.row(0), memory);
    EXPECT_EQ(same.row(0), memory);
    for (int y = -kBorderY; y < 300 + kBorderY; y++)
        for (int x = -kBorderX; x < 1000 + kBorderX; x++) ASSERT_EQ(same.at(x, y), 0) << "of the plane before";
}

TEST(PlanePool, WhatLiesUnusedIsBounded) {
#ifdef AA_SANITIZED
    GTEST_SKIP() << "without the pool";
#endif
    constexpr size_t kBytes = size_t(40) << 20;
    const size_t before = planeBytes().used;
    std::vector<void*> all;
    for (int i = 0; i < 20; i++) all.push_back(takePlaneMemory(kBytes));
    EXPECT_EQ(planeBytes().used, before + 20 * kBytes);
    for (int i = 0; i < 10; i++) givePlaneMemory(all[size_t(i)], kBytes);
    EXPECT_GE(planeBytes().unused, 10 * kBytes) << "half of what was used, which the next frame takes";
    for (int i = 10; i < 20; i++) {
        givePlaneMemory(all[size_t(i)], kBytes);
        EXPECT_LE(planeBytes().unused, std::max(kUnusedPlaneBytes, planeBytes().used));
    }
    EXPECT_EQ(planeBytes().used, before);
}

TEST(PlanePool, OtherSizesMakeRoom) {
#ifdef AA_SANITIZED
    GTEST_SKIP() << "without the pool";
#endif
    constexpr size_t kBytes = size_t(40) << 20;
    std::vector<void*> small, large;
    for (int i = 0; i < 20; i++) small.push_back(takePlaneMemory(kBytes));
    for (int i = 0; i < 10; i++) givePlaneMemory(small[size_t(i)], kBytes);
    const PlaneBytes before = planeBytes();
    EXPECT_GE(before.unused, 5 * kBytes);
    for (int i = 0; i < 2; i++) {
        large.push_back(takePlaneMemory(2 * kBytes));
        const PlaneBytes now = planeBytes();
        EXPECT_LE(now.used + now.unused, std::max(kUnusedPlaneBytes, now.most));
    }
    EXPECT_EQ(planeBytes().most, before.most);
    for (void* m : large) givePlaneMemory(m, 2 * kBytes);
    for (int i = 10; i < 20; i++) givePlaneMemory(small[size_t(i)], kBytes);
}

}  // namespace
}  // namespace aa
