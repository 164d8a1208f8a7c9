#include "shot/synth/synth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <set>

#include "image/error.h"
#include "shot/reader.h"
#include "shot/synth/synth_testing.h"

namespace aa {
namespace {
using glm::dvec2;
using glm::dvec3;

SynthOptions small(const char* scene, int frames = 4) {
    SynthOptions o;
    o.scene = scene;
    o.width = 121;
    o.height = 77;
    o.frames = frames;
    return o;
}

// Mean colour over an n x n grid of the pixel: what the exact truth must agree with.
dvec3 countedColor(const std::function<dvec3(dvec2)>& picture, int x, int y, int n) {
    dvec3 sum(0);
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) sum += picture({x + (i + .5) / n, y + (j + .5) / n});
    return sum / double(n * n);
}

class SynthScenes : public testing::TestWithParam<std::string_view> {};
AA_OVER_ALL_SCENES(SynthScenes);

TEST_P(SynthScenes, TruthIsTheBoxMean) {
    const SynthShot shot(small(GetParam().data()));
    const Frame f = shot.frame(2);
    const Truth t = shot.truth(2);
    const auto picture = shot.picture(2);
    int edges = 0;
    double worst = 0;
    for (int y = 0; y < 77; y++)
        for (int x = (y * 7) % 5; x < 121; x += 5) {
            const dvec3 expected = countedColor(picture, x, y, 24);
            for (int c = 0; c < 3; c++) {
                const double difference = std::abs(t.a.c[size_t(c)].at(x, y) - expected[c]);
                worst = std::max(worst, difference);
                edges += std::abs(f.colorLinear.c[size_t(c)].at(x, y) - expected[c]) > 0.01;
            }
        }
    EXPECT_LT(worst, 0.03);  // 24 x 24 samples resolve an area to about 1/24 of the edge's contrast
    EXPECT_GT(edges, 40);    // there was something to resolve
}

TEST_P(SynthScenes, MeanOfManySamplesConvergesToTheTruth) {
    const SynthShot shot(small(GetParam().data()));
    const Truth t = shot.truth(1);
    const auto picture = shot.picture(1);
    double coarse = 0, fine = 0;
    for (int y = 3; y < 77; y += 11)
        for (int x = 2; x < 121; x += 3) {
            const double a = t.a.c[1].at(x, y);
            coarse += std::pow(countedColor(picture, x, y, 4).y - a, 2);
            fine += std::pow(countedColor(picture, x, y, 64).y - a, 2);
        }
    EXPECT_LT(fine, coarse / 25);  // the error of a regular grid falls with its spacing
}

TEST_P(SynthScenes, PassesAreSound) {
    SynthOptions o = small(GetParam().data());
    o.subsamples = "d3d4";
    o.subsampleColor = true;
    const SynthShot shot(o);
    const Frame f = shot.frame(3);
    const glm::dmat3 view(f.camera->view);
    const auto picture = shot.picture(3);
    std::set<uint32_t> ids;
    for (int y = 0; y < f.height; y++)
        for (int x = 0; x < f.width; x++) {
            const uint32_t id = f.objectId.at(x, y);
            ids.insert(id);
            const dvec3 n(f.normalWorld.c[0].at(x, y), f.normalWorld.c[1].at(x, y), f.normalWorld.c[2].at(x, y));
            if (id == 0) {
                EXPECT_EQ(f.depthView.at(x, y), kBackgroundDepth);
                EXPECT_EQ(n, dvec3(0));
                continue;
            }
            EXPECT_TRUE(shot.manifest().objects.contains(id));
            EXPECT_GT(f.depthView.at(x, y), f.camera->nearClip);
            EXPECT_LT(f.depthView.at(x, y), f.camera->farClip);
            EXPECT_NEAR(glm::length(n), 1, 1e-6);
            EXPECT_GT((view * n).z, 0) << "faces the camera";
            for (size_t k = 0; k < 4; k++) {
                const bool same = f.subSamples[k].objectId.at(x, y) == id;
                EXPECT_EQ((f.subSampleMask.at(x, y) >> k & 1) == 1, same);
                const dvec2 q = dvec2(x + .5, y + .5) + f.jitterPx + f.subSamplePositionsPx[k];
                EXPECT_EQ(f.subSamples[k].colorLinear.c[0].at(x, y), float(picture(q).x));
            }
        }
    EXPECT_GE(ids.size(), GetParam() == "zone_plate" ? 1u : GetParam() == "half_plane" ? 2u : 3u);
    EXPECT_EQ(shot.frame(0).reset, true);
    EXPECT_EQ(f.reset, false);
}

// So that a scene can be judged in one displayed space, too: displayed value = value, truth = its mean.
TEST_P(SynthScenes, ValuesCanBeDisplayed) {
    const SynthShot shot(small(GetParam().data()));
    const Frame f = shot.frame(1);
    const Truth t = shot.truth(1);
    for (const Rgb* picture : {&f.colorLinear, &f.albedoLinear, &t.a})
        for (const PlaneF& plane : picture->c)
            for (int y = 0; y < f.height; y++)
                for (int x = 0; x < f.width; x++)
                    ASSERT_TRUE(plane.at(x, y) >= 0 && plane.at(x, y) <= 1) << x << " " << y << " " << plane.at(x, y);
}

// Where p was: the surface's point of the previous frame has the same object and colour there, unless it was hidden.
TEST(Synth, MotionLeadsToTheSameSurface) {
    for (const char* scene : {"moving", "thin_motion"}) {
        const SynthShot shot(small(scene));
        const Frame f = shot.frame(3);
        const auto picture = shot.picture(3), previous = shot.picture(2);
        int moved = 0, same = 0, sameIfFlipped = 0;
        for (int y = 0; y < f.height; y++)
            for (int x = 0; x < f.width; x++) {
                const dvec2 mv(f.motionXPx.at(x, y), f.motionYPx.at(x, y));
                if (mv == dvec2(0)) continue;
                const dvec2 p = dvec2(x + .5, y + .5) + f.jitterPx;
                const dvec3 now = picture(p);
                moved++;
                same += now == previous(p - mv);
                sameIfFlipped += now == previous(p + mv);
            }
        EXPECT_GT(moved, 150) << scene;
        EXPECT_GT(same, 0.97 * moved) << scene;
        EXPECT_LT(sameIfFlipped, 0.9 * moved) << scene;
    }
}

TEST(Synth, TheBarMovesByWholePixels) {
    const SynthShot shot(small("moving"));
    const Frame a = shot.frame(1), b = shot.frame(2);
    SynthOptions still = small("moving");
    still.jitter = "none";
    const Frame c = SynthShot(still).frame(1), d = SynthShot(still).frame(2);
    int pixels = 0;
    for (int y = 1; y < 77; y++)
        for (int x = 0; x < 121; x++)
            if (d.objectId.at(x, y) == 5) {
                pixels++;
                EXPECT_EQ(d.motionYPx.at(x, y), 1.0f);
                EXPECT_EQ(d.motionXPx.at(x, y), 0.0f);
                EXPECT_EQ(c.objectId.at(x, y - 1), 5u);
            }
    EXPECT_GT(pixels, 30);
}

TEST(Synth, DepthUnprojectsOntoThePlanes) {
    for (const char* scene : {"two_planes", "half_planes"}) {
        const SynthShot shot(small(scene));
        const Frame f = shot.frame(1);
        const glm::dmat4 toWorld = glm::inverse(f.camera->projection * f.camera->view);
        std::map<uint32_t, dvec3> first;
        for (int y = 0; y < f.height; y++)
            for (int x = 0; x < f.width; x++) {
                if (f.objectId.at(x, y) == 0) continue;
                const dvec2 p = dvec2(x + .5, y + .5) + f.jitterPx;
                const glm::dvec4 clip = f.camera->projection * glm::dvec4(0, 0, -double(f.depthView.at(x, y)), 1);
                const glm::dvec4 world =
                    toWorld * (glm::dvec4(2 * p.x / f.width - 1, 1 - 2 * p.y / f.height, clip.z / clip.w, 1) * clip.w);
                const dvec3 point = dvec3(world) / world.w;
                const auto [it, isNew] = first.emplace(f.objectId.at(x, y), point);
                const dvec3 n(f.normalWorld.c[0].at(x, y), f.normalWorld.c[1].at(x, y), f.normalWorld.c[2].at(x, y));
                EXPECT_NEAR(glm::dot(n, point - it->second), 0, 2e-5) << scene << " " << x << " " << y;
            }
    }
}

TEST(Synth, HalfPlanesShowAtLeast64Angles) {
    const SynthShot shot(small("half_planes"));
    EXPECT_GE(shot.shapes().size(), 128u - 6u);  // an edge may miss a tile's corner
    const Frame f = shot.frame(0);
    EXPECT_TRUE(f.passes.has(Pass::edges));
    EXPECT_FALSE(SynthShot(small("circles")).passes().has(Pass::edges));
    EXPECT_TRUE(f.passes.has(Pass::segments));
    EXPECT_FALSE(SynthShot(small("circles")).passes().has(Pass::segments));
}

// Widths as promised along the whole strand, neither gaps nor steps where its parts meet, and no edges there.
TEST(Synth, HairsAreStrandsOfTheirWidth) {
    SynthOptions o = small("hairs");
    o.width = 256;
    o.height = 144;
    const SynthShot shot(o);
    const auto& shapes = shot.shapes();
    const auto corners = [&](size_t i) { return std::get<Polygon>(shapes[i].region); };
    std::set<double> depths;
    double thinnest = 100, thickest = 0;
    size_t joints = 0, straight = 0, grey = 0, outlines = 0;
    for (size_t i = 0; i + 1 < shapes.size(); i++) {  // the last one is the wall
        const Polygon p = corners(i);
        ASSERT_EQ(p.size(), 4u);
        const dvec2 along = glm::normalize(p[1] - p[0]), other = glm::normalize(p[2] - p[3]);
        EXPECT_NEAR(glm::dot(along, other), 1, 1e-12) << "its sides are parallel";
        const double width = along.x * (p[3] - p[0]).y - along.y * (p[3] - p[0]).x;
        thinnest = std::min(thinnest, width), thickest = std::max(thickest, width);
        outlines += shapes[i].seams & 1u << 1 ? 0 : 1;
        outlines += shapes[i].seams & 1u << 3 ? 0 : 1;
        if (depths.insert(shapes[i].distance).second) {
            straight += shapes[i].seams == 0;
            grey += shapes[i].color.x == shapes[i].color.y && shapes[i].color.x == shapes[i].color.z;
            continue;
        }
        joints++;
        EXPECT_EQ(p[0], corners(i - 1)[1]) << i;
        EXPECT_EQ(p[3], corners(i - 1)[2]) << i;
        EXPECT_TRUE(shapes[i].seams & 1u << 3 && shapes[i - 1].seams & 1u << 1) << i;
    }
    const size_t strands = depths.size();
    EXPECT_EQ(strands, 256u * 144 / 160);
    EXPECT_TRUE(thinnest > 0.29999 && thinnest < 0.33 && thickest > 1.9 && thickest < 2.00001)
        << thinnest << " " << thickest;
    EXPECT_GT(joints, 2 * strands);
    EXPECT_TRUE(straight >= strands / 2 && straight < strands * 6 / 10) << straight;
    EXPECT_TRUE(grey >= strands * 4 / 10 && grey <= strands * 6 / 10) << grey;
    EXPECT_EQ(outlines, 2 * strands);
    EXPECT_EQ(shot.frame(0).segments.size(), 2 * (shapes.size() - 1) + outlines + 4);

    const auto hairShare = [](int w, int h, uint32_t seed) {
        SynthOptions o = small("hairs");
        o.width = w, o.height = h, o.seed = seed;
        const Frame f = SynthShot(o).frame(0);
        double hair = 0;
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++) hair += f.objectId.at(x, y) != 1;
        return hair / w / h;
    };
    for (const auto& [w, h] : {std::pair{256, 144}, {333, 480}})
        for (const uint32_t seed : {1u, 2u}) {
            const double share = hairShare(w, h, seed);
            EXPECT_TRUE(share > 0.25 && share < 0.42) << w << " " << seed << ": " << share;
        }
    o.seed = 2;
    EXPECT_NE(std::get<Polygon>(SynthShot(o).shapes()[0].region)[0], corners(0)[0]);
}

// conventions 3: an edge 0.2 px to the right makes (0.2, 0.5); the sign follows the side.
TEST(Synth, EdgeDistancesAreSignedAndPointAtTheEdge) {
    SynthOptions o = small("half_planes", 1);
    o.jitter = "none";
    const SynthShot shot(o);
    const Frame f = shot.frame(0);
    const auto picture = shot.picture(0);
    int cut = 0;
    for (int y = 0; y < f.height; y++)
        for (int x = 0; x < f.width; x++) {
            const dvec2 e(f.edgeXPx.at(x, y), f.edgeYPx.at(x, y)), p(x + .5, y + .5);
            if (std::min(std::abs(e.x), std::abs(e.y)) >= 0.499) continue;
            cut++;
            const dvec2 step = std::abs(e.x) < std::abs(e.y) ? dvec2(e.x, 0) : dvec2(0, e.y);
            const double beyond = 1e-4 / std::max(glm::length(step), 1e-6);
            EXPECT_NE(picture(p + step * (1 + beyond)), picture(p + step * (1 - beyond))) << x << " " << y;
        }
    EXPECT_GT(cut, 400);
}

// The list is of the un-jittered picture: where the colour changes there is a segment, at the depth of its surface.
TEST(Synth, SegmentsLieOnTheEdges) {
    for (const char* scene : {"half_planes", "two_planes", "thin_motion"}) {
        const SynthShot shot(small(scene));
        const Frame f = shot.frame(2), other = shot.frame(2, Sampling::centre);
        EXPECT_EQ(f.segments, other.segments);
        ASSERT_NE(f.jitterPx, other.jitterPx);
        const auto picture = shot.picture(2);
        const auto at = [](const EdgeSegment& s, double t) {
            return dvec2(s.x0 + t * (double(s.x1) - s.x0), s.y0 + t * (double(s.y1) - s.y0));
        };
        int changes = 0;
        for (const EdgeSegment& s : f.segments) {
            const dvec2 along = glm::normalize(at(s, 1) - at(s, 0)), across(-along.y, along.x);
            for (const double t : {0.3, 0.5, 0.7}) {
                const dvec2 p = at(s, t);
                changes += p.x > 1 && p.y > 1 && p.x < 120 && p.y < 76 &&
                           picture(p + across * 1e-4) != picture(p - across * 1e-4);
            }
        }
        EXPECT_GT(changes, 10) << scene;
        // Depth: 1 / z is linear in the picture for a perspective camera, z for an orthographic one.
        const bool perspective = f.camera->kind == "perspective";
        int seen = 0;
        for (const EdgeSegment& s : f.segments)
            for (const double t : {0.25, 0.5, 0.75}) {
                const dvec2 p = at(s, t);
                const int x = int(std::floor(p.x)), y = int(std::floor(p.y));
                if (x < 1 || y < 1 || x > 119 || y > 75) continue;
                const double z = perspective ? 1 / ((1 - t) / s.z0 + t / s.z1) : (1 - t) * s.z0 + t * s.z1;
                for (int dy = -1; dy <= 1 && seen >= 0; dy++)
                    for (int dx = -1; dx <= 1; dx++)
                        if (std::abs(other.depthView.at(x + dx, y + dy) / z - 1) < 0.02) {
                            seen++, dy = 2;
                            break;
                        }
            }
        EXPECT_GT(seen, 10) << scene;
    }
}

// Manifest::jitterPremultiplied: what a pixel shows lies at jitter x P / depth in the picture without jitter. A camera
// that moves sees around edges, too, which no displacement of the picture does: there a few pixels differ.
TEST(Synth, PremultipliedJitterFallsWithDepth) {
    SynthOptions o = small("two_planes");
    o.premultiplied = true;
    const SynthShot shot(o);
    EXPECT_TRUE(shot.manifest().jitterPremultiplied);
    const Frame f = shot.frame(3), centre = shot.frame(3, Sampling::centre);
    const glm::dmat4& projection = f.camera->projection;
    const dvec2 focal(projection[0][0], projection[1][1]);
    const auto picture = shot.picture(3);
    ASSERT_GT(glm::length(f.jitterPx), 0.3);
    int pixels = 0, right = 0, rightAtJitter = 0, rightIfFlipped = 0, surfaces = 0;
    double nearest = 1e10, farthest = 0;
    for (int y = 0; y < f.height; y++)
        for (int x = 0; x < f.width; x++) {
            const dvec2 p(x + .5, y + .5);
            const double z = f.depthView.at(x, y);
            const dvec2 offset = z == kBackgroundDepth ? dvec2(0.0) : f.jitterPx * focal / z;
            const auto shows = [&](dvec2 at) { return float(picture(at).x) == f.colorLinear.c[0].at(x, y); };
            pixels++;
            right += shows(p + offset);
            rightAtJitter += shows(p + f.jitterPx);
            rightIfFlipped += shows(p - offset);
            if (z == kBackgroundDepth) continue;
            nearest = std::min(nearest, z), farthest = std::max(farthest, z);
            // The depth that a camera without jitter has of this surface at p + offset: planes in 1/z, over one pixel.
            const double here = 1 / double(centre.depthView.at(x, y));
            if (x < 1 || y < 1 || x > 119 || y > 75) continue;
            bool oneSurface = true;
            for (const glm::ivec2 d : {glm::ivec2(-1, 0), {1, 0}, {0, -1}, {0, 1}, {0, 0}})
                oneSurface &= centre.objectId.at(x + d.x, y + d.y) == f.objectId.at(x, y);
            if (!oneSurface) continue;
            const double perX =
                             (1 / double(centre.depthView.at(x + 1, y)) - 1 / double(centre.depthView.at(x - 1, y))) /
                             2,
                         perY =
                             (1 / double(centre.depthView.at(x, y + 1)) - 1 / double(centre.depthView.at(x, y - 1))) /
                             2;
            EXPECT_NEAR(1 / z, here + perX * offset.x + perY * offset.y, 1e-6 * here) << x << " " << y;
            surfaces++;
        }
    EXPECT_GT(surfaces, 1000);
    EXPECT_LT(nearest * 1.2, farthest);
    EXPECT_GE(right, pixels - 12);
    EXPECT_LT(rightAtJitter, right - 30);
    EXPECT_LT(rightIfFlipped, right - 30);
    // The truth, the centre-sampled frame and the list of edges know nothing of it.
    o.premultiplied = false;
    const SynthShot plain(o);
    EXPECT_FALSE(plain.manifest().jitterPremultiplied);
    EXPECT_EQ(plain.frame(3).jitterPx, f.jitterPx) << "the stated jitter is the one that was wanted";
    EXPECT_TRUE(plain.truth(3).a.samePixels(shot.truth(3).a));
    EXPECT_EQ(plain.frame(3).segments, f.segments);
    EXPECT_TRUE(plain.frame(3, Sampling::centre).colorLinear.samePixels(centre.colorLinear));
    EXPECT_FALSE(plain.frame(3).colorLinear.samePixels(f.colorLinear));
}

TEST(Synth, SameBitsAtEveryCall) {
    const SynthShot shot(small("moving"));
    EXPECT_TRUE(shot.frame(2).colorLinear.samePixels(SynthShot(small("moving")).frame(2).colorLinear));
    EXPECT_TRUE(shot.truth(2).a.samePixels(shot.truth(2).b));
    const Truth zone = SynthShot(small("zone_plate")).truth(0);
    EXPECT_FALSE(zone.a.samePixels(zone.b));
}

TEST(Synth, OddSizes) {
    for (const auto& scene : synthScenes())
        for (const auto& [w, h] : {std::pair{1, 1}, {1, 9}, {9, 1}, {17, 3}}) {
            SynthOptions o = small(scene.name.data(), 2);
            o.width = w;
            o.height = h;
            const SynthShot shot(o);
            EXPECT_EQ(shot.frame(1).colorLinear.width(), w);
            for (const auto& p : shot.truth(1).a.c) EXPECT_TRUE(std::isfinite(p.at(w - 1, h - 1)));
        }
}

// Discs of 0.3 px and more overlap within a pixel when 48 of them share a few pixels: their truth must stay exact.
TEST(Synth, TinyPicturesHaveExactTruth) {
    for (const auto& [w, h] : {std::pair{1, 1}, {2, 3}, {7, 5}, {16, 9}}) {
        SynthOptions o;
        o.scene = "circles";
        o.width = w;
        o.height = h;
        o.frames = 1;
        const SynthShot shot(o);
        const Truth t = shot.truth(0);
        const auto picture = shot.picture(0);
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++) {
                const dvec3 expected = countedColor(picture, x, y, 128);
                for (int c = 0; c < 3; c++)
                    EXPECT_NEAR(t.a.c[size_t(c)].at(x, y), expected[c], 3e-3) << w << "x" << h << " " << x << "," << y;
            }
    }
}

TEST(Synth, WrittenShotReadsBackBitForBit) {
    const auto folder = std::filesystem::path(testing::TempDir()) / "aa_synth_test";
    for (const char* scene : {"moving", "two_planes"}) {
        SynthOptions o = small(scene, 3);
        o.subsamples = "d3d8";
        int calls = 0;
        writeSynth(o, folder, [&](const FrameEntry&) { return ++calls < 2; });
        const ShotReader reader(folder, InputPolicy::strict);
        const SynthShot shot(o);
        ASSERT_EQ(reader.manifest().frames.size(), 2u);  // stopped after two
        EXPECT_EQ(reader.offered(), shot.passes());
        const Frame f = reader.read(1, shot.passes()), e = shot.frame(1);
        EXPECT_TRUE(f.colorLinear.samePixels(e.colorLinear));
        EXPECT_TRUE(f.motionXPx.samePixels(e.motionXPx));
        EXPECT_TRUE(f.subSamples[7].normalWorld.samePixels(e.subSamples[7].normalWorld));
        EXPECT_EQ(f.jitterPx, e.jitterPx);
        EXPECT_EQ(f.camera->view, e.camera->view);
        EXPECT_TRUE(reader.readTruth(1)->a.samePixels(shot.truth(1).a));
        SynthOptions still = o;
        still.jitter = "none";
        ASSERT_TRUE(reader.hasCentreFrames());
        EXPECT_TRUE(reader.readCentre(1, Pass::color).colorLinear.samePixels(SynthShot(still).frame(1).colorLinear));
        std::filesystem::remove_all(folder);
    }
}

TEST(Synth, WritesOnlyWhatIsWanted) {
    const auto folder = std::filesystem::path(testing::TempDir()) / "aa_synth_wanted";
    SynthOptions o = small("moving", 2);
    o.wanted = Pass::color | Pass::motion;
    o.centreWanted = PassSet{};
    o.nanPixel = glm::ivec2(10, 7);
    writeSynth(o, folder);
    const ShotReader reader(folder);
    EXPECT_EQ(reader.offered(), *o.wanted);
    EXPECT_FALSE(reader.hasCentreFrames());
    SanitiseCounts counts;
    reader.read(1, Pass::color, &counts);
    EXPECT_EQ(counts.colourNan, 3u);
    o.wanted = Pass::edges;  // a disc has no edges
    EXPECT_THROW(writeSynth(o, folder), UsageError);
    std::filesystem::remove_all(folder);
}

TEST(Synth, WrongOptionsAreUsageErrors) {
    const auto with = [](auto change) {
        SynthOptions o = small("moving");
        change(o);
        return [o] { SynthShot shot(o); };
    };
    EXPECT_THROW(with([](auto& o) { o.scene = "movin"; })(), UsageError);
    EXPECT_THROW(with([](auto& o) { o.jitter = "x"; })(), UsageError);
    EXPECT_THROW(with([](auto& o) { o.subsamples = "d3d3"; })(), UsageError);
    EXPECT_THROW(with([](auto& o) { o.subsampleColor = true; })(), UsageError);
    EXPECT_THROW(with([](auto& o) { o.premultiplied = true; })(), UsageError);  // orthographic
    EXPECT_THROW(with([](auto& o) {
                     o.scene = "two_planes";
                     o.premultiplied = true;
                     o.jitter = "none";
                 })(),
                 UsageError);
    EXPECT_THROW(with([](auto& o) { o.width = 0; })(), UsageError);
    EXPECT_THROW(with([](auto& o) { o.frames = 0; })(), UsageError);
    EXPECT_THROW(with([](auto& o) {
                     o.jitter = "r2";
                     o.jitterStart = 3;
                 })(),
                 UsageError);
}
}  // namespace
}  // namespace aa
