#include "metrics/figures.h"

#include <gtest/gtest.h>

namespace aa {
namespace {

TEST(FigureValues, AreFoundByNameInTheOrderOfNames) {
    FigureValues v;
    v["ssim"] = 0.9;
    EXPECT_EQ(v.emplace("flip", 0.1), 0.1);
    EXPECT_EQ(v.emplace("flip", 0.5), 0.1) << "it has a value";
    v["mae"] += 2;
    std::string names;
    for (const auto& [name, value] : v) names += std::string(name) + " ";
    EXPECT_EQ(names, "flip mae ssim ");
    for (auto&& [name, value] : v) value *= 2;
    EXPECT_EQ(v.at("mae"), 4);
    EXPECT_EQ(v.find("ssim")->second, 1.8);
    EXPECT_TRUE(v.find("psnr") == std::as_const(v).end());
    EXPECT_THROW(v.at("psnr"), std::out_of_range);
}
TEST(FigureValues, WhatWasMovedAwayCanBeFilledAgain) {
    FigureValues a = {{"mae", 1.0}, {"flip", 2.0}};
    const FigureValues b = std::move(a);
    EXPECT_EQ(a, FigureValues());
    a["flip"] = 3;
    EXPECT_EQ(a.at("flip"), 3);
    EXPECT_EQ(b, (FigureValues{{"mae", 1.0}, {"flip", 2.0}}));
}
TEST(FigureValues, ACopyHasItsOwnValues) {
    FigureValues a = {{"mae", 1.0}, {"flip", 2.0}}, b = a;
    EXPECT_EQ(a, b);
    b["flip"] = 3;
    EXPECT_EQ(a.at("flip"), 2);
    EXPECT_NE(a, b);
    EXPECT_EQ(a, (FigureValues{{"flip", 2.0}, {"mae", 1.0}})) << "in whichever order they came";
    b.eraseIf([](const auto& f) { return f.first == "flip"; });
    EXPECT_EQ(b, (FigureValues{{"mae", 1.0}}));
    b.eraseIf([](const auto&) { return true; });
    EXPECT_EQ(b, FigureValues());
    EXPECT_TRUE(b.begin() == b.end());
}

}  // namespace
}  // namespace aa
