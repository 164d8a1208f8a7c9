#include "shot/check/check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "image/error.h"
#include "shot/manifest.h"
#include "shot/reader.h"
#include "shot/synth/synth.h"
#include "shot/writer.h"

namespace aa {
namespace {
namespace fs = std::filesystem;
using glm::dvec2;
using ::testing::Contains;
using ::testing::HasSubstr;

// A synthetic shot, damaged in one way, written, checked and removed.
class CheckTest : public testing::Test {
  protected:
    void SetUp() override {
        folder = fs::path(testing::TempDir()) /
                 (std::string("aa_check_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    }
    void TearDown() override { fs::remove_all(folder); }

    static SynthOptions options(const char* scene, const char* subsamples = "") {
        SynthOptions o;
        o.scene = scene;
        o.width = 160;
        o.height = 100;
        o.frames = 6;
        o.subsamples = subsamples;
        return o;
    }
    template <class FrameDamage, class ManifestDamage>
    CheckReport checked(const SynthOptions& o, FrameDamage damageFrame, ManifestDamage damageManifest,
                        bool withTruth = true) {
        const SynthShot shot(o);
        Manifest m = shot.manifest();
        m.folder = folder;
        fs::create_directories(folder / "frames");
        fs::create_directories(folder / "truth");
        for (size_t i = 0; i < m.frames.size(); i++) {
            Frame f = shot.frame(i);
            damageFrame(f);
            writeFrame(folder / m.frames[i].file, f, !m.isStatic);
            if (withTruth) writeTruth(folder / m.frames[i].truth, shot.truth(i));
            m.frames[i].centre.clear();
            if (!withTruth) m.frames[i].truth.clear();
        }
        damageManifest(m);
        writeManifest(m);
        return checkShot(folder);
    }
    template <class Damage>
    CheckReport withFrames(const SynthOptions& o, Damage damage) {
        return checked(o, damage, [](Manifest&) {});
    }
    template <class Damage>
    CheckReport withManifest(const SynthOptions& o, Damage damage, bool withTruth = true) {
        return checked(
            o, [](Frame&) {}, damage, withTruth);
    }
    static std::string lines(const CheckReport& r) {
        std::string s;
        for (const auto& f : r.findings) s += f.line() + "\n";
        return s;
    }
    static void expectOnly(const CheckReport& r, const char* check, const char* says) {
        ASSERT_FALSE(r.clean());
        for (const auto& f : r.findings) EXPECT_EQ(f.check, check) << f.line();
        EXPECT_THAT(lines(r), HasSubstr(says));
    }
    fs::path folder;
};

TEST_F(CheckTest, UnusableSegmentsAreCounted) {
    const CheckReport r = withFrames(options("half_planes"), [](Frame& f) {
        if (f.number != 2) return;
        f.segments[3].x0 = NAN;
        f.segments[5].z1 = -1;
    });
    expectOnly(r, "numbers", "2 unusable segments, the first at index 3");
    ASSERT_EQ(r.findings.size(), 1u);
    EXPECT_EQ(r.findings[0].frame, 2);
}

// A mistake made on purpose is named, and what the pixels show of it is measured; unlabelled it is a finding.
TEST_F(CheckTest, PremultipliedJitterIsALabelledVariant) {
    SynthOptions o = options("two_planes");
    o.width = 480;
    o.height = 270;
    o.frames = 8;
    o.premultiplied = true;
    const CheckReport labelled = withManifest(o, [](Manifest&) {});
    EXPECT_TRUE(labelled.clean()) << lines(labelled);
    ASSERT_EQ(labelled.variants.size(), 1u);
    EXPECT_THAT(labelled.variants[0], HasSubstr("premultiplied jitter, as shot.json says: a sample lies at (2.74 jx, "
                                                "4.87 jy) / depth px"));
    const auto measured = [](const CheckReport& r, const std::string& name) {
        for (const auto& m : r.measured)
            if (m.name == name) return m.value;
        return -1.0;
    };
    const double x = measured(labelled, "jitter.premultipliedScaleX"),
                 y = measured(labelled, "jitter.premultipliedScaleY");
    EXPECT_TRUE(x > 0.3 && x < 0.65) << x;   // 2.74 / 9 to 2.74 / 4.2
    EXPECT_TRUE(y > 0.54 && y < 1.16) << y;  // 4.87 / 9 to 4.87 / 4.2
    EXPECT_EQ(measured(labelled, "jitter.meanErrorPx"), -1);
    EXPECT_EQ(toJson(labelled)["variants"].size(), 1u);

    // At these depths about half of the jitter is left, which is within the tolerance of a single frame; the mean error
    // tells.
    const CheckReport unlabelled = withManifest(o, [](Manifest& m) { m.jitterPremultiplied = false; });
    o.premultiplied = false;
    const CheckReport right = withManifest(o, [](Manifest&) {});
    EXPECT_TRUE(unlabelled.variants.empty() && right.variants.empty());
    EXPECT_GT(measured(unlabelled, "jitter.meanErrorPx"), 2 * measured(right, "jitter.meanErrorPx"));
}

TEST_F(CheckTest, AFrameWithoutItsCentreIsNamed) {
    const SynthOptions o = options("moving");
    for (const size_t lacking : {0, 2}) {
        const CheckReport r = withManifest(o, [&](Manifest& m) {
            for (auto& f : m.frames) f.centre = f.file;
            m.frames[lacking].centre.clear();
        });
        const std::string frame = std::to_string(1 + lacking);
        EXPECT_THAT(lines(r), HasSubstr("files: frame " + frame + ": expected a readable centre-sampled frame, found " +
                                        (folder / "shot.json").string() + ": frame " + frame + ": expected `centre`"));
        const ShotReader reader(folder);
        EXPECT_TRUE(reader.hasCentreFrames());
        EXPECT_THROW(reader.readCentre(lacking, Pass::color), InputError);
        fs::remove_all(folder);
    }
}

TEST_F(CheckTest, AnUnreadableFrameIsNamedOnceAndWithOneAdvice) {
    writeSynth(options("moving"), folder);
    fs::remove(folder / "frames/000001.exr");
    std::ofstream(folder / "frames/000003.exr") << "no picture";
    const CheckReport r = checkShot(folder);
    EXPECT_EQ(lines(r), "files: frame 1: expected a readable frame, found " + (folder / "frames/000001.exr").string() +
                            ": no such file; export the frame again\n" +
                            "files: frame 3: expected a readable frame, found " +
                            (folder / "frames/000003.exr").string() + ": not an EXR file; export the frame again\n");
    EXPECT_TRUE(r.passes.has(Pass::color)) << "of the frames that are there";
}

TEST_F(CheckTest, CleanShotsAreClean) {
    for (const auto& scene : synthScenes()) {
        SynthOptions o = options(scene.name.data(), "d3d4");
        o.subsampleColor = true;
        writeSynth(o, folder);
        EXPECT_EQ(lines(checkShot(folder)), "") << scene.name;
        const CheckReport noTruth = withManifest(
            o, [](Manifest&) {}, false);
        EXPECT_EQ(lines(noTruth), "") << scene.name << " without truth";
        fs::remove_all(folder);
    }
}

TEST_F(CheckTest, EverySequenceIsClean) {
    for (const char* jitter : {"none", "quadrant", "insideRotated4", "msaa8", "smaaT2x", "gaussian", "hammersley"}) {
        SynthOptions o = options("half_planes");
        o.jitter = jitter;
        EXPECT_EQ(lines(withManifest(o, [](Manifest&) {})), "") << jitter;
    }
}

TEST_F(CheckTest, JitterSignAxesAndUnit) {
    const std::pair<const char*, bool> cases[] = {
        {"half_planes", true}, {"moving", true}, {"two_planes", true}, {"half_planes", false}, {"circles", false}};
    for (const auto& [scene, truth] : cases) {
        const auto damaged = [&, name = scene, hasTruth = truth](auto change) {
            const auto all = [&](Manifest& m) {
                for (auto& f : m.frames) change(f.jitterPx);
            };
            return withManifest(options(name), all, hasTruth);
        };
        SCOPED_TRACE(std::string(scene) + (truth ? "" : " without truth"));
        expectOnly(damaged([](auto& j) { j.x = -j.x; }), "jitter", "sign of the jitter in x");
        expectOnly(damaged([](auto& j) { j.y = -j.y; }), "jitter", "sign of the jitter in y");
        expectOnly(damaged([](auto& j) { j = -j; }), "jitter", "sign of the jitter in x and y");
        expectOnly(damaged([](auto& j) { std::swap(j.x, j.y); }), "jitter", "exchange the axes of the jitter");
        if (!truth) continue;  // the mean of jittered frames has no size of its own
        expectOnly(damaged([](auto& j) { j = j / 160.0; }), "jitter", "in pixels");
        expectOnly(damaged([](auto& j) { j = j * 0.4; }), "jitter", "in pixels");
    }
}

TEST_F(CheckTest, JitterOfOneFrameOnly) {
    expectOnly(withManifest(options("half_planes"), [](Manifest& m) { m.frames[3].jitterPx = -m.frames[3].jitterPx; }),
               "jitter", "frame 4");
}

TEST_F(CheckTest, JitteredFramesThatClaimToBeCentred) {
    const CheckReport r = withManifest(options("half_planes"), [](Manifest& m) {
        m.jitterSequence = "none";
        for (auto& f : m.frames) f.jitterPx = glm::dvec2(0.0);
    });
    expectOnly(r, "jitter", "from the pixel centres");
}

TEST_F(CheckTest, MotionSignsAndAxes) {
    const auto damaged = [&](auto change) {
        return withFrames(options("moving"), [&](Frame& f) {
            for (int y = 0; y < f.height; y++)
                for (int x = 0; x < f.width; x++) change(f.motionXPx.at(x, y), f.motionYPx.at(x, y));
        });
    };
    expectOnly(damaged([](float& x, float& y) { x = -x, y = -y; }), "motion", "turn the sign of both");
    expectOnly(damaged([](float& x, float&) { x = -x; }), "motion", "turn the sign of motion.X");
    expectOnly(damaged([](float&, float& y) { y = -y; }), "motion", "turn the sign of motion.Y");
    expectOnly(damaged([](float& x, float& y) { std::swap(x, y); }), "motion", "exchange motion.X and motion.Y");
    expectOnly(damaged([](float& x, float& y) { x *= 8, y *= 8; }), "motion", "same object");
}

// One surface fills the picture and moves by (2.3, 1.2) px per frame, so that ids say the same of every variant.
void fillWithOneSurface(Frame& f, double (*pattern)(dvec2 onSurface, double time)) {
    const dvec2 motion(2.3, 1.2);
    for (int y = 0; y < f.height; y++)
        for (int x = 0; x < f.width; x++) {
            const dvec2 p = dvec2(x + 0.5, y + 0.5) + f.jitterPx;
            f.objectId.at(x, y) = 1;
            f.depthView.at(x, y) = 20;  // of object 1 in "moving"
            f.motionXPx.at(x, y) = float(motion.x), f.motionYPx.at(x, y) = float(motion.y);
            for (auto& channel : f.colorLinear.c)
                channel.at(x, y) = float(pattern(p - double(f.number) * motion, f.number));
        }
}
TEST_F(CheckTest, MotionByTextureAlone) {
    const auto texture = [](Frame& f) {
        fillWithOneSurface(f, [](dvec2 q, double) { return 0.5 + 0.2 * std::sin(q.x) + 0.2 * std::sin(0.7 * q.y); });
    };
    EXPECT_TRUE(withFrames(options("moving"), texture).clean());
    expectOnly(withFrames(options("moving"),
                          [&](Frame& f) {
                              texture(f);
                              for (int y = 0; y < f.height; y++)
                                  for (int x = 0; x < f.width; x++) f.motionXPx.at(x, y) *= -1;
                          }),
               "motion", "turn the sign of motion.X");
}
TEST_F(CheckTest, AShadowIsNoMotion) {
    // Its edge crosses the plain surface against the surface's way: (-2.3, 1.2) px per frame in the picture.
    const CheckReport r = withFrames(options("moving"), [](Frame& f) {
        fillWithOneSurface(f, [](dvec2 q, double time) { return q.x + 2 * 2.3 * time < 80 ? 0.2 : 0.6; });
    });
    EXPECT_TRUE(r.clean()) << lines(r);
    EXPECT_THAT(r.notChecked, Contains(HasSubstr("may be a shadow")));
}
TEST_F(CheckTest, MotionInAStaticShot) {
    Manifest m = SynthShot(options("circles")).manifest();
    const CheckReport r = checked(
        options("moving"), [](Frame&) {}, [](Manifest& manifest) { manifest.isStatic = true; });
    ASSERT_FALSE(r.clean());
    EXPECT_THAT(lines(r), HasSubstr("0 px (the shot is static)"));
}

TEST_F(CheckTest, DroppedFrame) {
    expectOnly(withManifest(options("moving"), [](Manifest& m) { m.frames.erase(m.frames.begin() + 2); }), "files",
               "expected frame 3 after frame 2, found frame 4");
    expectOnly(withManifest(options("moving"), [&](Manifest& m) { fs::remove(folder / m.frames[2].file); }), "files",
               "no such file");
    expectOnly(withManifest(options("moving"), [&](Manifest& m) { fs::resize_file(folder / m.frames[2].file, 900); }),
               "files", "000003.exr");
}

TEST_F(CheckTest, NumbersNameTheFirstPixel) {
    const CheckReport r = withFrames(options("moving", "d3d2"), [](Frame& f) {
        if (f.number != 2) return;
        f.colorLinear.c[1].at(7, 9) = NAN;
        f.colorLinear.c[1].at(8, 9) = INFINITY;
        f.subSamples[1].depthView.at(3, 4) = NAN;
    });
    EXPECT_THAT(lines(r),
                HasSubstr("numbers: frame 2, color G, pixel (7, 9): expected finite numbers, found 1 NaN and 1 Inf"));
    EXPECT_THAT(lines(r), HasSubstr("s01.Z, pixel (3, 4)"));
    EXPECT_EQ(r.findings.size(), 2u);
}

void scaleDepth(Frame& f, float scale, bool subSamplesToo) {
    const auto apply = [&](PlaneF& z) {
        for (int y = 0; y < f.height; y++)
            for (int x = 0; x < f.width; x++)
                if (z.at(x, y) < 1e9f) z.at(x, y) *= scale;
    };
    apply(f.depthView);
    if (subSamplesToo)
        for (auto& s : f.subSamples) apply(s.depthView);
}

TEST_F(CheckTest, ScaledDepth) {
    const auto damaged = [&](const char* scene, const char* subsamples, float scale, bool both) {
        return withFrames(options(scene, subsamples), [&](Frame& f) { scaleDepth(f, scale, both); });
    };
    expectOnly(damaged("moving", "", 100, true), "depth", "within near..far");
    expectOnly(damaged("moving", "", 0.001f, true), "depth", "within near..far");
    expectOnly(damaged("two_planes", "d3d4", 1.02f, false), "depth", "times as deep (by the subsamples)");
    expectOnly(damaged("two_planes", "", 1.05f, true), "depth", "depth_bounds");
    expectOnly(damaged("moving", "", 0.95f, true), "depth", "depth_bounds");
}

TEST_F(CheckTest, BoundsOfWhatIsNoObjectAreLeftOut) {
    const CheckReport r = withManifest(options("moving"), [](Manifest& m) {
        for (FrameEntry& f : m.frames)
            f.extra = R"({"depth_bounds": {"": [0, 1], "4294967297": [0, 0.1], "99999999999": [0, 0.1], "a": [0, 1]}})";
    });
    EXPECT_TRUE(r.clean()) << lines(r);
}

TEST_F(CheckTest, RayLengthInsteadOfDepth) {
    const CheckReport r = withFrames(options("two_planes", "d3d4"), [](Frame& f) {
        const auto toRayLength = [&](PlaneF& z, glm::dvec2 offset) {
            for (int y = 0; y < f.height; y++)
                for (int x = 0; x < f.width; x++) {
                    const double rx = (2 * (x + 0.5 + offset.x) / f.width - 1) / f.camera->projection[0][0];
                    const double ry = (1 - 2 * (y + 0.5 + offset.y) / f.height) / f.camera->projection[1][1];
                    if (z.at(x, y) < 1e9f) z.at(x, y) = float(z.at(x, y) * std::sqrt(1 + rx * rx + ry * ry));
                }
        };
        toRayLength(f.depthView, f.jitterPx);
        for (size_t k = 0; k < f.subSamples.size(); k++)
            toRayLength(f.subSamples[k].depthView, f.subSamplePositionsPx[k]);
    });
    ASSERT_FALSE(r.clean());
    EXPECT_THAT(lines(r), HasSubstr("the distance along the ray"));
}

TEST_F(CheckTest, NormalsOfAnotherSpaceOrEncoding) {
    const CheckReport view = withFrames(options("two_planes"), [](Frame& f) {
        const glm::dmat3 toView(f.camera->view);
        for (int y = 0; y < f.height; y++)
            for (int x = 0; x < f.width; x++) {
                auto& n = f.normalWorld.c;
                const glm::dvec3 v = toView * glm::dvec3(n[0].at(x, y), n[1].at(x, y), n[2].at(x, y));
                for (int c = 0; c < 3; c++) n[size_t(c)].at(x, y) = float(v[c]);
            }
    });
    expectOnly(view, "normal", "normals of view space");
    const CheckReport colours = withFrames(options("two_planes"), [](Frame& f) {
        for (auto& p : f.normalWorld.c)
            for (int y = 0; y < f.height; y++)
                for (int x = 0; x < f.width; x++) p.at(x, y) = p.at(x, y) * 0.5f + 0.5f;
    });
    EXPECT_THAT(lines(colours), HasSubstr("unit length on surfaces"));
}

TEST_F(CheckTest, UnknownAndLostIds) {
    expectOnly(withFrames(options("circles"), [](Frame& f) { f.objectId.at(20, 30) = 4711; }), "object",
               "pixel (20, 30)");
    expectOnly(withFrames(options("circles"), [](Frame& f) { f.objectId.at(20, 30) = 0; }), "object",
               "id 0 exactly where depth is background");
}

TEST_F(CheckTest, JsonHoldsTheFindings) {
    const auto j = toJson(withFrames(options("moving"), [](Frame& f) { f.colorLinear.c[0].at(1, 2) = NAN; }));
    EXPECT_EQ(j["clean"], false);
    EXPECT_EQ(j["findings"][0]["channel"], "color R");
    EXPECT_EQ(j["findings"][0]["pixel"], nlohmann::ordered_json({1, 2}));
    EXPECT_TRUE(j["measured"].contains("motion.sameObjectShare"));
}
}  // namespace
}  // namespace aa
