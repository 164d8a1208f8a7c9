#include "report/angles.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "image/error.h"
#include "image/io.h"

namespace aa {
namespace {
namespace fs = std::filesystem;

AngleStudy example() {
    AngleStudy s;
    s.offsets = 8, s.sizePx = 128, s.frames = 16, s.jitter = "halton23";
    s.degrees = {45, 135, 225, 315};
    s.noaaMse = {0.01, 0.01, 0.01, 0.01};
    s.methods = {{"a<b", "A", "spatial", "", {0.001, 0.001, 0.001, 0.001}},
                 {"c", "C", "geometry", "d3d8", {0.01, 0.02, 0.01, 0.02}}};
    return s;
}

TEST(Angles, FilesSayTheGains) {
    const auto j = nlohmann::json::parse(toJsonText(example()));
    EXPECT_EQ(j["format"], "aaresolve-angles");
    EXPECT_NEAR(j["methods"][0]["gainDb"][2].get<double>(), 10, 1e-9);
    EXPECT_NEAR(j["methods"][0]["pooledGainDb"].get<double>(), 10, 1e-9);
    EXPECT_NEAR(j["methods"][1]["turnDb"].get<double>(), 3.0103, 1e-4);
    EXPECT_EQ(j["methods"][1]["subsamples"], "d3d8");
    EXPECT_EQ(j["noaaPsnr"][0], 20);
    EXPECT_EQ(toCsvText(example()).substr(0, 24), "degrees,noaaPsnr,\"a<b\",\"");
    EXPECT_NE(toCsvText(example()).find("\n135,20,10,-3.0103\n"), std::string::npos);
    const std::string svg = toSvgText(example());
    EXPECT_EQ(svg.substr(0, 4), "<svg");
    EXPECT_NE(svg.find("a&lt;b</text>"), std::string::npos);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
}
TEST(Angles, SectionOfTheReport) {
    const fs::path folder = fs::temp_directory_path() / "aaresolve_angles_test";
    fs::remove_all(folder);
    fs::create_directories(folder);
    EXPECT_EQ(anglesForReport(folder), "");
    AngleStudy s = example();
    s.methods[0].text = "</script>";
    writeText(folder / "angles.json", toJsonText(s));
    const std::string block = anglesForReport(folder);
    EXPECT_NE(block.find("id=\"angles-data\""), std::string::npos);
    EXPECT_NE(block.find("Edges by direction"), std::string::npos);
    EXPECT_EQ(block.find("</script>\","), std::string::npos);
    writeText(folder / "angles.json", "{\"format\": 3");
    EXPECT_THROW(anglesForReport(folder), InputError);
    fs::remove_all(folder);
}

}  // namespace
}  // namespace aa
