#include "image/plane_pool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <new>
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

// Linux moves pages: it need not clear others for a plane of another size.
TEST(PlanePool, OtherSizesGiveTheirPages) {
#if defined(AA_SANITIZED) || !defined(__linux__)
    GTEST_SKIP() << "without the pool, or without a system that moves pages";
#endif
    constexpr size_t kLarge = size_t(101) << 18, kSmall = size_t(26) << 18;
    EXPECT_THROW(takePlaneMemory(size_t(1) << 50), std::bad_alloc);  // after which nothing lies unused
    void* const all = takePlaneMemory(kLarge);
    std::fill_n(static_cast<unsigned char*>(all), kLarge, 7);
    givePlaneMemory(all, kLarge);
    const auto sevens = [](void* m, size_t bytes) {
        const auto* c = static_cast<unsigned char*>(m);
        return size_t(std::count(c, c + bytes, 7));
    };
    std::vector<void*> parts;
    for (int turn = 0; turn < 3; turn++) {  // apart, and together once more
        for (int i = 0; i < 4; i++) parts.push_back(takePlaneMemory(kSmall));
        for (void* p : parts) {
            EXPECT_GT(sevens(p, kSmall), kSmall * 9 / 10) << "pages of 2 MB, but for the rest of 0.5 MB";
            std::fill_n(static_cast<unsigned char*>(p), kSmall, 7);
            givePlaneMemory(p, kSmall);
        }
        parts.clear();
        void* const whole = takePlaneMemory(kLarge);
        EXPECT_GT(sevens(whole, kLarge), kLarge * 9 / 10);
        std::fill_n(static_cast<unsigned char*>(whole), kLarge, 7);
        givePlaneMemory(whole, kLarge);
    }
}

TEST(PlanePool, MemoryThatThereIsNotIsNotCounted) {
#ifdef AA_SANITIZED
    GTEST_SKIP() << "without the pool";
#endif
    const PlaneBytes before = planeBytes();
    EXPECT_THROW(takePlaneMemory(size_t(1) << 50), std::bad_alloc);
    EXPECT_EQ(planeBytes().used, before.used);
    EXPECT_EQ(planeBytes().most, before.most) << "or what lies unused would never be bounded again";
    EXPECT_EQ(planeBytes().unused, 0) << "it may be what the next one lacks";
}

}  // namespace
}  // namespace aa
