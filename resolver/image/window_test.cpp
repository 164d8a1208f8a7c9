#include "image/window.h"

#include <gtest/gtest.h>

#include "image/error.h"

namespace aa {
namespace {

std::string complaint(const std::string& text) {
    try {
        windowFrom(text, "--region", "the shot", 48, 32);
    } catch (const UsageError& e) {
        return e.what();
    }
    return "";
}

TEST(Window, IsReadWithinAPicture) {
    EXPECT_EQ(windowFrom("0,0,48,32", "--region", "the shot", 48, 32), (Window{0, 0, 48, 32}));
    EXPECT_EQ(windowFrom("47,31,1,1", "--region", "the shot", 48, 32), (Window{47, 31, 1, 1}));
    EXPECT_EQ(inWords(Window{3, 4, 10, 20}), "10 x 20 px at 3, 4");
}
TEST(Window, WhatIsNotWithinOrNoneSaysWhatThePictureHas) {
    for (const char* text : {"40,0,9,4", "0,30,4,3", "-1,0,4,4", "0,-1,4,4", "0,0,2147483647,1", "2147483647,0,4,4"})
        EXPECT_NE(complaint(text).find("not all within the picture; the shot has 48 x 32 px"), std::string::npos)
            << text;
    for (const char* text : {"0,0,0,4", "0,0,4,-3"})
        EXPECT_NE(complaint(text).find("empty; the shot has 48 x 32 px"), std::string::npos) << text;
    for (const char* text : {"", "1,2,3", "1,2,3,4,5", "a,2,3,4", "1,2,3,4px"})
        EXPECT_NE(complaint(text).find("expected X,Y,WIDTH,HEIGHT"), std::string::npos) << text;
}
TEST(Window, ACropHoldsItsPixelsAndRepeatsThemBeside) {
    Rgb image(5, 4);
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < 4; y++)
            for (int x = 0; x < 5; x++) image.c[c].at(x, y) = float(100 * int(c) + 10 * y + x);
    const Rgb crop = cropped(image, {1, 2, 3, 2});
    EXPECT_EQ(crop.width(), 3);
    EXPECT_EQ(crop.height(), 2);
    EXPECT_EQ(crop.c[2].at(0, 0), 221);
    EXPECT_EQ(crop.c[1].at(2, 1), 133);
    EXPECT_EQ(crop.c[0].at(-1, -1), 21) << "not its neighbour in the picture";
}

}  // namespace
}  // namespace aa
