#include "shot/import/import.h"

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include "image/error.h"
#include "image/io.h"
#include "image/io_testing.h"
#include "shot/check/check.h"
#include "shot/import/blender_exr.h"
#include "shot/import/blender_motion.h"
#include "shot/import/folder.h"
#include "shot/import/frame.h"
#include "shot/import/pitfalls.h"
#include "shot/pass_table.h"
#include "shot/reader.h"
#include "shot/synth/synth.h"

namespace aa {
namespace {
namespace fs = std::filesystem;
using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

struct Channel {
    std::string name;
    PlaneF plane;
    bool half = false;
};
using Channels = std::vector<Channel>;

// A file as Blender writes it: one part, one picture, channels by name.
void writeNative(const fs::path& file, const Channels& channels, const std::map<std::string, std::string>& texts = {},
                 const char* compression = "zip") {
    const int w = channels[0].plane.width(), h = channels[0].plane.height(), n = int(channels.size());
    ImageSpec spec(w, h, n, TypeDesc::FLOAT);
    spec.channelnames.clear();
    for (const auto& c : channels) {
        spec.channelnames.push_back(c.name);
        spec.channelformats.push_back(c.half ? TypeDesc::HALF : TypeDesc::FLOAT);
    }
    spec.attribute("compression", compression);
    for (const auto& [key, value] : texts) spec.attribute(key, value);
    std::vector<float> pixels(size_t(w) * size_t(h) * size_t(n));
    for (int c = 0; c < n; c++)
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++)
                pixels[(size_t(y) * size_t(w) + size_t(x)) * size_t(n) + size_t(c)] =
                    channels[size_t(c)].plane.at(x, y);
    auto out = ImageOutput::create("exr");
    ASSERT_TRUE(out->open(file.string(), spec)) << out->geterror();
    ASSERT_TRUE(out->write_image(TypeDesc::FLOAT, pixels.data())) << out->geterror();
    ASSERT_TRUE(out->close());
}
PlaneF negated(PlaneF p) {
    for (int y = 0; y < p.height(); y++)
        for (int x = 0; x < p.width(); x++) p.at(x, y) = -p.at(x, y);
    return p;
}
PlaneF asFloat(const PlaneU& ids) {
    PlaneF p(ids.width(), ids.height());
    for (int y = 0; y < p.height(); y++)
        for (int x = 0; x < p.width(); x++) p.at(x, y) = float(ids.at(x, y));
    return p;
}
// What Blender would have written for a frame: Vector is previous - current with y up.
Channels nativeOf(const Frame& f, const std::string& layer = "ViewLayer", bool newNames = false) {
    Channels c;
    const auto rgb = [&](const char* pass, const Rgb& image, const char* letters) {
        for (size_t i = 0; i < 3; i++) c.push_back({layer + "." + pass + "." + letters[i], image.c[i]});
    };
    const Rgb none(f.width, f.height);
    rgb("Combined", f.colorLinear, "RGB");
    c.push_back({layer + ".Combined.A", PlaneF(f.width, f.height, 1)});
    c.push_back({layer + ".Depth.Z", f.depthView});
    rgb("Normal", f.normalWorld, "XYZ");
    c.push_back({layer + ".Vector.X", negated(f.motionXPx)});
    c.push_back({layer + ".Vector.Y", f.motionYPx});
    c.push_back({layer + ".Vector.Z", PlaneF(f.width, f.height)});
    c.push_back({layer + ".Vector.W", PlaneF(f.width, f.height)});
    c.push_back({layer + (newNames ? ".Object Index.X" : ".IndexOB.X"), asFloat(f.objectId)});
    rgb("Denoising Albedo", f.albedoLinear, "RGB");
    rgb(newNames ? "Emission" : "Emit", none, "RGB");
    rgb(newNames ? "Environment" : "Env", f.albedoLinear, "RGB");
    return c;
}

class ImportTest : public testing::Test {
  protected:
    void SetUp() override {
        folder = fs::path(testing::TempDir()) /
                 (std::string("aa_import_") + testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder);
        fs::create_directories(folder / "in");
        options.from = folder / "in";
        options.out = folder / "shot";
    }
    void TearDown() override { fs::remove_all(folder); }

    static SynthShot shot(const char* scene = "moving", int frames = 4) {
        SynthOptions o;
        o.scene = scene;
        o.width = 96;
        o.height = 60;
        o.frames = frames;
        o.jitter = "none";
        return SynthShot(o);
    }
    fs::path file(int frame, const char* sub = "in") const {
        char name[32];
        std::snprintf(name, sizeof name, "render_%04d.exr", frame);
        return folder / sub / name;
    }
    void renderAll(const SynthShot& s, bool newNames = false) const {
        for (size_t i = 0; i < s.manifest().frames.size(); i++)
            writeNative(file(s.manifest().frames[i].frame), nativeOf(s.frame(i), "ViewLayer", newNames),
                        {{"cycles.ViewLayer.samples", "1"}});
    }
    void renderTruth(const SynthShot& s, const char* sub, float offset) const {
        fs::create_directories(folder / sub);
        for (size_t i = 0; i < s.manifest().frames.size(); i++) {
            Rgb truth = s.truth(i).a;
            for (auto& plane : truth.c) plane.at(3, 3) += offset;
            Channels c;
            for (size_t k = 0; k < 3; k++) c.push_back({std::string("ViewLayer.Combined.") + "RGB"[k], truth.c[k]});
            writeNative(file(s.manifest().frames[i].frame, sub), c, {{"cycles.ViewLayer.samples", "256"}});
        }
    }
    static std::string findings(const fs::path& shotFolder) {
        std::string s;
        for (const auto& f : checkShot(shotFolder).findings) s += f.line() + "\n";
        return s;
    }
    template <class Error>
    std::string refusal() const {
        try {
            importBlender(options);
        } catch (const Error& e) {
            return e.what();
        }
        return "not refused";
    }
    static std::map<std::string, std::string> contents(const fs::path& root) {
        std::map<std::string, std::string> r;
        for (const auto& e : fs::recursive_directory_iterator(root)) {
            if (!e.is_regular_file() || e.path().string().find(".aa") != std::string::npos) continue;
            std::ifstream in(e.path(), std::ios::binary);
            r[fs::relative(e.path(), root).string()] = {std::istreambuf_iterator<char>(in), {}};
        }
        return r;
    }
    fs::path folder;
    ImportOptions options;
};

TEST_F(ImportTest, EveryPassComesBackAsItWas) {
    for (const bool newNames : {false, true}) {
        const SynthShot original = shot();
        renderAll(original, newNames);
        const ImportReport r = importBlender(options);
        EXPECT_THAT(r.warnings, IsEmpty());
        EXPECT_EQ(r.manifest.frames.size(), 4u);
        EXPECT_FALSE(r.manifest.isStatic);
        EXPECT_EQ(findings(options.out), "");
        const ShotReader reader(options.out, InputPolicy::strict);
        const PassSet passes = reader.offered();
        EXPECT_EQ(passes, Pass::color | Pass::albedo | Pass::depth | Pass::normal | Pass::object | Pass::motion);
        for (size_t i = 0; i < 4; i++) {
            const Frame a = original.frame(i), b = reader.read(i, passes);
            EXPECT_EQ(a.number, b.number);
            EXPECT_EQ(b.reset, i == 0);
            EXPECT_TRUE(a.colorLinear.samePixels(b.colorLinear));
            EXPECT_TRUE(a.albedoLinear.samePixels(b.albedoLinear));
            EXPECT_TRUE(a.depthView.samePixels(b.depthView));
            EXPECT_TRUE(a.objectId.samePixels(b.objectId));
            EXPECT_TRUE(a.motionXPx.samePixels(b.motionXPx));
            EXPECT_TRUE(a.motionYPx.samePixels(b.motionYPx));
        }
        fs::remove_all(options.out);
    }
}

TEST_F(ImportTest, OnePartPerPass) {
    const SynthShot original = shot("moving", 1);
    const Channels all = nativeOf(original.frame(0));
    std::map<std::string, Channels> parts;
    for (const auto& c : all) parts[c.name.substr(0, c.name.rfind('.'))].push_back(c);
    std::vector<ImageSpec> specs;
    for (const auto& [name, channels] : parts) {
        ImageSpec spec(96, 60, int(channels.size()), TypeDesc::FLOAT);
        spec.channelnames.clear();
        for (const auto& c : channels) spec.channelnames.push_back(c.name.substr(c.name.rfind('.') + 1));
        spec.attribute("oiio:subimagename", name);
        specs.push_back(spec);
    }
    auto out = ImageOutput::create("exr");
    size_t i = 0;
    for (const auto& [name, channels] : parts) {
        ASSERT_TRUE(i == 0 ? out->open(file(1).string(), int(specs.size()), specs.data())
                           : out->open(file(1).string(), specs[i], ImageOutput::AppendSubimage));
        std::vector<float> pixels;
        for (int y = 0; y < 60; y++)
            for (int x = 0; x < 96; x++)
                for (const auto& c : channels) pixels.push_back(c.plane.at(x, y));
        ASSERT_TRUE(out->write_image(TypeDesc::FLOAT, pixels.data()));
        i++;
    }
    out->close();
    importBlender(options);
    const Frame b = ShotReader(options.out).read(0, Pass::color | Pass::motion | Pass::object);
    EXPECT_TRUE(original.frame(0).objectId.samePixels(b.objectId));
    EXPECT_TRUE(original.frame(0).motionXPx.samePixels(b.motionXPx));
}

TEST_F(ImportTest, SeveralViewLayersAskForAChoice) {
    const SynthShot original = shot("moving", 1);
    Channels both = nativeOf(original.frame(0), "Main.v2");
    for (auto& c : nativeOf(original.frame(0), "Hair")) {
        if (c.name.find("Combined") != std::string::npos) c.plane = negated(c.plane);
        both.push_back(c);
    }
    writeNative(file(1), both);
    EXPECT_THAT(refusal<UsageError>(), AllOf(HasSubstr("'Main.v2'"), HasSubstr("'Hair'"), HasSubstr("--view-layer")));
    options.viewLayer = "Wool";
    EXPECT_THAT(refusal<UsageError>(), HasSubstr("but not 'Wool'"));
    options.viewLayer = "Main.v2";
    importBlender(options);
    EXPECT_TRUE(original.frame(0).colorLinear.samePixels(ShotReader(options.out).read(0, Pass::color).colorLinear));
}

TEST_F(ImportTest, TheCompositorsLayerIsNoChoice) {
    Channels c = nativeOf(shot("moving", 1).frame(0));
    c.push_back({"Composite.Combined.R", PlaneF(96, 60)});
    writeNative(file(1), c);
    EXPECT_NO_THROW(importBlender(options));
}

TEST_F(ImportTest, ViewsAskForAChoice) {
    Channels c;
    for (const char* view : {"left", "right"})
        for (const auto& channel : nativeOf(shot("moving", 1).frame(0))) {
            const size_t dot = channel.name.rfind('.');
            c.push_back({channel.name.substr(0, dot) + "." + view + channel.name.substr(dot), channel.plane});
        }
    writeNative(file(1), c);
    EXPECT_THAT(refusal<UsageError>(), AllOf(HasSubstr("'left', 'right'"), HasSubstr("--view")));
    options.view = "right";
    EXPECT_NO_THROW(importBlender(options));
}

TEST_F(ImportTest, MissingPassesAreNamed) {
    const SynthShot original = shot();
    for (size_t i = 0; i < 4; i++) {
        Channels c = nativeOf(original.frame(i));
        std::erase_if(c, [](const auto& x) { return x.name.find("Combined") == std::string::npos; });
        writeNative(file(int(i) + 1), c);
    }
    const ImportReport r = importBlender(options);
    std::vector<Pass> missing;
    for (const auto& m : r.missing) missing.push_back(m.pass);
    EXPECT_EQ(missing.size(), allPasses().size() - 1);  // all but the colour
    for (const auto& info : allPasses())
        if (info.pass != Pass::color) {
            EXPECT_THAT(missing, Contains(info.pass)) << info.name;
        }
    EXPECT_THAT(r.missing[1].advice, HasSubstr("Passes > Data > Z"));
    EXPECT_EQ(ShotReader(options.out).offered(), PassSet(Pass::color));
    EXPECT_EQ(findings(options.out), "");
}

TEST_F(ImportTest, AFrameThatLacksAPassOfTheOthers) {
    const SynthShot original = shot("moving", 2);
    renderAll(original);
    Channels c = nativeOf(original.frame(1));
    std::erase_if(c, [](const auto& x) { return x.name.find("Depth") != std::string::npos; });
    writeNative(file(2), c);
    EXPECT_THAT(refusal<InputError>(), AllOf(HasSubstr("render_0002.exr"), HasSubstr("'Depth'")));
}

TEST_F(ImportTest, NotMultilayer) {
    writePng(folder / "in" / "0001.png", Rgb(8, 8));
    EXPECT_THAT(refusal<InputError>(), AllOf(HasSubstr("1 PNG"), HasSubstr("tone-mapped")));
    writeExr(folder / "in" / "0001.exr", Rgb(8, 8), false);
    EXPECT_THAT(refusal<InputError>(), AllOf(HasSubstr("found R G B"), HasSubstr("OpenEXR MultiLayer")));
    options.from = folder / "nowhere";
    EXPECT_THAT(refusal<InputError>(), HasSubstr("no such folder"));
}

TEST_F(ImportTest, FrameNumbers) {
    EXPECT_EQ(frameNumberOf("shot_v2_0013.exr"), 13);
    EXPECT_EQ(frameNumberOf("0007.exr"), 7);
    EXPECT_EQ(frameNumberOf("picture.exr"), std::nullopt);
    EXPECT_EQ(frameNumberOf("99999999999999999999.exr"), std::nullopt);
    EXPECT_EQ(frameNumberOf("-00005.png"), -5);
    EXPECT_EQ(frameNumberOf("shot_-0005.png"), -5);
    EXPECT_EQ(frameNumberOf("shot-0004.png"), 4);
    const Channels c = nativeOf(shot("moving", 1).frame(0));
    writeNative(folder / "in" / "picture.exr", c, {{"Frame", "0042"}});
    EXPECT_EQ(renderedFrames(folder / "in").begin()->first, 42);
    writeNative(folder / "in" / "other_042.exr", c);
    EXPECT_THAT(refusal<InputError>(),
                AllOf(HasSubstr("other_042.exr"), HasSubstr("picture.exr"), HasSubstr("frame 42")));
}

// Blender writes frame -4 of "render_" as render_-0004.exr, and its header says which frame it is.
TEST_F(ImportTest, FrameNumbersThatANameAloneDoesNotTell) {
    const Channels c = nativeOf(shot("moving", 1).frame(0));
    const auto frameOf = [&](const char* name, const char* header) {
        fs::remove_all(folder / "in");
        fs::create_directories(folder / "in");
        writeNative(
            folder / "in" / name, c,
            header ? std::map<std::string, std::string>{{"Frame", header}} : std::map<std::string, std::string>{});
        return renderedFrames(folder / "in").begin()->first;
    };
    EXPECT_EQ(frameOf("shot-0004.exr", nullptr), 4);
    EXPECT_EQ(frameOf("shot-0004.exr", "0004"), 4);
    EXPECT_EQ(frameOf("0007_v2.exr", "0007"), 7);
    EXPECT_EQ(frameOf("0107.exr", "0007"), 107);  // numbered anew: the name counts
    for (const auto& [name, header] : {std::pair<const char*, const char*>{"-0004.exr", nullptr},
                                       {"shot_-0004.exr", nullptr},
                                       {"shot-0004.exr", "-004"},
                                       {"picture.exr", "-004"}})
        try {
            frameOf(name, header);
            ADD_FAILURE() << name;
        } catch (const InputError& e) {
            EXPECT_THAT(e.what(), AllOf(HasSubstr(name), HasSubstr("before 0")));
        }
}

TEST_F(ImportTest, ALayerCalledLikeAPassKeepsAllItsPasses) {
    const Frame f = shot("moving", 1).frame(0);
    for (const char* layer : {"Layer.Normal", "Depth", "A.Combined.B", "Vector"}) {
        writeNative(file(1), nativeOf(f, layer));
        BlenderExr exr(file(1));
        EXPECT_THAT(exr.layers(), ::testing::ElementsAre(layer));
        exr.choose("", "");
        for (const BlenderPass pass : {BlenderPass::combined, BlenderPass::depth, BlenderPass::normal,
                                       BlenderPass::vector, BlenderPass::objectIndex, BlenderPass::denoisingAlbedo})
            EXPECT_TRUE(exr.has(pass)) << layer << " " << blenderPass(pass).names[0];
    }
}

TEST_F(ImportTest, ANameWithAQuoteCostsNoOtherName) {
    const Frame f = shot("moving", 1).frame(0);
    const std::string key = "cryptomatte/abcdef0";
    const auto namesOf = [&](const std::string& list, std::vector<std::string>& notes) {
        writeNative(file(1), nativeOf(f), {{key + "/name", "ViewLayer.CryptoObject"}, {key + "/manifest", list}});
        return cryptomatteNames(BlenderExr(file(1)), notes);
    };
    std::vector<std::string> notes;
    const std::map<uint32_t, std::string> plain = {{0x1au, "Cube"}, {0x2bu, "Wall"}};
    EXPECT_EQ(namesOf(R"({"Cube":"0000001a","Wall":"0000002b"})", notes), plain);
    EXPECT_THAT(notes, IsEmpty());
    const std::map<uint32_t, std::string> all = {{0x1au, "Cube"}, {0x3cu, "Monitor 24\""}, {0x2bu, "Wall"}};
    EXPECT_EQ(namesOf(R"({"Cube":"0000001a","Monitor 24"":"0000003c","Wall":"0000002b"})", notes), all);
    EXPECT_THAT(notes, Contains(HasSubstr("3 names")));
    notes.clear();
    EXPECT_EQ(namesOf(R"({"Cube":"0000001a","W\all":"0000002b","a":"b)", notes).at(0x2b), R"(W\all)");
}

// What a frame may be that is no plain picture: said by what it is, or read.
TEST_F(ImportTest, TiledFramesAreReadAndOthersNamed) {
    const SynthShot original = shot("moving", 1);
    const Channels channels = nativeOf(original.frame(0));
    const int w = channels[0].plane.width(), h = channels[0].plane.height(), n = int(channels.size());
    const auto write = [&](int tile, int x, int fullWidth) {
        ImageSpec spec(w, h, n, TypeDesc::FLOAT);
        spec.channelnames.clear();
        for (const auto& c : channels) spec.channelnames.push_back(c.name);
        spec.tile_width = spec.tile_height = tile;
        spec.x = x, spec.full_width = fullWidth;
        std::vector<float> pixels;
        for (int y = 0; y < h; y++)
            for (int i = 0; i < w; i++)
                for (const auto& c : channels) pixels.push_back(c.plane.at(i, y));
        auto out = ImageOutput::create("exr");
        ASSERT_TRUE(out->open(file(1).string(), spec)) << out->geterror();
        ASSERT_TRUE(out->write_image(TypeDesc::FLOAT, pixels.data())) << out->geterror();
        ASSERT_TRUE(out->close());
    };
    write(16, 0, w);
    EXPECT_EQ(importBlender(options).manifest.frames.size(), 1u);
    EXPECT_TRUE(ShotReader(options.out).read(0, Pass::color).colorLinear.samePixels(original.frame(0).colorLinear));
    fs::remove_all(options.out);
    write(0, 0, 2 * w);
    EXPECT_THAT(refusal<InputError>(), HasSubstr("a region of the picture"));
    write(0, -8, w - 16);
    EXPECT_THAT(refusal<InputError>(), HasSubstr("overscan"));
}

TEST_F(ImportTest, GapsResetTheHistory) {
    renderAll(shot());
    fs::remove(file(2));
    const ImportReport r = importBlender(options);
    EXPECT_TRUE(r.manifest.frames[1].reset);
    EXPECT_FALSE(r.manifest.frames[2].reset);
    EXPECT_EQ(findings(options.out), "");
}

TEST_F(ImportTest, AStoppedImportGoesOnToTheSameFiles) {
    const SynthShot original = shot();
    renderAll(original);
    renderTruth(original, "a", 0);
    renderTruth(original, "b", 0.01f);
    options.truth = {folder / "a", folder / "b"};
    importBlender(options);
    const auto whole = contents(options.out);
    fs::remove_all(options.out);
    ImportReport r = importBlender(options, [](int frame) { return frame < 2; });
    EXPECT_FALSE(r.complete);
    EXPECT_EQ(ShotReader(options.out).manifest().frames.size(), 2u);
    fs::remove(options.out / "frames" / "000001.exr");                    // lost,
    fs::resize_file(options.out / "truth" / "000002.exr", 1000);          // cut short
    std::ofstream(leftover(options.out / "frames" / "000003.exr")) << 1;  // and what a killed import leaves
    r = importBlender(options);
    EXPECT_EQ(r.kept, 1u);
    EXPECT_EQ(r.imported, 3u);
    EXPECT_EQ(contents(options.out), whole);
    // A frame that was rendered again is imported again.
    Channels c = nativeOf(original.frame(3));
    c[0].plane.at(0, 0) = 7;
    writeNative(file(4), c);
    EXPECT_EQ(importBlender(options).imported, 1u);
    EXPECT_EQ(ShotReader(options.out).read(3, Pass::color).colorLinear.c[0].at(0, 0), 7);
}

TEST_F(ImportTest, ForeignFoldersAndOtherSettingsAreRefused) {
    renderAll(shot());
    fs::create_directories(options.out);
    writeText(options.out / "mine.txt", "precious");
    EXPECT_THAT(refusal<UsageError>(), HasSubstr("is not empty and holds no import"));
    EXPECT_EQ(contents(options.out).size(), 1u);
    fs::remove(options.out / "mine.txt");
    importBlender(options);
    options.truth = {options.from, options.from};
    EXPECT_THAT(refusal<UsageError>(), HasSubstr("another setting 'truth'"));
}

TEST_F(ImportTest, TruthHasTwoHalvesOrNoErrorBar) {
    const SynthShot original = shot();
    renderAll(original);
    renderTruth(original, "a", 0);
    renderTruth(original, "b", 0.01f);
    options.truth = {folder / "a", folder / "b"};
    options.truthFilter = "box";
    options.truthFilterWidthPx = 1;
    ImportReport r = importBlender(options);
    EXPECT_EQ(r.manifest.truthSamplesPerHalf, 256);
    EXPECT_EQ(findings(options.out), "");  // the jitter is registered against this truth
    const Truth t = *ShotReader(options.out).readTruth(2);
    EXPECT_TRUE(t.a.samePixels(original.truth(2).a));
    EXPECT_FALSE(t.b.samePixels(t.a));
    options.out = folder / "one";
    options.truth = {folder / "a"};
    EXPECT_THAT(importBlender(options).warnings, Contains(HasSubstr("one folder of truth")));
    options.out = folder / "same";
    options.truth = {folder / "a", folder / "a"};
    EXPECT_THAT(refusal<InputError>(), HasSubstr("another seed"));
    options.out = folder / "incomplete";
    options.truth = {folder / "a", folder / "b"};
    fs::remove(file(3, "b"));
    EXPECT_THAT(refusal<InputError>(), HasSubstr("has no frame 3"));
}

TEST_F(ImportTest, AStaticShotIsFoundAndSharesItsTruth) {
    const SynthShot original = shot("circles");
    renderAll(original);
    renderTruth(original, "a", 0);
    fs::remove(file(3, "a"));
    fs::remove(file(4, "a"));
    options.truth = {folder / "a"};
    const ImportReport r = importBlender(options);
    EXPECT_TRUE(r.manifest.isStatic);
    EXPECT_EQ(r.manifest.frames[3].truth, r.manifest.frames[0].truth);
    EXPECT_EQ(findings(options.out), "");
}

TEST_F(ImportTest, MovingFramesAreNotStatic) {
    renderAll(shot());
    options.isStatic = true;
    EXPECT_THAT(refusal<InputError>(), AllOf(HasSubstr("frame 1"), HasSubstr("--static")));
}

TEST_F(ImportTest, ObjectsWithoutAPassIndex) {
    const SynthShot original = shot();
    for (size_t i = 0; i < 4; i++) {
        Channels c = nativeOf(original.frame(i));
        for (auto& channel : c)
            if (channel.name == "ViewLayer.IndexOB.X")
                for (int y = 0; y < 60; y++)
                    for (int x = 0; x < 96; x++)
                        if (channel.plane.at(x, y) == 1) channel.plane.at(x, y) = 0;
        writeNative(file(int(i) + 1), c);
    }
    const ImportReport r = importBlender(options);
    EXPECT_THAT(r.notes, Contains(HasSubstr("share the id 32768")));
    EXPECT_EQ(r.manifest.objects.at(kNoPassIndex), "objects without a pass index");
    EXPECT_EQ(findings(options.out), "");
}

TEST_F(ImportTest, IdsFromCryptomatte) {
    const auto hashed = [](float id) {
        return id == 0 ? 0.0f : std::bit_cast<float>(0x3f000000u + uint32_t(id) * 977u);
    };
    const SynthShot original = shot();
    for (size_t i = 0; i < 4; i++) {
        Channels c = nativeOf(original.frame(i));
        PlaneF hash(96, 60);
        for (auto& channel : c)
            if (channel.name == "ViewLayer.IndexOB.X")
                for (int y = 0; y < 60; y++)
                    for (int x = 0; x < 96; x++) {
                        hash.at(x, y) = hashed(channel.plane.at(x, y));
                        channel.plane.at(x, y) = 0;
                    }
        c.push_back({"ViewLayer.CryptoObject00.r", hash});
        writeNative(file(int(i) + 1), c,
                    {{"cryptomatte/17/name", "ViewLayer.CryptoObject"},
                     {"cryptomatte/17/manifest", "{\"Wall\":\"3f0003d1\"}"}});
    }
    const ImportReport r = importBlender(options);
    EXPECT_EQ(r.manifest.objects.at(0x3f000000u + 977u), "Wall");
    EXPECT_THAT(r.notes, Contains(HasSubstr("Cryptomatte")));
    EXPECT_EQ(findings(options.out), "");
}

TEST_F(ImportTest, WarnsOfMotionBlur) {
    const SynthShot original = shot();
    for (size_t i = 0; i < 4; i++) {
        Channels c = nativeOf(original.frame(i));
        for (auto& channel : c)
            if (channel.name.find("Vector") != std::string::npos) channel.plane = PlaneF(96, 60);
        writeNative(file(int(i) + 1), c);
    }
    const ImportReport r = importBlender(options);
    EXPECT_THAT(r.warnings, Contains(HasSubstr("motion blur was on")));
    EXPECT_FALSE(r.manifest.isStatic);
}

TEST_F(ImportTest, WarnsOfAntiAliasedColours) {
    const SynthShot original = shot();
    for (size_t i = 0; i < 4; i++) {
        Frame f = original.frame(i);
        f.colorLinear = original.truth(i).a;
        writeNative(file(int(i) + 1), nativeOf(f), {{"cycles.ViewLayer.samples", "128"}});
    }
    const ImportReport r = importBlender(options);
    EXPECT_THAT(r.warnings, Contains(HasSubstr("anti-aliased already, and no method")));
    EXPECT_THAT(r.warnings, Contains(HasSubstr("rendered with 128 samples")));
}

TEST_F(ImportTest, WarnsOfLossyFiles) {
    Channels c = nativeOf(shot("moving", 1).frame(0));
    for (auto& channel : c)
        if (channel.name == "ViewLayer.Depth.Z") channel.half = true;
    writeNative(file(1), c, {}, "dwaa:45");
    const ImportReport r = importBlender(options);
    EXPECT_THAT(r.warnings, Contains(HasSubstr("DWA compression")));
    EXPECT_THAT(r.warnings, Contains(HasSubstr("depth is stored as half float")));
}

TEST_F(ImportTest, JitterAndCamerasComeFromFiles) {
    SynthOptions o;
    o.scene = "moving";
    o.width = 96;
    o.height = 60;
    o.frames = 4;
    const SynthShot original(o);  // jittered
    renderAll(original);
    Manifest m = original.manifest();
    m.folder = folder;
    writeManifest(m);
    options.jitter = options.camera = folder / "shot.json";
    const ImportReport r = importBlender(options);
    EXPECT_EQ(r.manifest.jitterSequence, "halton23");
    EXPECT_EQ(r.manifest.frames[2].jitterPx, m.frames[2].jitterPx);
    EXPECT_EQ(r.manifest.frames[1].camera->projection, m.frames[1].camera->projection);
    EXPECT_EQ(findings(options.out), "");
    m.frames.pop_back();
    writeManifest(m);
    options.out = folder / "again";
    EXPECT_THAT(refusal<InputError>(), AllOf(HasSubstr("shot.json"), HasSubstr("frame 4")));
}

// Blender 3.4 projects the previous position with the current lens, 4.3 with the previous one, both with the current
// shift; the background has no vector that counts. A third of the picture moves by itself.
TEST(BlenderMotion, ZoomsAndBackgroundFollowTheMatrices) {
    constexpr int w = 64, h = 36;
    for (const bool perspective : {true, false})
        for (const bool previousLens : {false, true}) {
            if (previousLens && !perspective) continue;
            Camera now, before;
            now.kind = before.kind = perspective ? "perspective" : "orthographic";
            const auto project = [&](double size, double shift) {
                glm::dmat4 p = perspective ? glm::perspective(size, double(w) / h, 0.1, 100.0)
                                           : glm::ortho(-size * 9, size * 9, -size * 5, size * 5, 0.1, 100.0);
                p[perspective ? 2 : 3][0] += shift;
                return p;
            };
            now.projection = project(0.7, 0.1);
            before.projection = project(0.8, -0.05);
            glm::dmat4 asCyclesSees = now.projection;
            if (previousLens)
                asCyclesSees[0][0] = before.projection[0][0], asCyclesSees[1][1] = before.projection[1][1];
            now.view = glm::rotate(glm::dmat4(1.0), 0.3, glm::dvec3(0.2, 1, 0.1));
            before.view =
                glm::translate(glm::rotate(glm::dmat4(1.0), 0.25, glm::dvec3(0.2, 1, 0.1)), glm::dvec3(0.1, 0.2, 0));
            const auto positionOf = [&](const glm::dmat4& projection, const glm::dmat4& view, glm::dvec4 world) {
                const glm::dvec4 clip = projection * view * world;
                return glm::dvec2((clip.x / clip.w + 1) / 2 * w, (1 - clip.y / clip.w) / 2 * h);
            };
            const glm::dvec2 jitter(0.2, -0.3);
            PlaneF x(w, h), y(w, h), depth(w, h, 5), expectedX(w, h), expectedY(w, h);
            for (int j = 0; j < h; j++)
                for (int i = 0; i < w; i++) {
                    const glm::dvec2 p = glm::dvec2(i + 0.5, j + 0.5) + jitter;
                    const glm::dvec4 ndc(2 * p.x / w - 1, 1 - 2 * p.y / h, 0, 1);
                    glm::dvec4 viewPoint = glm::inverse(now.projection) * ndc;
                    viewPoint /= viewPoint.w;
                    const bool background = (i + j) % 3 == 0;
                    if (perspective) viewPoint *= (background ? 1e7 : 5.0) / -viewPoint.z;
                    viewPoint.w = 1;
                    const glm::dvec4 world = glm::inverse(now.view) * viewPoint;
                    const glm::dvec4 was = world - glm::dvec4(i % 3 == 0 && !background ? 0.7 : 0.0, 0, 0, 0);
                    const glm::dvec2 previous = positionOf(before.projection, before.view, was);
                    const glm::dvec2 seen = positionOf(asCyclesSees, before.view, was);
                    depth.at(i, j) = background ? 1e10f : 5.0f;
                    const float unused = previousLens ? 7.0f : 0.0f;  // what 5.2 writes there is not read
                    x.at(i, j) = background ? unused : float(seen.x - p.x);
                    y.at(i, j) = background ? unused : float(p.y - seen.y);
                    const bool rests = background && !perspective;  // one direction for the whole picture
                    expectedX.at(i, j) = rests ? 0 : float(p.x - previous.x);
                    expectedY.at(i, j) = rests ? 0 : float(p.y - previous.y);
                }
            motionFromVector(x, y, depth, jitter, now, before);
            for (int j = 0; j < h; j++)
                for (int i = 0; i < w; i++) {
                    EXPECT_NEAR(x.at(i, j), expectedX.at(i, j), 1e-3) << perspective << i << " " << j;
                    EXPECT_NEAR(y.at(i, j), expectedY.at(i, j), 1e-3) << perspective << i << " " << j;
                }
        }
}

TEST(BlenderAlbedo, FollowsTheRecipe) {
    const auto one = [](float r, float g, float b) {
        Rgb p(1, 1);
        p.c[0].at(0, 0) = r, p.c[1].at(0, 0) = g, p.c[2].at(0, 0) = b;
        return p;
    };
    const auto red = [&](const AlbedoPasses& p, float depth) {
        return unlitAlbedo(p, PlaneF(1, 1, depth), one(9, 9, 9)).c[0].at(0, 0);
    };
    AlbedoPasses p{one(.84f, .44f, .24f), one(0, 0, 0), one(.8f, .4f, .2f),
                   one(1, 1, 1),          one(0, 0, 0), one(.2f, .3f, .4f)};
    EXPECT_FLOAT_EQ(red(p, 5), .84f);
    EXPECT_FLOAT_EQ(red(p, 1e10f), .2f);  // background: the world
    p.emission = one(.5f, 0, 0);          // contained in the denoising albedo
    EXPECT_FLOAT_EQ(red(p, 5), .34f);
    p = {one(.9f, .8f, .7f), one(.9f, .8f, .7f), one(0, 0, 0), one(0, 0, 0), one(0, 0, 0), {}};
    EXPECT_FLOAT_EQ(red(p, 5), .9f);    // only emits
    EXPECT_FLOAT_EQ(red(p, 1e10f), 9);  // no Env: what the picture shows
    p = {one(0, 0, 0), one(0, 0, 0), one(0, 0, 0), one(.03f, .03f, .03f), one(.87f, .77f, .68f), {}};
    EXPECT_FLOAT_EQ(red(p, 5), .9f);  // clear glass
    p = {{}, {}, one(.8f, .4f, .2f), {}, {}, {}};
    EXPECT_FLOAT_EQ(red(p, 5), .8f);  // no Denoising Albedo
}

TEST(ImportPitfalls, EdgesThatAreSharpOrBlended) {
    SynthOptions o;
    o.scene = "circles";  // no edge along a border of pixels
    o.jitter = "none";
    o.width = 240;
    o.height = 150;
    const SynthShot s(o);
    EXPECT_FALSE(countEdges(s.frame(0).colorLinear).isAntiAliased());
    EXPECT_GT(countEdges(s.frame(0).colorLinear).sharp, EdgeCounts::kFewest);
    EXPECT_TRUE(countEdges(s.truth(0).a).isAntiAliased());
    EXPECT_EQ(changedShare(s.frame(0), s.frame(1)), 0);
    o.jitter = "halton23";
    const SynthShot jittered(o);
    EXPECT_LT(changedShare(jittered.frame(0), jittered.frame(1)), kChangedShareJittered / 2);
    o.scene = "moving";
    const SynthShot moving(o);
    EXPECT_GT(changedShare(moving.frame(0), moving.frame(1)), kChangedShare);
}
}  // namespace
}  // namespace aa
