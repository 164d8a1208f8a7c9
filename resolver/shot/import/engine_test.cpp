#include "shot/import/engine.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "image/error.h"
#include "image/exr.h"
#include "image/io.h"
#include "shot/import/store.h"
#include "shot/reader.h"
#include "shot/synth/synth.h"

namespace aa {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

// A synthetic shot, written as an engine might, comes back as it was.
class Engine : public ::testing::Test {
  protected:
    static constexpr int kWidth = 32, kHeight = 20, kFrames = 3;
    void SetUp() override {
        fs::remove_all(folder);
        take("two_planes");
    }
    void take(const std::string& scene) {
        SynthOptions o;
        o.scene = scene, o.width = kWidth, o.height = kHeight, o.frames = kFrames, o.period = 3;
        writeSynth(o, folder / scene);
        original.emplace(folder / scene, InputPolicy::raw);
        frames.clear();
        for (size_t i = 0; i < kFrames; i++)
            frames.push_back(original->read(
                i, Pass::color | Pass::albedo | Pass::depth | Pass::normal | Pass::object | Pass::motion));
        makeWritableFolder(folder / "engine");
    }
    void TearDown() override { fs::remove_all(folder); }

    using Change = std::function<double(const Frame&, int x, int y, int channel, double value)>;
    // engine/NAME_<n>.exr with these channels of these planes, each value as `change` makes it.
    void write(const std::string& name, const std::vector<std::string>& channels,
               const std::function<std::vector<const PlaneF*>(const Frame&)>& planesOf, const Change& change = {}) {
        for (const Frame& f : frames) {
            std::vector<PlaneF> changed;
            for (const PlaneF* plane : planesOf(f)) {
                changed.emplace_back(kWidth, kHeight);
                for (int y = 0; y < kHeight; y++)
                    for (int x = 0; x < kWidth; x++) {
                        const double v = plane->at(x, y);
                        changed.back().at(x, y) = float(change ? change(f, x, y, int(changed.size()) - 1, v) : v);
                    }
            }
            PartSource part{"", {}};
            for (size_t c = 0; c < channels.size(); c++) part.channels.push_back({channels[c], &changed[c]});
            writeParts(folder / "engine" / (name + "_" + std::to_string(f.number) + ".exr"), {part});
        }
    }
    void writeColour() {
        write("color", {"R", "G", "B"}, [](const Frame& f) {
            return std::vector<const PlaneF*>{&f.colorLinear.c[0], &f.colorLinear.c[1], &f.colorLinear.c[2]};
        });
    }
    static json source(const std::string& name) { return {{"files", name + "_{frame}.exr"}}; }
    json layout() const {
        json j = {{"format", "aaresolve-frames"}, {"version", 1}};
        j["passes"]["color"] = source("color");
        for (const auto& f : original->manifest().frames) {
            const json all = toJson(original->manifest());
            for (const json& entry : all["frames"])
                if (entry["frame"] == f.frame)
                    j["frames"].push_back(
                        {{"frame", f.frame}, {"jitter", entry["jitter"]}, {"camera", entry["camera"]}});
        }
        return j;
    }
    ImportReport import(const json& j, const std::string& out = "out") {
        writeText(folder / "layout.json", j.dump(1));
        return importEngine({folder / "engine", folder / "layout.json", folder / out, ""});
    }
    Frame imported(size_t i, PassSet passes, const std::string& out = "out") const {
        return ShotReader(folder / out, InputPolicy::raw).read(i, passes);
    }
    std::string refusal(const json& j) {
        try {
            import(j, "refused");
        } catch (const InputError& e) {
            return e.what();
        }
        return "";
    }
    static double farthest(const PlaneF& a, const PlaneF& b, double relative = 0) {
        double most = 0;
        for (int y = 0; y < kHeight; y++)
            for (int x = 0; x < kWidth; x++) {
                const double d = std::abs(double(a.at(x, y)) - double(b.at(x, y)));
                most = std::max(most, relative > 0 ? d / std::abs(double(b.at(x, y))) : d);
            }
        return most;
    }
    const fs::path folder = fs::temp_directory_path() / ("aaresolve_engine_" + std::to_string(::getpid()));
    std::optional<ShotReader> original;
    std::vector<Frame> frames;
};

TEST_F(Engine, ColourJitterAndCamerasAreTaken) {
    writeColour();
    const ImportReport r = import(layout());
    EXPECT_EQ(r.imported, size_t(kFrames));
    EXPECT_EQ(r.manifest.width, kWidth);
    const Manifest m = readManifest(folder / "out");
    for (size_t i = 0; i < kFrames; i++) {
        EXPECT_TRUE(imported(i, Pass::color).colorLinear.samePixels(frames[i].colorLinear));
        EXPECT_EQ(m.frames[i].jitterPx, original->manifest().frames[i].jitterPx);
        EXPECT_EQ(m.frames[i].camera->projection, original->manifest().frames[i].camera->projection);
        EXPECT_EQ(m.frames[i].reset, i == 0);
    }
    EXPECT_EQ(import(layout()).kept, size_t(kFrames));  // what is finished stays
    json renamed = layout();
    renamed["fps"] = 30;
    EXPECT_EQ(import(renamed).kept, size_t(kFrames));
    renamed["passes"]["color"]["channels"] = {"B", "G", "R"};
    EXPECT_EQ(import(renamed).imported, size_t(kFrames)) << "the layout reads other pixels";
}
TEST_F(Engine, EveryDepthBecomesPlanar) {
    writeColour();
    const Camera& c = *frames[0].camera;
    const double n = 0.25, far = 500;
    const auto check = [&](const json& pass, const Change& stored, double tolerance) {
        write(
            "depth", {"D"}, [](const Frame& f) { return std::vector<const PlaneF*>{&f.depthView}; }, stored);
        json j = layout();
        j["passes"]["depth"] = pass;
        j["passes"]["depth"]["files"] = "depth_{frame}.exr";
        j["passes"]["depth"]["channels"] = {"D"};
        import(j);
        for (size_t i = 0; i < kFrames; i++)
            EXPECT_LT(farthest(imported(i, Pass::depth).depthView, frames[i].depthView, 1), tolerance) << pass.dump();
    };
    const auto background = [](double z) { return z >= 1e9; };
    check({{"kind", "planar"}}, {}, 1e-9);
    check(
        {{"kind", "planar"}, {"scale", 0.01}, {"background", 65504}},
        [&](const Frame&, int, int, int, double z) { return background(z) ? 65504 : 100 * z; }, 1e-6);
    check(
        {{"kind", "device"}, {"near", n}, {"far", far}},
        [&](const Frame&, int, int, int, double z) { return background(z) ? 1 : far * (z - n) / (z * (far - n)); },
        2e-4);
    check(
        {{"kind", "reversed"}, {"near", n}, {"far", far}},
        [&](const Frame&, int, int, int, double z) { return background(z) ? 0 : n * (far - z) / (z * (far - n)); },
        1e-5);
    check(
        {{"kind", "reversed"}, {"near", n}},
        [&](const Frame&, int, int, int, double z) { return background(z) ? 0 : n / z; }, 1e-6);
    check(
        {{"kind", "distance"}},
        [&](const Frame& f, int x, int y, int, double z) {
            if (background(z)) return z;
            const double rx = (2 * (x + 0.5 + f.jitterPx.x) / kWidth - 1 + c.projection[2][0]) / c.projection[0][0],
                         ry = (1 - 2 * (y + 0.5 + f.jitterPx.y) / kHeight + c.projection[2][1]) / c.projection[1][1];
            return z * std::sqrt(1 + rx * rx + ry * ry);
        },
        1e-6);
}
TEST_F(Engine, EveryMotionBecomesCurrentLessPreviousInPixels) {
    take("moving");
    writeColour();
    const auto check = [&](const json& pass, const Change& stored) {
        write(
            "motion", {"R", "G"},
            [](const Frame& f) {
                return std::vector<const PlaneF*>{&f.motionXPx, &f.motionYPx};
            },
            stored);
        json j = layout();
        j["passes"]["motion"] = pass;
        j["passes"]["motion"]["files"] = "motion_{frame}.exr";
        j["passes"]["motion"]["channels"] = {"R", "G"};
        import(j);
        for (size_t i = 1; i < kFrames; i++) {
            const Frame f = imported(i, Pass::motion);
            EXPECT_LT(farthest(f.motionXPx, frames[i].motionXPx), 1e-5) << pass.dump();
            EXPECT_LT(farthest(f.motionYPx, frames[i].motionYPx), 1e-5) << pass.dump();
        }
    };
    ASSERT_GT(farthest(frames[1].motionXPx, PlaneF(kWidth, kHeight)), 0.1) << "a shot that moves";
    const auto size = [](int c) { return c == 0 ? double(kWidth) : double(kHeight); };
    check({{"units", "px"}, {"means", "current-previous"}, {"y", "down"}}, {});
    check({{"units", "uv"}, {"means", "previous-current"}, {"y", "down"}},
          [&](const Frame&, int, int, int c, double v) { return -v / size(c); });
    check({{"units", "ndc"}, {"means", "current-previous"}, {"y", "up"}},
          [&](const Frame&, int, int, int c, double v) { return (c == 1 ? -2 : 2) * v / size(c); });
    check({{"units", "px"}, {"means", "current-previous"}, {"y", "down"}, {"jittered", true}},
          [&](const Frame& f, int, int, int c, double v) {
              const auto& all = original->manifest().frames;
              const size_t i = size_t(f.number - all[0].frame);
              return i == 0 ? v : v - (all[i].jitterPx[c] - all[i - 1].jitterPx[c]);
          });
}
TEST_F(Engine, NormalsBecomeWorldSpace) {
    writeColour();
    const auto planes = [](const Frame& f) {
        return std::vector<const PlaneF*>{&f.normalWorld.c[0], &f.normalWorld.c[1], &f.normalWorld.c[2]};
    };
    const glm::dmat3 view(frames[0].camera->view);
    write("normal", {"R", "G", "B"}, planes, [&](const Frame& f, int x, int y, int c, double) {
        const auto& n = f.normalWorld.c;
        return (view * glm::dvec3(n[0].at(x, y), n[1].at(x, y), n[2].at(x, y)))[c] / 2 + 0.5;
    });
    json j = layout();
    j["passes"]["normal"] = source("normal");
    j["passes"]["normal"]["channels"] = {"R", "G", "B"};
    j["passes"]["normal"]["space"] = "view";
    j["passes"]["normal"]["encoding"] = "unsigned";
    import(j);
    for (size_t c = 0; c < 3; c++)
        EXPECT_LT(farthest(imported(1, Pass::normal).normalWorld.c[c], frames[1].normalWorld.c[c]), 1e-6);
}
TEST_F(Engine, OneFileMayHoldAllPassesAndTruthItsHalves) {
    for (const Frame& f : frames) {
        PlaneF b(kWidth, kHeight);
        b.at(1, 1) = 1;
        const std::string n = std::to_string(f.number);
        writeParts(folder / "engine" / ("all." + n + ".exr"),
                   {{"main",
                     {{"R", &f.colorLinear.c[0]},
                      {"G", &f.colorLinear.c[1]},
                      {"B", &f.colorLinear.c[2]},
                      {"depth.Z", &f.depthView},
                      {"id", &f.objectId}}},
                    {"ref", {{"R", &f.colorLinear.c[0]}, {"G", &f.colorLinear.c[1]}, {"B", &f.colorLinear.c[2]}}},
                    {"ref2", {{"R", &b}, {"G", &b}, {"B", &b}}}});
    }
    json j = layout();
    j.erase("frames");
    const auto from = [](json more) {
        more["files"] = "all.{frame}.exr";
        return more;
    };
    j["passes"] = {{"color", from(json::object())},
                   {"depth", from({{"channels", {"depth.Z"}}, {"kind", "planar"}})},
                   {"object", from(json::object())}};
    j["centre"]["color"] = from(json::object());
    j["truth"] = {
        {"a", from({{"part", "ref"}})}, {"b", from({{"part", "ref2"}})}, {"filter", "box"}, {"filter_width", 1}};
    // Jitter of an image that moved by it, in UV, y up.
    j["jitter"] = {{"units", "uv"},
                   {"y", "up"},
                   {"of", "image"},
                   {"sequence", "mine"},
                   {"offsets", {{0.25 / kWidth, 0.125 / kHeight}, {0, 0}}}};
    const ImportReport r = import(j);
    EXPECT_TRUE(r.passes.has(Pass::object));
    const ShotReader shot(folder / "out");
    EXPECT_TRUE(shot.hasCentreFrames());
    EXPECT_EQ(shot.manifest().frames[0].jitterPx, glm::dvec2(-0.25, 0.125));
    EXPECT_EQ(shot.manifest().frames[2].jitterPx, glm::dvec2(-0.25, 0.125)) << "the list repeats";
    EXPECT_EQ(shot.manifest().jitterPeriod, 2);
    EXPECT_TRUE(shot.readTruth(0)->a.samePixels(frames[0].colorLinear));
    EXPECT_EQ(shot.readTruth(0)->b.c[0].at(1, 1), 1);
    EXPECT_TRUE(shot.read(2, Pass::object).objectId.samePixels(frames[2].objectId));
}
TEST_F(Engine, WhatDoesNotFitIsNamed) {
    writeColour();
    const auto says = [&](const std::function<void(json&)>& change, const std::string& words) {
        json j = layout();
        change(j);
        const std::string found = refusal(j);
        EXPECT_NE(found.find(words), std::string::npos) << found << "\nexpected " << words;
    };
    says([](json& j) { j["format"] = "x"; }, "format: expected \"aaresolve-frames\", found \"x\"");
    says([](json& j) { j["pases"] = 1; }, "unknown member 'pases'; did you mean 'passes'?");
    says([](json& j) { j["passes"]["color"]["files"] = "color.exr"; }, "passes.color.files: expected a path");
    says([](json& j) { j["passes"]["color"]["files"] = "../{frame}.exr"; }, "passes.color.files: expected a path");
    says(
        [](json& j) {
            j["passes"]["color"]["channels"] = {"X", "Y", "Z"};
        },
        "expected channels X, Y, Z (the layout's), found R, G, B");
    says([](json& j) { j["passes"]["depth"] = source("color"); }, "passes.depth.kind: expected planar, distance");
    says([](json& j) { j["passes"]["depth"] = source("color"), j["passes"]["depth"]["kind"] = "device"; },
         "passes.depth.near: expected the distance of the near plane");
    says([](json& j) { j["passes"]["motion"] = source("color"); }, "passes.motion.units: expected px, uv or ndc");
    says([](json& j) { j["passes"]["albedo"] = source("albedo"); }, "no file is named albedo_{frame}.exr");
    says(
        [](json& j) {
            j["jitter"] = {{"units", "px"}, {"y", "down"}, {"of", "sample"}, {"offsets", {{3, 0}}}};
        },
        "jitter.offsets: expected offsets within half a pixel (is `units` right?)");
    says(
        [](json& j) {
            j["passes"]["depth"] = source("color"), j["passes"]["depth"]["kind"] = "distance";
            j["passes"]["depth"]["channels"] = {"R"}, j.erase("frames");
        },
        "needs the frame's perspective camera");
    says([](json& j) { j["fps"] = 1e7; }, "fps: expected frames per second in 0.001..1000000, found 10000000");
    says([](json& j) { j["fps"] = 1e-9; }, "fps: expected frames per second in 0.001..1000000");
    for (const double width : {-1.0, 1001.0})
        says(
            [&](json& j) {
                j["truth"] = {{"a", source("color")}, {"filter_width", width}};
            },
            "truth.filter_width: expected a width in px, 0..1000");
    fs::remove(folder / "engine/color_2.exr");
    json gap = layout();
    EXPECT_TRUE(import(gap, "gap").manifest.frames[1].reset) << "a frame is missing: no history over the gap";
    writeParts(folder / "engine/color_3.exr", {{"", {{"R", &frames[0].depthView}}}});
    EXPECT_NE(refusal(gap).find("color_3.exr: expected channels R, G, B"), std::string::npos);
}

// Data that lies elsewhere than its display window shows would be held against the wrong pixels.
TEST_F(Engine, WhatIsNotTheWholePictureIsRefused) {
    const auto from = [&](const Window& shown) {
        for (const Frame& f : frames) {
            const Rgb& c = f.colorLinear;
            writeParts(folder / "engine" / ("color_" + std::to_string(f.number) + ".exr"),
                       {{"", {{"R", &c.c[0]}, {"G", &c.c[1]}, {"B", &c.c[2]}}, {}, shown}});
        }
        return refusal(layout());
    };
    EXPECT_NE(from({-10, -8, 64, 48})
                  .find("color_1.exr: frame 1: expected a data window that is the display window (64 x 48 px), found "
                        "32 x 20 px at 10, 8; write whole frames"),
              std::string::npos);
    EXPECT_NE(from({-10, 0, kWidth, kHeight}).find("found 32 x 20 px at 10, 0"), std::string::npos) << "only moved";
    EXPECT_NE(from({4, 4, 24, 12}).find("found 32 x 20 px at -4, -4"), std::string::npos) << "overscan";
    EXPECT_EQ(from({0, 0, kWidth, kHeight}), "");
    fs::remove_all(folder / "refused");
    // The first frame is whole, a later one is not.
    const Rgb& c = frames[2].colorLinear;
    writeParts(folder / "engine/color_3.exr",
               {{"", {{"R", &c.c[0]}, {"G", &c.c[1]}, {"B", &c.c[2]}}, {}, Window{-1, 0, kWidth, kHeight}}});
    EXPECT_NE(refusal(layout()).find("color_3.exr: frame 3: "), std::string::npos);
}
// An import that ends anywhere, and be it before its settings are written, goes on when it is called again.
TEST_F(Engine, AnImportThatHardlyBeganGoesOn) {
    writeColour();
    makeWritableFolder(folder / "early/.aa");
    EXPECT_EQ(import(layout(), "early").imported, size_t(kFrames));
    makeWritableFolder(folder / "writing/.aa");
    writeText(folder / "writing/.aa/.import.1234-1.partial.json", "{");
    EXPECT_EQ(import(layout(), "writing").imported, size_t(kFrames));
    const std::string noName(300, 'x');  // a folder that cannot be made, after one that can
    const json settings = {{"from", "a"}};
    EXPECT_THROW(ImportStore(folder / "folders", settings, {"frames", noName}), InputError);
    EXPECT_NO_THROW(ImportStore(folder / "folders", settings, {"frames"}));
    for (const char* foreign : {"foreign/.aa/notes", "foreign2/.aa/frames", "foreign3/.aa/../a"}) {
        makeWritableFolder(folder / foreign);
        EXPECT_THROW(import(layout(), fs::path(foreign).begin()->string()), UsageError) << foreign;
    }
}

}  // namespace
}  // namespace aa
