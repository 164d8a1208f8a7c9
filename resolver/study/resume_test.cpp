#include "study/resume.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "image/error.h"
#include "image/io.h"
#include "shot/synth/synth.h"
#include "study/prepare.h"

namespace aa {
namespace {
namespace fs = std::filesystem;

class Resume : public ::testing::Test {
  protected:
    void SetUp() override {
        fs::remove_all(folder);
        SynthOptions o;
        o.scene = "moving", o.width = 70, o.height = 40, o.frames = 6, o.period = 4;
        o.nanPixel = glm::ivec2(3, 4);
        writeSynth(o, folder / "shot");
        o.scene = "half_planes", o.nanPixel.reset();
        writeSynth(o, folder / "static");
    }
    void TearDown() override { fs::remove_all(folder); }

    RunOptions options(const std::vector<std::string>& methods, const std::string& out,
                       const std::string& shot = "shot") const {
        RunOptions o;
        for (const auto& m : methods) o.methods.push_back(parseMethod(m));
        o.frames = selectFrames(readManifest(folder / shot), "");
        o.out = folder / out;
        o.measure = measureOptions({"flip"});
        o.maps = {&mapKindByName("error")};
        o.writeAllFrames = true;
        return o;
    }
    RunResults go(const RunOptions& o, const std::string& shot = "shot", int stopAfter = 1000) const {
        int steps = 0;
        return run(ShotReader(folder / shot), o,
                   {[&](const std::string&) { steps++; }, [&] { return steps >= stopAfter; }});
    }
    RunResults goOn(const RunOptions& o, const std::string& shot = "shot") const {
        return resume(ShotReader(folder / shot), o, {});
    }
    // Every file of a run; of results.json and results.csv without times and what belongs to the single run.
    std::map<std::string, std::string> contents(const std::string& out) const {
        std::map<std::string, std::string> files;
        for (const auto& e : fs::recursive_directory_iterator(folder / out)) {
            if (!e.is_regular_file() || e.path().filename() == "results.csv") continue;
            std::ifstream in(e.path(), std::ios::binary);
            std::string text{std::istreambuf_iterator<char>(in), {}};
            if (e.path().filename() == "results.json") text = withoutTimes(nlohmann::ordered_json::parse(text)).dump(1);
            files[fs::relative(e.path(), folder / out).string()] = text;
        }
        return files;
    }
    static nlohmann::ordered_json withoutTimes(nlohmann::ordered_json j) {
        j.erase("provenance");
        j["run"].erase("load");
        for (auto& m : j["methods"]) {
            for (const char* key : {"secondsMedian", "secondsMin", "secondsLow", "secondsHigh", "timings",
                                    "wallSecondsMedian", "nsPerPixel"})
                m.erase(key);
            for (auto& f : m["frames"]) f.erase("seconds"), f.erase("wallSeconds");
        }
        return j;
    }
    void expectSame(const std::string& out, const std::string& expected) const {
        const auto a = contents(out), b = contents(expected);
        for (const auto& [name, text] : b) {
            ASSERT_TRUE(a.contains(name)) << name;
            const std::string& made = a.at(name);
            const auto differs =
                size_t(std::mismatch(text.begin(), text.end(), made.begin(), made.end()).first - text.begin());
            const size_t from = differs < 200 ? 0 : differs - 200;
            EXPECT_TRUE(made == text) << name << " at byte " << differs << "\nfound " << made.substr(from, 400)
                                      << "\nexpected " << text.substr(from, 400);
        }
        for (const auto& file : a) EXPECT_TRUE(b.contains(file.first)) << file.first;
    }
    const fs::path folder = fs::temp_directory_path() / ("aaresolve_resume_" + std::to_string(::getpid()));
};

TEST_F(Resume, AnInterruptedRunSaysSoAndGoesOnToTheSameBytes) {
    const std::vector<std::string> methods = {"noaa", "uncharted", "fxaa311", "karis+fill=fxaa311"};
    const RunResults whole = go(options(methods, "whole"));
    EXPECT_TRUE(whole.complete);
    for (const int after : {1, 3, 5}) {
        const std::string out = "stopped" + std::to_string(after);
        const RunResults part = go(options(methods, out), "shot", after);
        EXPECT_FALSE(part.complete);
        EXPECT_EQ(incompleteInWords(part), "interrupted after " + std::to_string(after) + " of 6 frames");
        EXPECT_FALSE(readResults(folder / out).complete);
        EXPECT_TRUE(goOn(options(methods, out)).complete);
        expectSame(out, "whole");
    }
    // What is finished needs no second look.
    const auto before = fs::last_write_time(folder / "stopped1/noaa/000002.exr");
    goOn(options(methods, "stopped1"));
    EXPECT_EQ(fs::last_write_time(folder / "stopped1/noaa/000002.exr"), before);
    expectSame("stopped1", "whole");
}
TEST_F(Resume, OfAStaticShotWithFullHistory) {
    RunOptions o = options({"noaa", "uncharted"}, "whole", "static");
    o.protocol.history = History::full;
    go(o, "static");
    o.out = folder / "part";
    EXPECT_FALSE(go(o, "static", 41).complete);  // in its warm-up, and after it
    goOn(o, "static");
    expectSame("part", "whole");
    o.out = folder / "later";
    EXPECT_FALSE(go(o, "static", int(stepsOf(o, readManifest(folder / "static"))) - 2).complete);
    goOn(o, "static");
    expectSame("later", "whole");
}
TEST_F(Resume, MethodsAreAddedToTheSameBytes) {
    const std::vector<std::string> all = {"noaa", "fxaa311", "uncharted", "uncharted+fill=fxaa311"};
    go(options(all, "whole"));
    go(options({all[0], all[1]}, "grown"));  // without history: no figures over time
    goOn(options({all[2]}, "grown"));
    goOn(options({all[3]}, "grown"));  // shares what was rejected with the one before
    expectSame("grown", "whole");
    RunOptions againstOne = options({"noaa", "uncharted"}, "against");
    judgeAgainst(againstOne, "karis");
    go(againstOne);
    RunOptions more = options({"fxaa311"}, "against");
    judgeAgainst(more, "karis");
    goOn(more);
    RunOptions together = options({"noaa", "uncharted"}, "together");
    judgeAgainst(together, "karis");
    together.methods.push_back(parseMethod("fxaa311"));
    go(together);
    expectSame("against", "together");
}
TEST_F(Resume, AKilledRunLeavesWhatItHad) {
    RunOptions o = options({"noaa", "uncharted"}, "killed");
    o.checkpoint = nullptr;
    int steps = 0;
    EXPECT_THROW(run(ShotReader(folder / "shot"), o, {[&](const std::string&) {
                         if (++steps == 3) throw std::runtime_error("the power went");
                     }}),
                 std::runtime_error);
    const RunResults left = readResults(folder / "killed");
    EXPECT_FALSE(left.complete);
    go(options({"noaa", "uncharted"}, "whole"));
    goOn(options({"noaa", "uncharted"}, "killed"));
    expectSame("killed", "whole");
}
TEST_F(Resume, WhatWasMadeOtherwiseIsRefused) {
    go(options({"noaa"}, "out"));
    const auto refused = [&](const RunOptions& o, const std::string& words) {
        try {
            goOn(o);
            ADD_FAILURE() << "accepted: " << words;
        } catch (const InputError& e) {
            EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
        }
    };
    RunOptions o = options({"noaa", "uncharted"}, "out");
    o.protocol.eightBit = true;
    refused(o, "the protocol: before ");
    o = options({"noaa", "uncharted"}, "out");
    o.measure = {};
    refused(o, "what is measured and written: before 'metrics=flip maps=error write=exr frames=all'");
    o = options({"noaa", "uncharted"}, "out");
    o.frames.pop_back();
    refused(o, "the number of frames: before 6, now 5");
    // A picture of the shot that changed since.
    std::ofstream(folder / "shot" / readManifest(folder / "shot").frames[1].file, std::ios::app) << "x";
    refused(options({"noaa", "uncharted"}, "out"), "the shot's content: before ");
    EXPECT_THROW(goOn(options({"noaa"}, "nothing there")), InputError);
}
TEST_F(Resume, StalePicturesAreRemovedAndNamed) {
    go(options({"noaa", "fxaa311", "uncharted"}, "out"));
    writeText(folder / "out/fxaa311/notes.txt", "mine");
    writeText(folder / "out/report.html", "of the earlier run");
    writeText(folder / "out/sweep.html", "of a sweep");
    makeWritableFolder(folder / "out/mine");
    writeText(folder / "out/mine/000001.exr", "not the program's");
    RunOptions fewer = options({"noaa"}, "out");
    fewer.frames = {0, 1};
    const RunResults now = go(fewer);
    EXPECT_EQ(now.replacedMethods, (std::vector<std::string>{"fxaa311", "uncharted"}));
    EXPECT_EQ(now.outdatedFiles, (std::vector<std::string>{"report.html", "sweep.html"}));
    EXPECT_FALSE(fs::exists(folder / "out/uncharted"));
    EXPECT_FALSE(fs::exists(folder / "out/maps/error/uncharted"));
    EXPECT_FALSE(fs::exists(folder / "out/noaa/000003.exr")) << "a frame that this run has not";
    EXPECT_FALSE(fs::exists(folder / "out/fxaa311/000001.exr"));
    EXPECT_TRUE(fs::exists(folder / "out/fxaa311/notes.txt")) << "not the program's";
    EXPECT_TRUE(fs::exists(folder / "out/mine/000001.exr")) << "of no method that the results name";
    EXPECT_TRUE(fs::exists(folder / "out/noaa/000002.exr"));
    // A run that cannot start takes nothing away.
    EXPECT_THROW(go(options({"accum"}, "out")), std::exception);
    EXPECT_TRUE(fs::exists(folder / "out/noaa/000002.exr"));
}

}  // namespace
}  // namespace aa
