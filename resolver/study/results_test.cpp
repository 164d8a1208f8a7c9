#include "study/results.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "image/error.h"
#include "image/io.h"
#include "image/io_testing.h"

namespace aa {
namespace {
namespace fs = std::filesystem;
constexpr double kInf = std::numeric_limits<double>::infinity();

FrameResult frame(int number, double mse, double seconds, double ssim = 0.9) {
    FrameMetrics m;
    m.mse = mse, m.reference = 0.25, m.psnr = psnr(mse), m.snr = snr({mse, 0.25}), m.others["ssimLuma"] = ssim;
    return {number, seconds, m, true, "noaa/" + std::to_string(number) + ".exr"};
}
RunResults twoMethods() {
    RunResults run;
    run.shot = "pipe", run.width = 100, run.height = 50;
    run.jitterSequence = "halton23", run.jitterStart = 1, run.jitterPeriod = 16;
    run.jitterMeanPx[0] = -0.0293, run.jitterMeanPx[1] = -0.0370;
    run.truthSamplesPerHalf = 256, run.truthFilter = "box", run.truthNoise = 1e-5;
    run.truthImages[2] = "truth/000002.exr";
    run.programVersion = "0.1.0", run.isa = "x86-64-v3", run.precision = "fast", run.machine = "a processor";
    run.protocol.display = {1.5f, ToneMap::aces};
    run.sanitised["colourNan"] = 3;
    MethodResult noaa, other;
    noaa.id = noaa.text = noaa.folder = "noaa";
    noaa.frames = {frame(1, 0.01, 3e-3), frame(2, 0.03, 1e-3), {3, 2e-3, {}, true, ""}};
    other.id = "fxaa311", other.text = "fxaa311:preset=12,subpix=0.5", other.folder = "fxaa311_preset=12,subpix=0.5";
    other.parameters["preset"] = "12";
    other.passes = {"color"};
    other.stateBytes = 4096;
    other.frames = {frame(1, 0.0, 4e-3, 1.0), frame(2, 0.008, 4e-3)};
    other.frames[0].metrics->others["flip"] = 0.0, other.frames[1].metrics->others["flip"] = 0.25;
    run.methods = {noaa, other};
    return run;
}
std::vector<TileErrors> errorsOf(double a, double b) {
    TileErrors first, second;
    first.columns = 4;
    first.sum.assign(16, a), first.values.assign(16, 192), second = first;
    second.sum.assign(16, b);
    return {first, second};
}

TEST(Results, PoolsMseNotDecibels) {
    RunResults run = twoMethods();
    finish(run, errorsOf(2, 1));
    const auto& noaa = *run.methods[0].pooled;
    EXPECT_EQ(noaa.frames, 2);
    EXPECT_DOUBLE_EQ(noaa.mean.mse, 0.02);
    EXPECT_DOUBLE_EQ(noaa.mean.psnr, psnr(0.02));
    EXPECT_GT(std::abs(noaa.mean.psnr - (psnr(0.01) + psnr(0.03)) / 2), 0.5);  // the mean of decibels is another number
    EXPECT_DOUBLE_EQ(noaa.meanFinitePsnr, (psnr(0.01) + psnr(0.03)) / 2);
    EXPECT_DOUBLE_EQ(noaa.mseInterval.corrected, 0.02 - 1e-5);
    EXPECT_FALSE(noaa.mean.figure("flip"));
    // One identical frame: its infinite PSNR must not swallow the others.
    const auto& other = *run.methods[1].pooled;
    EXPECT_DOUBLE_EQ(other.mean.psnr, psnr(0.004));
    EXPECT_EQ(other.infinitePsnrFrames, 1);
    EXPECT_DOUBLE_EQ(other.meanFinitePsnr, psnr(0.008));
    EXPECT_DOUBLE_EQ(*other.gainDb, psnr(0.004) - psnr(0.02));
    EXPECT_DOUBLE_EQ(*other.mean.figure("flip"), 0.125);
    EXPECT_DOUBLE_EQ(*noaa.gainDb, 0);
}
TEST(Results, RangesOverFramesNameTheFirstBestAndWorst) {
    RunResults run = twoMethods();
    run.methods[0].frames = {frame(7, 0.02, 1, 0.7),
                             frame(8, 0.01, 1, 0.9),
                             frame(9, 0.04, 1, 0.5),
                             frame(10, 0.01, 1, 0.9),
                             {11, 1, {}, true, ""}};
    finish(run, {});
    const auto range = [&](size_t k, const char* name) {
        return *rangeOverFrames(run.methods[k], *figureByName(name));
    };
    const FigureRange mse = range(0, "mse"), similarity = range(0, "ssimLuma"), noise = range(0, "psnr");
    EXPECT_EQ(mse.best, 0.01);
    EXPECT_EQ(mse.worst, 0.04);
    EXPECT_DOUBLE_EQ(mse.mean, 0.02);
    EXPECT_EQ(mse.bestFrame, 8);
    EXPECT_EQ(mse.worstFrame, 9);
    EXPECT_EQ(similarity.best, 0.9);
    EXPECT_EQ(similarity.worstFrame, 9);
    EXPECT_EQ(noise.best, psnr(0.01));
    EXPECT_EQ(noise.bestFrame, 8);
    EXPECT_FALSE(rangeOverFrames(run.methods[0], *figureByName("flip")));
    // An identical frame: the average of its PSNR is infinite, the pooled one is not.
    const FigureRange identical = range(1, "psnr");
    EXPECT_EQ(identical.best, kInf);
    EXPECT_EQ(identical.bestFrame, 1);
    EXPECT_EQ(identical.worst, psnr(0.008));
    EXPECT_EQ(identical.mean, kInf);
    const auto j = nlohmann::json::parse(toJsonText(run));
    EXPECT_EQ(j["methods"][1]["overFrames"]["psnr"]["mean"], "Inf");
    EXPECT_EQ(j["methods"][0]["overFrames"]["ssimLuma"]["worstFrame"], 9);
    EXPECT_FALSE(j["methods"][0]["overFrames"].contains("flip"));
    run.methods[0].frames.resize(1);
    finish(run, {});
    EXPECT_FALSE(nlohmann::json::parse(toJsonText(run))["methods"][0].contains("overFrames")) << "a single frame";
}
TEST(Results, UnjudgedFramesAreLeftOut) {
    RunResults run = twoMethods();
    run.methods[0].frames[0].judged = false;
    finish(run, {});
    EXPECT_EQ(run.methods[0].pooled->frames, 1);
    EXPECT_DOUBLE_EQ(run.methods[0].pooled->mean.mse, 0.03);
}
TEST(Results, TimesAreMedians) {
    RunResults run = twoMethods();
    finish(run, {});
    // Of three frames the first, which allocates, does not count; of one or two frames all do.
    EXPECT_DOUBLE_EQ(run.methods[0].secondsMedian, 1.5e-3);
    EXPECT_DOUBLE_EQ(run.methods[0].secondsMin, 1e-3);
    EXPECT_DOUBLE_EQ(run.methods[0].secondsHigh, 2e-3);
    EXPECT_EQ(run.methods[0].timings, 2);
    EXPECT_DOUBLE_EQ(run.methods[0].nsPerPixel, 1.5e-3 * 1e9 / 5000);
    EXPECT_EQ(run.methods[1].timings, 2);
    run.methods[0].frames.resize(1);
    run.methods[0].moreSeconds = {1e-3, 2e-3, 4e-3, 9e-3};
    finish(run, {});
    EXPECT_DOUBLE_EQ(run.methods[0].secondsMedian, 3e-3) << "repeats of one frame";
    EXPECT_DOUBLE_EQ(run.methods[0].secondsLow, 1.75e-3);
    EXPECT_DOUBLE_EQ(run.methods[0].secondsHigh, 5.25e-3);
    EXPECT_TRUE(run.pairs.empty());
}
TEST(Results, RoundTrip) {
    const fs::path folder = fs::temp_directory_path() / "aaresolve_results_test";
    fs::remove_all(folder);
    makeWritableFolder(folder);
    RunResults run = twoMethods();
    finish(run, errorsOf(2, 1));
    writeResults(run, folder);
    const RunResults back = readResults(folder);
    EXPECT_EQ(toJsonText(back), toJsonText(run));
    EXPECT_EQ(back.methods[1].frames[0].metrics->psnr, kInf);
    EXPECT_EQ(back.protocol.display.toneMap, ToneMap::aces);
    EXPECT_EQ(back.pairs.size(), 1u);
    EXPECT_TRUE(back.pairs[0].comparison.resolved);
    EXPECT_EQ(back.methods[0].parts.size(), run.methods[0].parts.size());
    run.pairs[0].comparison.resolved = false;
    for (const Unresolved why : {Unresolved::truthNoise, Unresolved::varies, Unresolved::tooSmall, Unresolved::equal}) {
        run.pairs[0].comparison.why = why;
        writeResults(run, folder);
        EXPECT_EQ(readResults(folder).pairs[0].comparison.why, why);
    }
    auto old = nlohmann::json::parse(toJsonText(run));  // of a program that gave no reasons and kept no parts
    old["pairs"][0].erase("unresolved");
    for (auto& m : old["methods"]) m.erase("errorParts");
    writeText(folder / "results.json", old.dump());
    EXPECT_EQ(readResults(folder).pairs[0].comparison.why, Unresolved::varies);
    EXPECT_FALSE(back.jitterCentred());
    EXPECT_FALSE(hasTemporaryFiles(folder));
    fs::remove_all(folder);
}
TEST(Results, ProtocolIsKeptAndOldRunsHaveTheDefault) {
    const fs::path folder = fs::temp_directory_path() / "aaresolve_results_protocol";
    fs::remove_all(folder);
    makeWritableFolder(folder);
    RunResults run = twoMethods();
    run.protocol = {{0.5f, ToneMap::none, Transfer::identity}, History::full, true, Window{20, 10, 30, 40}, "noaa"};
    run.warmUpFrames = 160;
    run.truthClipped = {12, 5000};
    writeResults(run, folder);
    const RunResults back = readResults(folder);
    EXPECT_EQ(back.protocol.display.transfer, Transfer::identity);
    EXPECT_EQ(back.protocol.history, History::full);
    EXPECT_TRUE(back.protocol.eightBit);
    EXPECT_EQ(back.warmUpFrames, 160u);
    EXPECT_EQ(back.truthClipped->pixels, 12u);
    EXPECT_EQ(toJsonText(back), toJsonText(run));
    EXPECT_EQ(back.protocol.region, (Window{20, 10, 30, 40}));
    EXPECT_TRUE(back.isReference(back.methods[0]));
    EXPECT_FALSE(back.isReference(back.methods[1]));
    EXPECT_EQ(inWords(back.protocol),
              "displayed values at +0.5 EV, full history, 8-bit, region of 30 x 40 px at 20, 10, against noaa (not the "
              "truth)");
    EXPECT_EQ(inOneField(back.protocol),
              "display=identity exposure=0.5 toneMap=none history=full quantise=8 region=20,10,30,40 reference=noaa");

    auto old = nlohmann::json::parse(toJsonText(run));
    for (const char* member : {"history", "warmUpFrames", "quantiseBits", "region", "reference"})
        old["run"].erase(member);
    old["run"]["display"].erase("transfer");
    old["truth"].erase("clipped");
    writeText(folder / "results.json", old.dump());
    const RunResults before = readResults(folder);
    EXPECT_EQ(before.protocol.display.transfer, Transfer::srgb);
    EXPECT_EQ(before.protocol.display.exposure, 0.5f);
    EXPECT_EQ(before.protocol.history, History::first);
    EXPECT_FALSE(before.protocol.eightBit);
    EXPECT_EQ(before.warmUpFrames, 0u);
    EXPECT_FALSE(before.truthClipped);
    EXPECT_FALSE(before.protocol.region);
    EXPECT_FALSE(before.isReference(before.methods[0]));
    EXPECT_EQ(inWords(Protocol{}), "sRGB-encoded values, history from the first frame");

    for (const auto& [member, wrong] : {std::pair<const char*, nlohmann::json>{"history", "whole"},
                                        {"quantiseBits", 7},
                                        {"warmUpFrames", "many"},
                                        {"region", {80, 0, 30, 10}}}) {
        auto damaged = old;
        damaged["run"][member] = wrong;
        writeText(folder / "results.json", damaged.dump());
        EXPECT_THROW(readResults(folder), InputError) << member;
    }
    fs::remove_all(folder);
}
TEST(Results, InfinityIsAString) {
    RunResults run = twoMethods();
    finish(run, {});
    const auto j = nlohmann::json::parse(toJsonText(run));
    EXPECT_EQ(j["methods"][1]["frames"][0]["metrics"]["psnr"], "Inf");
    EXPECT_NE(toCsvText(run).find(
                  "\"fxaa311:preset=12,subpix=0.5\",1,0,Inf,Inf,1,0,0.004,display=srgb exposure=1.5 toneMap=aces "),
              std::string::npos)
        << toCsvText(run);
    EXPECT_NE(toCsvText(run).find("noaa,3,,,,,,0.002,display=srgb "), std::string::npos);
}
TEST(Results, DamagedFilesAreNamed) {
    const fs::path folder = fs::temp_directory_path() / "aaresolve_results_damaged";
    fs::remove_all(folder);
    EXPECT_THROW(readResults(folder), InputError);
    makeWritableFolder(folder);
    RunResults run = twoMethods();
    finish(run, errorsOf(2, 1));
    const auto refuses = [&](const std::string& text, const std::string& expected) {
        writeText(folder / "results.json", text);
        try {
            readResults(folder);
            FAIL() << "accepted: " << expected;
        } catch (const InputError& e) {
            EXPECT_NE(std::string(e.what()).find("results.json"), std::string::npos) << e.what();
            EXPECT_NE(std::string(e.what()).find(expected), std::string::npos) << e.what();
        }
    };
    const std::string good = toJsonText(run);
    refuses(good.substr(0, good.size() / 2), "damaged");
    auto j = nlohmann::json::parse(good);
    j["shot"].erase("resolution");
    refuses(j.dump(), "resolution");
    j = nlohmann::json::parse(good);
    j["pairs"][0]["indices"] = {0, 9};
    refuses(j.dump(), "pair");
    j = nlohmann::json::parse(good);
    j["version"] = 2;
    refuses(j.dump(), "version");
    fs::remove_all(folder);
}
}  // namespace
}  // namespace aa
