#include "report/canvas.h"

#include <gtest/gtest.h>

#include "image/io.h"

namespace aa {
namespace {
constexpr Colour kBlack{0, 0, 0}, kWhite{1, 1, 1}, kRed{1, 0, 0};

Rgb drawn(const std::function<void(Canvas&)>& draw, int width = 60, int height = 40) {
    Canvas canvas(width, height, kBlack);
    draw(canvas);
    const auto file = std::filesystem::path(testing::TempDir()) / "aaresolve_canvas.png";
    canvas.writePng(file);
    Rgb image = readImage(file).rgb;
    std::filesystem::remove(file);
    return image;
}
int lit(const Rgb& image) {
    int count = 0;
    for (int y = 0; y < image.height(); y++)
        for (int x = 0; x < image.width(); x++) count += image.c[0].at(x, y) > 0;
    return count;
}

TEST(Canvas, RectanglesAndPicturesAreClipped) {
    EXPECT_EQ(lit(drawn([](Canvas& c) { c.fill({-5, 3, 10, 4}, kWhite); })), 5 * 4);
    EXPECT_EQ(lit(drawn([](Canvas& c) { c.frame({10, 10, 6, 4}, kWhite, 2); })), 10 * 8 - 6 * 4);
    Rgb picture(2, 2, 0.5f);
    const Rgb image = drawn([&](Canvas& c) { c.draw(picture, 57, 38, 3); });
    EXPECT_EQ(lit(image), 3 * 2);
    EXPECT_FLOAT_EQ(image.c[0].at(57, 38), 128 / 255.0f);
}
TEST(Canvas, TextStandsOnItsBaselineInItsColour) {
    const Rgb image = drawn([](Canvas& c) { c.text(5, 30, "HI", 20, kRed); });
    int last = 0, greatest = 0;
    for (int y = 0; y < image.height(); y++)
        for (int x = 0; x < image.width(); x++)
            if (image.c[0].at(x, y) > 0.5f) last = y, greatest = std::max(greatest, x);
    EXPECT_EQ(last, 29);
    EXPECT_LT(greatest, 30);
    EXPECT_GT(lit(image), 20);
    EXPECT_EQ(image.c[1].at(greatest, last), 0);
    EXPECT_EQ(lit(drawn([](Canvas& c) { c.text(500, 30, "HI", 20, kRed); })), 0);
}
TEST(Canvas, TextIsUtf8) {
    const Canvas canvas(8, 8, kBlack);
    const int e = canvas.textWidth("eeee", 16);
    EXPECT_EQ(canvas.textWidth("\u00e9\u00e9\u00e9\u00e9", 16), e);           // two bytes each
    EXPECT_GT(canvas.textWidth("\u2264\u2264\u2264\u2264", 16), e);           // three
    EXPECT_EQ(canvas.textWidth("\xff", 16), canvas.textWidth("\ufffd", 16));  // none
    EXPECT_EQ(canvas.textWidth("\xe2\x89", 16), canvas.textWidth("\ufffd", 16));
    EXPECT_EQ(canvas.textWidth("", 16), 0);
    EXPECT_EQ(canvas.fitted("eeee", e, 16), "eeee");
    const std::string cut = canvas.fitted("\u00e9\u00e9\u00e9\u00e9", e - 1, 16);
    EXPECT_TRUE(cut == "\u00e9..." || cut == "\u00e9\u00e9...") << cut;
    EXPECT_LT(canvas.textWidth(cut, 16), e);
}

}  // namespace
}  // namespace aa
