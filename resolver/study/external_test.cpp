#include "study/external.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>

#include "image/error.h"
#include "image/io.h"
#include "shot/synth/synth.h"
#include "study/prepare.h"
#include "study/run.h"

namespace aa {
namespace {
namespace fs = std::filesystem;

class External : public ::testing::Test {
  protected:
    void SetUp() override {
        fs::remove_all(folder);
        SynthOptions o;
        o.scene = "moving", o.width = 48, o.height = 32, o.frames = 4, o.period = 4;
        writeSynth(o, folder / "shot");
        RunOptions first = options();
        for (const char* m : {"uncharted", "karis"}) first.methods.push_back(parseMethod(m));
        first.writePng = true;
        ours = run(ShotReader(folder / "shot"), first, {});
    }
    void TearDown() override { fs::remove_all(folder); }
    RunOptions options() const {
        RunOptions o;
        o.frames = {0, 1, 2, 3};
        o.out = folder / "out";
        o.writeAllFrames = true;
        return o;
    }
    RunResults runOf(const std::vector<MethodSpec>& methods, const std::string& out = "external") const {
        RunOptions o = options();
        o.methods = methods;
        o.out = folder / out;
        return run(ShotReader(folder / "shot"), o, {});
    }
    // Our own pictures, as another program might have made them.
    fs::path copied(const std::string& method, const std::string& extension, const std::string& to) const {
        makeWritableFolder(folder / to);
        for (int f = 1; f <= 4; f++)
            fs::copy_file(folder / "out" / method / ("00000" + std::to_string(f) + extension),
                          folder / to / ("shot_v2_" + std::to_string(f) + extension));
        return folder / to;
    }
    std::string refusal(const fs::path& from) const {
        try {
            runOf({externalMethod("dlss", from, {})});
        } catch (const InputError& e) {
            return e.what();
        }
        return "";
    }
    const fs::path folder = fs::temp_directory_path() / ("aaresolve_external_" + std::to_string(::getpid()));
    RunResults ours;
};

TEST_F(External, PicturesGetTheFiguresOfTheMethodThatMadeThem) {
    const auto exr = externalMethod("dlss=" + copied("karis", ".exr", "a").string(), {});
    EXPECT_EQ(exr.outputSpace(), Space::linear);
    const auto displayed = externalMethod("fsr", copied("uncharted", ".exr", "b"), {});
    EXPECT_EQ(displayed.outputSpace(), Space::encoded) << "uncharted gives displayed colour, and its EXR says so";
    const RunResults r = runOf({parseMethod("noaa"), exr, displayed});
    const MethodResult &karis = ours.methods[1], &dlss = r.methods[1], &fsr = r.methods[2],
                       &uncharted = ours.methods[0];
    EXPECT_EQ(dlss.family, "external");
    EXPECT_EQ(dlss.nsPerPixel, 0);
    EXPECT_EQ(dlss.bytes(), 0u);
    EXPECT_EQ(dlss.pooled->mean.mse, karis.pooled->mean.mse);
    EXPECT_EQ(dlss.pooled->mean.others, karis.pooled->mean.others) << "relMse, too: linear light";
    EXPECT_EQ(*dlss.temporal->flickerMoving, *karis.temporal->flickerMoving);
    EXPECT_EQ(*dlss.temporal->ghostMse, *karis.temporal->ghostMse);
    EXPECT_NEAR(fsr.pooled->mean.mse, uncharted.pooled->mean.mse, 1e-8) << "through the EXR's linear light";
    EXPECT_EQ(r.pairs.size(), 3u);
    EXPECT_TRUE(fs::exists(folder / "external/dlss/000004.exr"));
}
TEST_F(External, PngHoldsDisplayedColour) {
    const RunResults r = runOf({externalMethod("engine", copied("karis", ".png", "a"), {})});
    EXPECT_NEAR(r.methods[0].pooled->mean.mse, ours.methods[1].pooled->mean.mse, 1e-4);
    EXPECT_FALSE(r.methods[0].pooled->mean.figure("relMse")) << "no linear light";
    ASSERT_TRUE(r.methods[0].temporal) << "over time though it is the only row";
}
// As a run with --write exr,png leaves them, and of frames before 0.
TEST_F(External, FoldersOfOurOwnRunsAreRead) {
    fs::path both = copied("karis", ".exr", "both");
    copied("karis", ".png", "both");
    EXPECT_EQ(externalMethod("a", both, {}).outputSpace(), Space::linear) << "the EXR, which holds more";
    makeWritableFolder(folder / "before");
    writeExr(folder / "before/-00005.exr", Rgb(48, 32), false);
    EXPECT_NE(refusal(folder / "before").find("no picture of frame 1 among its 1 (-5 to -5)"), std::string::npos)
        << refusal(folder / "before");
}
TEST_F(External, TheDisplayWindowIsWhatIsHeldAgainstTheTruth) {
    Rgb whole(48, 32), part(20, 10);
    for (int y = 0; y < 10; y++)
        for (int x = 0; x < 20; x++) whole.c[1].at(x + 7, y + 5) = part.c[1].at(x, y) = float(x + y) / 30;
    for (const char* name : {"whole", "part", "over"}) makeWritableFolder(folder / name);
    for (int f = 1; f <= 4; f++) {
        const std::string file = std::to_string(f) + ".exr";
        writeExr(folder / "whole" / file, whole, false);
        writeExr(folder / "part" / file, part, false, {nullptr, Window{-7, -5, 48, 32}});
        writeExr(folder / "over" / file, whole, false, {nullptr, Window{7, 5, 20, 10}});
    }
    const RunResults r =
        runOf({externalMethod("whole", folder / "whole", {}), externalMethod("part", folder / "part", {})});
    EXPECT_EQ(r.methods[0].pooled->mean.mse, r.methods[1].pooled->mean.mse);
    EXPECT_NE(refusal(folder / "over").find("expected 48x32 pixels as in the shot, found 20x10"), std::string::npos)
        << refusal(folder / "over");
}
TEST_F(External, ExposureAndTransferAreThoseOfTheProtocol) {
    RunOptions o = options();
    o.protocol.display = {1.0f, ToneMap::none, Transfer::identity};
    o.methods = {parseMethod("noaa")};
    const RunResults before = run(ShotReader(folder / "shot"), o, {});
    // The shot's own samples, linear: what noaa shows.
    makeWritableFolder(folder / "samples");
    const ShotReader reader(folder / "shot");
    for (size_t i = 0; i < 4; i++) {
        const Frame f = reader.hasCentreFrames() ? reader.readCentre(i, Pass::color) : reader.read(i, Pass::color);
        writeExr(folder / "samples" / ("f" + std::to_string(i + 1) + ".exr"), f.colorLinear, false);
    }
    o.methods = {externalMethod("samples", folder / "samples", o.protocol.display)};
    const RunResults now = run(reader, o, {});
    EXPECT_EQ(now.methods[0].pooled->mean.mse, before.methods[0].pooled->mean.mse);
}
TEST_F(External, TheyCanStandInForTheTruth) {
    RunOptions o = options();
    o.methods = {parseMethod("noaa"), externalMethod("ideal", copied("karis", ".exr", "a"), {})};
    judgeAgainst(o, "ideal");
    EXPECT_EQ(o.methods.size(), 2u);
    const RunResults r = run(ShotReader(folder / "shot"), o, {});
    EXPECT_TRUE(r.isReference(r.methods[1]));
    EXPECT_TRUE(r.methods[0].pooled);
}
TEST_F(External, WhatDoesNotFitIsOneClearLine) {
    EXPECT_NE(refusal(folder / "nowhere").find("no such folder"), std::string::npos);
    makeWritableFolder(folder / "empty");
    EXPECT_NE(refusal(folder / "empty").find("holds no EXR and no PNG"), std::string::npos);
    const fs::path fewer = copied("karis", ".exr", "fewer");
    fs::remove(fewer / "shot_v2_3.exr");
    EXPECT_NE(refusal(fewer).find("no picture of frame 3 among its 3 (1 to 4); add it"), std::string::npos)
        << refusal(fewer);
    const fs::path twice = copied("karis", ".exr", "twice");
    fs::copy_file(twice / "shot_v2_3.exr", twice / "b3.exr");
    EXPECT_NE(refusal(twice).find("are frame 3"), std::string::npos) << refusal(twice);
    const fs::path both = copied("karis", ".exr", "both");
    fs::copy_file(folder / "out/karis/000001.png", both / "5.png");
    EXPECT_NE(refusal(both).find("holds both EXR and PNG"), std::string::npos) << refusal(both);
    const fs::path size = copied("karis", ".exr", "size");
    writeExr(size / "shot_v2_2.exr", Rgb(47, 32), false);
    EXPECT_NE(refusal(size).find("shot_v2_2.exr: expected 48x32 pixels as in the shot, found 47x32"), std::string::npos)
        << refusal(size);
    const fs::path nan = copied("karis", ".exr", "nan");
    Rgb broken(48, 32);
    broken.c[1].at(5, 6) = NAN;
    writeExr(nan / "shot_v2_4.exr", broken, false);
    EXPECT_NE(refusal(nan).find("pixel (5, 6) is NaN"), std::string::npos) << refusal(nan);
    makeWritableFolder(folder / "unnumbered");
    writeExr(folder / "unnumbered/final.exr", Rgb(48, 32), false);
    EXPECT_NE(refusal(folder / "unnumbered").find("no frame number in its name"), std::string::npos);
    for (const char* name : {"", "a b", "../x", "noaa", "truth", "-x", "results.json", "results.csv", "sheet.PNG"})
        EXPECT_THROW(externalMethod(name, fewer, {}), UsageError) << name;
    EXPECT_THROW(externalMethod("dlss", DisplayChain{}), UsageError);
    EXPECT_THROW(externalMethod("dlss=", DisplayChain{}), UsageError);
}

}  // namespace
}  // namespace aa
