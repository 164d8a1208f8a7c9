#include "shot/reader.h"

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "image/error.h"
#include "image/exr.h"
#include "image/io_testing.h"
#include "shot/frame_stream.h"
#include "shot/pass_table.h"
#include "shot/segments.h"
#include "shot/writer.h"

namespace aa {
namespace {
namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr int kWidth = 37, kHeight = 150;  // odd, and more rows than one block of the reader

float value(int seed, int x, int y) { return 0.01f + float((x * 7 + y * 13 + seed * 29) % 997) / 997.0f; }
PlaneF plane(int seed) {
    PlaneF p(kWidth, kHeight);
    for (int y = 0; y < kHeight; y++)
        for (int x = 0; x < kWidth; x++) p.at(x, y) = value(seed, x, y);
    return p;
}
PlaneU ids(uint32_t seed) {
    PlaneU p(kWidth, kHeight);
    for (int y = 0; y < kHeight; y++)
        for (int x = 0; x < kWidth; x++)
            p.at(x, y) = 0xfffffff0u - seed - uint32_t(x * y);  // not representable in float
    return p;
}
Rgb rgb(int seed) {
    Rgb r;
    for (int c = 0; c < 3; c++) r.c[size_t(c)] = plane(seed + c);
    return r;
}
const PassSet kAll = Pass::color | Pass::albedo | Pass::depth | Pass::normal | Pass::object | Pass::motion |
                     Pass::subsamples | Pass::subsampleColor | Pass::edges | Pass::segments;

Frame fullFrame(int seed) {
    Frame f;
    f.width = kWidth;
    f.height = kHeight;
    f.passes = kAll;
    f.colorLinear = rgb(seed);
    f.albedoLinear = rgb(seed + 3);
    f.depthView = plane(seed + 6);
    f.depthView.at(3, 4) = kBackgroundDepth;
    f.normalWorld = rgb(seed + 7);
    f.objectId = ids(uint32_t(seed));
    f.motionXPx = plane(seed + 10);
    f.motionYPx = plane(seed + 11);
    f.subSampleMask = ids(77);
    for (int k = 0; k < 2; k++)
        f.subSamples.push_back({plane(seed + 12 + k), rgb(seed + 14 + k), ids(uint32_t(k)), rgb(seed + 20 + k)});
    f.edgeXPx = plane(seed + 30);
    f.edgeYPx = plane(seed + 31);
    for (int i = 0; i < kSegmentsPerRow + 3; i++)  // more than one row
        f.segments.push_back({float(i), -0.5f, 2, 3.25f, float(seed), float(i + 1)});
    return f;
}

// A shot of three frames in a folder of its own, removed at the end.
class ReaderTest : public testing::Test {
  protected:
    void SetUp() override {
        folder = fs::path(testing::TempDir()) /
                 (std::string("aa_reader_") + testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(folder);
        manifest.folder = folder;
        manifest.width = kWidth;
        manifest.height = kHeight;
        manifest.subsamplePattern = "d3d2";
        manifest.subsamplePositionsPx = {{0.25, 0.25}, {-0.25, -0.25}};
        for (int n = 1; n <= 3; n++) {
            FrameEntry e;
            e.frame = n;
            e.file = std::to_string(n) + ".exr";
            e.truth = "truth.exr";
            e.reset = n == 1;
            e.camera = Camera{};
            e.camera->nearClip = n;
            manifest.frames.push_back(e);
            writeFrame(folder / e.file, fullFrame(n), true);
        }
        writeTruth(folder / "truth.exr", {rgb(1), rgb(2)});
        writeManifest(manifest);
    }
    void TearDown() override { fs::remove_all(folder); }

    std::string errorOf(PassSet passes = kAll, InputPolicy policy = InputPolicy::sanitise) {
        try {
            ShotReader(folder, policy).read(0, passes);
        } catch (const InputError& e) {
            EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
            return e.what();
        }
        return "no error";
    }
    void write(const Frame& f) { writeFrame(folder / "1.exr", f, true); }
    void truncate(const char* file, double share) {
        fs::resize_file(folder / file, uintmax_t(double(fs::file_size(folder / file)) * share));
    }

    fs::path folder;
    Manifest manifest;
};

TEST_F(ReaderTest, EveryPassComesBackBitForBit) {
    const Frame f = ShotReader(folder).read(0, kAll), e = fullFrame(1);
    EXPECT_TRUE(f.colorLinear.samePixels(e.colorLinear));
    EXPECT_TRUE(f.albedoLinear.samePixels(e.albedoLinear));
    EXPECT_TRUE(f.depthView.samePixels(e.depthView));
    EXPECT_TRUE(f.normalWorld.samePixels(e.normalWorld));
    EXPECT_TRUE(f.objectId.samePixels(e.objectId));
    EXPECT_TRUE(f.motionXPx.samePixels(e.motionXPx));
    EXPECT_TRUE(f.motionYPx.samePixels(e.motionYPx));
    EXPECT_TRUE(f.subSampleMask.samePixels(e.subSampleMask));
    ASSERT_EQ(f.subSamples.size(), 2u);
    for (size_t k = 0; k < 2; k++) {
        EXPECT_TRUE(f.subSamples[k].depthView.samePixels(e.subSamples[k].depthView));
        EXPECT_TRUE(f.subSamples[k].normalWorld.samePixels(e.subSamples[k].normalWorld));
        EXPECT_TRUE(f.subSamples[k].objectId.samePixels(e.subSamples[k].objectId));
        EXPECT_TRUE(f.subSamples[k].colorLinear.samePixels(e.subSamples[k].colorLinear));
    }
    EXPECT_TRUE(f.edgeXPx.samePixels(e.edgeXPx));
    EXPECT_TRUE(f.edgeYPx.samePixels(e.edgeYPx));
    EXPECT_EQ(f.segments, e.segments);
    EXPECT_EQ(f.depthView.at(-kBorderX, -kBorderY), f.depthView.at(0, 0));  // borders repeat the edge
    EXPECT_EQ(f.objectId.at(kWidth, kHeight + kBorderY - 1), f.objectId.at(kWidth - 1, kHeight - 1));
    EXPECT_FALSE(hasTemporaryFiles(folder));
}

TEST_F(ReaderTest, OnlyWhatIsWantedIsDecoded) {
    const Frame f = ShotReader(folder).read(0, Pass::color | Pass::subsampleColor);
    EXPECT_FALSE(f.colorLinear.empty());
    EXPECT_TRUE(f.depthView.empty());
    EXPECT_TRUE(f.objectId.empty());
    EXPECT_TRUE(f.subSampleMask.empty());
    ASSERT_EQ(f.subSamples.size(), 2u);
    EXPECT_FALSE(f.subSamples[1].colorLinear.empty());
    EXPECT_TRUE(f.subSamples[1].depthView.empty());
    EXPECT_EQ(f.passes, Pass::color | Pass::subsampleColor);
    EXPECT_EQ(ShotReader(folder).offered(), kAll);
}

TEST_F(ReaderTest, OfTheSubSamplesOnlyTheSharesThatAreWanted) {
    const ShotReader reader(folder);
    const Frame whole = reader.read(0, Pass::subsamples);
    const Frame depth = reader.read(0, Pass::subsampleDepth), mask = reader.read(0, Pass::subsampleMask);
    const Frame others = reader.read(0, Pass::subsampleNormal | Pass::subsampleObject);
    for (const Frame* f : {&whole, &depth, &mask, &others}) {
        EXPECT_EQ(f->subSamples.size(), 2u);
        EXPECT_EQ(f->subSamplePositionsPx, whole.subSamplePositionsPx);
    }
    for (size_t k = 0; k < 2; k++) {
        const SubSample &w = whole.subSamples[k], &d = depth.subSamples[k], &o = others.subSamples[k];
        EXPECT_TRUE(d.depthView.samePixels(w.depthView) && d.normalWorld.empty() && d.objectId.empty());
        EXPECT_TRUE(o.depthView.empty() && o.normalWorld.samePixels(w.normalWorld) &&
                    o.objectId.samePixels(w.objectId));
        EXPECT_TRUE(mask.subSamples[k].depthView.empty() && w.colorLinear.empty());
    }
    EXPECT_TRUE(depth.subSampleMask.empty() && others.subSampleMask.empty());
    EXPECT_TRUE(mask.subSampleMask.samePixels(whole.subSampleMask));
    EXPECT_EQ(listOf(Pass::subsampleDepth), "subsamples");
    EXPECT_EQ(bytesPerPixel(Pass::subsampleDepth, 8), 32);
    EXPECT_EQ(bytesPerPixel(Pass::subsampleMask, 8), 4);
    EXPECT_EQ(bytesPerPixel(Pass::subsamples, 8), 8 * 20 + 4);
}
TEST_F(ReaderTest, CamerasOfTheFrameAndTheOneBefore) {
    const ShotReader reader(folder);
    EXPECT_FALSE(reader.read(0, Pass::depth).previousCamera);
    const Frame f = reader.read(1, Pass::depth);
    EXPECT_EQ(f.camera->nearClip, 2);
    ASSERT_TRUE(f.previousCamera);
    EXPECT_EQ(f.previousCamera->nearClip, 1);
    manifest.frames[1].reset = true;
    writeManifest(manifest);
    EXPECT_FALSE(ShotReader(folder).read(1, Pass::depth).previousCamera);
}

TEST_F(ReaderTest, MotionMayBeAbsentOnlyInAStaticShot) {
    Frame f = fullFrame(1);
    f.passes = f.passes.without(Pass::motion);
    write(f);
    EXPECT_THAT(errorOf(Pass::motion), AllOf(HasSubstr("1.exr: frame 1 has no part 'motion'")));
    EXPECT_FALSE(ShotReader(folder).offered().has(Pass::motion));
    manifest.isStatic = true;
    writeManifest(manifest);
    EXPECT_TRUE(ShotReader(folder).offered().has(Pass::motion));
    const Frame zero = ShotReader(folder).read(0, Pass::motion);
    EXPECT_TRUE(zero.motionXPx.samePixels(PlaneF(kWidth, kHeight)));
    EXPECT_TRUE(zero.motionYPx.samePixels(PlaneF(kWidth, kHeight)));
}

TEST_F(ReaderTest, MissingAndForeignFiles) {
    fs::remove(folder / "1.exr");
    EXPECT_THAT(errorOf(), HasSubstr("1.exr: no such file"));
    std::ofstream(folder / "1.exr") << "this is a text, not an image";
    EXPECT_THAT(errorOf(), HasSubstr("1.exr: not an EXR file"));
    std::ofstream(folder / "1.exr").close();
    EXPECT_THAT(errorOf(), HasSubstr("1.exr: not an EXR file"));
    fs::remove(folder / "1.exr");
    fs::create_directory(folder / "1.exr");
    EXPECT_THAT(errorOf(), HasSubstr("is a folder"));
}

TEST_F(ReaderTest, TruncatedFilesAreNoticedWhereverTheyEnd) {
    for (const double share : {0.9, 0.5, 0.2, 0.02, 0.005}) {
        write(fullFrame(1));
        truncate("1.exr", share);
        EXPECT_THAT(errorOf(), HasSubstr("1.exr: ")) << share;
    }
    write(fullFrame(1));
    truncate("1.exr", 0.95);
    EXPECT_THAT(errorOf(Pass::edges), AllOf(HasSubstr("part 'edges'"), HasSubstr("truncated")));
    EXPECT_EQ(errorOf(Pass::color), "no error");  // what is not needed is not read
}

TEST_F(ReaderTest, DamagedPixelsAreNoticed) {
    const auto size = fs::file_size(folder / "1.exr");
    std::fstream file(folder / "1.exr", std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(std::streamoff(size / 2));
    file << std::string(2000, '\x5a');
    file.close();
    EXPECT_THAT(errorOf(), HasSubstr("damaged"));
}

TEST_F(ReaderTest, ResolutionMustBeTheManifests) {
    manifest.width = 40;
    writeManifest(manifest);
    EXPECT_THAT(errorOf(), HasSubstr("part 'color': expected 40x150 pixels (shot.json), found 37x150"));
    try {
        ShotReader(folder).readTruth(0);
        FAIL();
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("truth of frame 1, part 'a': expected 40x150"));
    }
}

TEST_F(ReaderTest, PixelsLieWhereTheDisplayWindowShowsThem) {
    PlaneF c = plane(1);
    writeParts(folder / "1.exr", {{"color", {{"R", &c}, {"G", &c}, {"B", &c}}, {}, Window{-3, -2, kWidth, kHeight}}});
    EXPECT_THAT(errorOf(Pass::color),
                HasSubstr("1.exr: frame 1, part 'color': expected a data window that is the display window (37 x 150 "
                          "px), found 37 x 150 px at 3, 2; export whole frames"));
    PlaneF half = plane(2);
    writeParts(folder / "truth.exr", {{"a", {{"R", &half}, {"G", &half}, {"B", &half}}, {}, Window{-3, 0, 64, 150}}});
    try {
        ShotReader(folder).readTruth(0);
        FAIL();
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("truth of frame 1, part 'a': expected a data window"));
    }
}

TEST_F(ReaderTest, MissingPartsAndChannelsAreNamed) {
    PlaneF z = plane(1);
    writeParts(folder / "1.exr", {{"color", {{"R", &z}, {"G", &z}}}, {"depth", {{"depth.Z", &z}}}});
    EXPECT_THAT(errorOf(Pass::normal), HasSubstr("no part 'normal'"));
    EXPECT_THAT(errorOf(Pass::color), HasSubstr("part 'color' has no channel 'B'"));
    EXPECT_THAT(errorOf(Pass::depth), HasSubstr("part 'depth' has no channel 'Z'"));
    EXPECT_THAT(errorOf(Pass::subsamples), HasSubstr("no part 'subsamples'"));
    manifest.subsamplePositionsPx.clear();
    writeManifest(manifest);
    EXPECT_THAT(errorOf(Pass::subsamples), HasSubstr("subsamples.positions"));
}

TEST_F(ReaderTest, WrongTypesAreNamed) {
    PlaneU id = ids(1);
    PlaneF fractions = plane(1), whole(kWidth, kHeight, 12345.0f);
    writeParts(folder / "1.exr", {{"depth", {{"Z", &id}}}, {"object", {{"id", &fractions}}}});
    EXPECT_THAT(errorOf(Pass::depth), HasSubstr("channel 'Z': expected half or float, found uint"));
    EXPECT_THAT(errorOf(Pass::object), AllOf(HasSubstr("channel 'id', pixel (0, 0)"), HasSubstr("found a fraction")));
    writeParts(folder / "1.exr", {{"object", {{"id", &whole}}}});
    EXPECT_EQ(ShotReader(folder).read(0, Pass::object).objectId.at(5, 5), 12345u);
}

TEST_F(ReaderTest, HalfIsAccepted) {
    OIIO::ImageSpec spec(kWidth, kHeight, 3, OIIO::TypeDesc::HALF);
    spec.attribute("oiio:subimagename", "color");
    auto out = OIIO::ImageOutput::create("x.exr");
    std::vector<float> pixels(size_t(kWidth) * kHeight * 3, 0.5f);
    pixels[4] = INFINITY;
    ASSERT_TRUE(out->open((folder / "1.exr").string(), spec) &&
                out->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) && out->close());
    const Frame f = ShotReader(folder).read(0, Pass::color);
    EXPECT_EQ(f.colorLinear.c[2].at(30, 140), 0.5f);
    EXPECT_EQ(f.colorLinear.c[1].at(1, 0), 65504.0f);  // half's largest number
}

TEST_F(ReaderTest, StrictNamesPlanePixelFrameAndChannel) {
    const auto damaged = [&](auto damage) {
        Frame f = fullFrame(1);
        damage(f);
        write(f);
        return errorOf(kAll, InputPolicy::strict);
    };
    EXPECT_THAT(
        damaged([](Frame& f) { f.colorLinear.c[1].at(5, 9) = NAN; }),
        HasSubstr("1.exr: frame 1, part 'color', channel 'G', pixel (5, 9): expected a finite number, found NaN"));
    EXPECT_THAT(damaged([](Frame& f) { f.colorLinear.c[0].at(0, 0) = -INFINITY; }),
                HasSubstr("channel 'R', pixel (0, 0): expected a finite number, found -Inf"));
    EXPECT_THAT(damaged([](Frame& f) { f.depthView.at(1, 2) = -3; }),
                HasSubstr("part 'depth', channel 'Z', pixel (1, 2): expected a finite depth > 0, found -3.0"));
    EXPECT_THAT(damaged([](Frame& f) { f.normalWorld.c[2].at(1, 2) = NAN; }),
                HasSubstr("part 'normal', channel 'N.Z', pixel (1, 2)"));
    EXPECT_THAT(damaged([](Frame& f) { f.motionYPx.at(36, 149) = INFINITY; }),
                HasSubstr("part 'motion', channel 'motion.Y', pixel (36, 149)"));
    EXPECT_THAT(damaged([](Frame& f) { f.subSamples[1].depthView.at(2, 2) = NAN; }),
                HasSubstr("part 'subsamples', channel 's01.Z', pixel (2, 2)"));
    EXPECT_THAT(damaged([](Frame& f) { f.subSamples[0].colorLinear.c[2].at(2, 2) = NAN; }),
                HasSubstr("channel 's00.B', pixel (2, 2)"));
    EXPECT_EQ(damaged([](Frame&) {}), "no error");
}

TEST_F(ReaderTest, SanitiserFollowsTheRulesAndCounts) {
    Frame f = fullFrame(1);
    PlaneF& r = f.colorLinear.c[0];
    r.at(0, 0) = NAN;  // three finite neighbours of a corner
    const float cornerMean = float((double(r.at(1, 0)) + double(r.at(0, 1)) + double(r.at(1, 1))) / 3);
    for (int y = 9; y < 12; y++)
        for (int x = 9; x < 12; x++) r.at(x, y) = NAN;  // the centre has no finite neighbour
    f.colorLinear.c[1].at(5, 5) = INFINITY;
    f.colorLinear.c[1].at(6, 5) = -INFINITY;
    f.colorLinear.c[1].at(7, 5) = -0.5f;
    f.depthView.at(0, 1) = NAN;
    f.depthView.at(1, 1) = 0;
    f.depthView.at(2, 1) = -INFINITY;
    f.depthView.at(4, 1) = 2e9f;  // background written in another way: not a repair
    f.normalWorld.c[1].at(8, 8) = NAN;
    f.motionXPx.at(3, 3) = NAN;
    f.edgeYPx.at(3, 3) = INFINITY;
    f.segments[1].x1 = NAN;
    f.segments[2].z0 = -1;
    f.segments[3].z1 = 0;
    write(f);
    SanitiseCounts counts;
    const Frame g = ShotReader(folder).read(0, kAll, &counts);
    EXPECT_EQ(g.colorLinear.c[0].at(0, 0), cornerMean);
    EXPECT_EQ(g.colorLinear.c[0].at(10, 10), 0.0f);
    EXPECT_GT(g.colorLinear.c[0].at(9, 9), 0.0f);
    EXPECT_EQ(g.colorLinear.c[1].at(5, 5), kLargestRadiance);
    EXPECT_EQ(g.colorLinear.c[1].at(6, 5), 0.0f);
    EXPECT_EQ(g.colorLinear.c[1].at(7, 5), 0.0f);
    for (int x : {0, 1, 2, 4}) EXPECT_EQ(g.depthView.at(x, 1), kBackgroundDepth) << x;
    for (const auto& p : g.normalWorld.c) EXPECT_EQ(p.at(8, 8), 0.0f);
    EXPECT_EQ(g.motionXPx.at(3, 3), kInvalidMotionPx);
    EXPECT_EQ(g.motionYPx.at(3, 3), kInvalidMotionPx);
    EXPECT_EQ(g.edgeXPx.at(3, 3), 0.5f);
    EXPECT_EQ(counts.colourNan, 10u);
    EXPECT_EQ(counts.colourInf, 2u);
    EXPECT_EQ(counts.colourNegative, 1u);
    EXPECT_EQ(counts.depth, 3u);
    EXPECT_EQ(counts.normal, 1u);
    EXPECT_EQ(counts.motion, 1u);
    EXPECT_EQ(counts.edges, 1u);
    EXPECT_EQ(counts.segments, 3u);
    EXPECT_EQ(g.segments.size(), f.segments.size() - 3);
    EXPECT_EQ(g.segments[1], f.segments[4]);
    EXPECT_EQ(counts.total(), 22u);
    EXPECT_TRUE(std::isnan(ShotReader(folder, InputPolicy::raw).read(0, kAll).colorLinear.c[0].at(0, 0)));
}

// A list has a size of its own, which says how many segments fit in; anything else is a broken list.
TEST_F(ReaderTest, SegmentsAreAListOfAnyLength) {
    const auto written = [&](std::vector<EdgeSegment> segments) {
        Frame f = fullFrame(1);
        f.segments = segments;
        write(f);
        EXPECT_EQ(ShotReader(folder, InputPolicy::strict).read(0, Pass::segments).segments, segments);
        return *ExrFile(folder / "1.exr").find("segments");
    };
    const EdgeSegment one{-3, 4, 1, 5000, 2, 9};
    ExrPart part = written({});
    EXPECT_EQ(std::pair(part.width, part.height), std::pair(1, 1));
    part = written({one, one});
    EXPECT_EQ(std::pair(part.width, part.height), std::pair(2, 1));
    part = written(std::vector(kSegmentsPerRow, one));
    EXPECT_EQ(std::pair(part.width, part.height), std::pair(kSegmentsPerRow, 1));
    part = written(std::vector(2 * kSegmentsPerRow + 1, one));
    EXPECT_EQ(std::pair(part.width, part.height), std::pair(kSegmentsPerRow, 3));
}
TEST_F(ReaderTest, BrokenSegmentListsAreNamed) {
    const auto write = [&](int width, int height, size_t channels) {
        const PlaneF ones(width, height, 1.0f);
        PartSource part{"segments", {}};
        for (size_t c = 0; c < channels; c++) part.channels.push_back({std::string(kSegmentChannels[c]), &ones});
        writeParts(folder / "1.exr", {part});
    };
    write(kSegmentsPerRow + 1, 1, 6);
    EXPECT_THAT(errorOf(Pass::segments), AllOf(HasSubstr("frame 1"), HasSubstr("'segments'"), HasSubstr("4097x1")));
    write(100, 2, 6);
    EXPECT_THAT(errorOf(Pass::segments), AllOf(HasSubstr("rows of 4096"), HasSubstr("100x2")));
    write(7, 1, 5);
    EXPECT_THAT(errorOf(Pass::segments), HasSubstr("no channel 'z1'"));
    write(7, 1, 6);
    EXPECT_EQ(errorOf(Pass::segments), "no error");
    Frame f = fullFrame(1);
    f.segments[5].y0 = NAN;
    writeFrame(folder / "1.exr", f, true);
    EXPECT_THAT(errorOf(Pass::segments, InputPolicy::strict),
                AllOf(HasSubstr("channel 'y0'"), HasSubstr("segment 5"), HasSubstr("found nan")));
    f.segments[5] = {0, 0, 2, 0, 0, -2};
    writeFrame(folder / "1.exr", f, true);
    EXPECT_THAT(errorOf(Pass::segments, InputPolicy::strict), AllOf(HasSubstr("'z1'"), HasSubstr("depth > 0")));
    f.passes = PassSet(Pass::color);
    writeFrame(folder / "1.exr", f, true);
    EXPECT_THAT(errorOf(Pass::segments), HasSubstr("no part 'segments'"));
}

TEST_F(ReaderTest, TruthComesBackAndIsNeverRepaired) {
    const auto truth = ShotReader(folder).readTruth(1);
    ASSERT_TRUE(truth);
    EXPECT_TRUE(truth->a.samePixels(rgb(1)));
    EXPECT_TRUE(truth->b.samePixels(rgb(2)));
    Truth bad{rgb(1), rgb(2)};
    bad.b.c[1].at(3, 3) = NAN;
    writeTruth(folder / "truth.exr", bad);
    try {
        ShotReader(folder).readTruth(0);
        ADD_FAILURE();
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), AllOf(HasSubstr("never repaired"), Not(HasSubstr("--non-finite sanitise"))));
    }
    SanitiseCounts counts;
    const auto raw = ShotReader(folder, InputPolicy::raw).readTruth(0, &counts);
    EXPECT_TRUE(std::isnan(raw->b.c[1].at(3, 3)));
    EXPECT_EQ(counts.truthNan, 1u);
    bad.b.c[1].at(3, 3) = -0.5f;
    writeTruth(folder / "truth.exr", bad);
    EXPECT_EQ(ShotReader(folder).readTruth(0, &counts)->b.c[1].at(3, 3), 0.0f);
    EXPECT_EQ(counts.truthNegative, 1u);
    manifest.frames[0].truth.clear();
    writeManifest(manifest);
    EXPECT_FALSE(ShotReader(folder).readTruth(0));
}

TEST_F(ReaderTest, WritingFailsWithOneLine) {
    try {
        writeFrame(folder / "no_such_folder" / "1.exr", fullFrame(1), true);
        FAIL();
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("cannot be written"));
    }
}

TEST_F(ReaderTest, StreamDeliversInOrderAndSharesTheTruth) {
    const ShotReader reader(folder);
    FrameStream stream(reader, {0, 2, 1}, Pass::color | Pass::depth, true);
    std::vector<int> numbers;
    std::shared_ptr<const Truth> first, last;
    while (const auto frame = stream.next()) {
        numbers.push_back(frame->number);
        EXPECT_TRUE(frame->colorLinear.samePixels(fullFrame(frame->number).colorLinear));
        const auto truth = stream.takeTruth();
        EXPECT_EQ(stream.takeTruth(), nullptr) << "it has been taken";
        EXPECT_TRUE(!last || truth == last) << "they are in one file";
        last = truth;
        if (!first) first = truth;
    }
    EXPECT_EQ(numbers, (std::vector<int>{1, 3, 2}));
    EXPECT_TRUE(first->a.samePixels(rgb(1)));
    FrameStream none(reader, {}, Pass::color);
    EXPECT_FALSE(none.next());
    FrameStream abandoned(reader, {0, 1, 2}, Pass::color);  // destroyed while it decodes
}

TEST_F(ReaderTest, StreamErrorsSurfaceAtTheirFrame) {
    truncate("2.exr", 0.3);
    const ShotReader reader(folder);
    FrameStream stream(reader, {0, 1, 2}, kAll);
    EXPECT_TRUE(stream.next());
    EXPECT_THROW(stream.next(), InputError);
    EXPECT_FALSE(stream.next());
}
}  // namespace
}  // namespace aa
