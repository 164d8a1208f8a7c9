// Shots of a camera that moves through a resting scene: what the parallax shows, and that nothing else is blamed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include "shot/check/check.h"
#include "shot/jitter.h"
#include "shot/manifest.h"
#include "shot/writer.h"

namespace aa {
namespace {
namespace fs = std::filesystem;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr int kWidth = 160, kHeight = 100, kFrames = 5;

// A rectangle in the world: corner + a * along + b * across, 0 <= a, b <= 1.
struct Card {
    uint32_t id;
    dvec3 corner, along, across;
    dvec3 normal() const { return glm::normalize(glm::cross(along, across)); }
};
const std::vector<Card> kWorld = {
    {1, {-30, -1, 2}, {60, 0, 0}, {0, 0, -60}},   // floor
    {2, {-30, -5, -12}, {60, 0, 4}, {0, 40, 0}},  // wall, turned
    {3, {-1.6, -1, -5}, {1.1, 0, 0.3}, {0, 1.4, 0}},
    {4, {0.7, -0.8, -7}, {1.6, 0, -0.5}, {0.1, 2.1, 0}},
};

struct Shot {
    bool moves = true;
    Manifest manifest;
    std::vector<Frame> frames;

    Camera cameraAt(int i) const {
        Camera c;
        const double t = moves ? i : 0;
        c.projection = glm::perspective(0.7, double(kWidth) / kHeight, 0.1, 100.0);
        c.view = glm::rotate(glm::dmat4(1.0), 0.012 * t, dvec3(0, 1, 0)) *
                 glm::translate(glm::dmat4(1.0), -dvec3(0.12 * t, 0.1 + 0.02 * t, 1.0 - 0.15 * t));
        return c;
    }
    static dvec2 positionOf(const Camera& c, dvec3 world) {
        const dvec4 clip = c.projection * c.view * dvec4(world, 1);
        return {(clip.x / clip.w + 1) / 2 * kWidth, (1 - clip.y / clip.w) / 2 * kHeight};
    }
    explicit Shot(bool cameraMoves) : moves(cameraMoves) {
        manifest.name = "camera";
        manifest.width = kWidth;
        manifest.height = kHeight;
        manifest.jitterSequence = "halton23";
        manifest.jitterPeriod = 16;
        for (const Card& card : kWorld) manifest.objects[card.id] = "card " + std::to_string(card.id);
        for (int i = 0; i < kFrames; i++) {
            FrameEntry e;
            e.frame = i + 1;
            e.file = "frames/" + std::to_string(i + 1) + ".exr";
            e.reset = i == 0;
            e.jitterPx = jitterPx({}, uint64_t(i));
            e.camera = cameraAt(i);
            manifest.frames.push_back(e);
            frames.push_back(rendered(i, e));
        }
    }
    Frame rendered(int index, const FrameEntry& e) const {
        Frame f;
        f.number = e.frame;
        f.width = kWidth;
        f.height = kHeight;
        f.jitterPx = e.jitterPx;
        f.passes = Pass::color | Pass::depth | Pass::normal | Pass::object | Pass::motion;
        f.colorLinear = f.normalWorld = Rgb(kWidth, kHeight);
        f.depthView = f.motionXPx = f.motionYPx = PlaneF(kWidth, kHeight);
        f.objectId = PlaneU(kWidth, kHeight);
        const Camera now = *e.camera, before = cameraAt(std::max(index - 1, 0));
        const glm::dmat4 toWorld = glm::inverse(now.view);
        const dvec3 eye(toWorld[3]);
        for (int y = 0; y < kHeight; y++)
            for (int x = 0; x < kWidth; x++) {
                const dvec2 p = dvec2(x + 0.5, y + 0.5) + e.jitterPx;
                const dvec3 ray((2 * p.x / kWidth - 1) / now.projection[0][0],
                                (1 - 2 * p.y / kHeight) / now.projection[1][1], -1);
                const dvec3 direction = glm::dmat3(toWorld) * ray;  // z of 1 per unit
                double z = 1e10;
                for (const Card& card : kWorld) {
                    const dvec3 n = card.normal();
                    const double t = glm::dot(card.corner - eye, n) / glm::dot(direction, n);
                    const dvec3 at = eye + t * direction - card.corner;
                    const double a = glm::dot(at, card.along) / glm::dot(card.along, card.along),
                                 b = glm::dot(at, card.across) / glm::dot(card.across, card.across);
                    if (!(t > 0.1 && t < z && a >= 0 && a <= 1 && b >= 0 && b <= 1)) continue;
                    z = t;
                    const dvec3 facing = glm::dot(n, direction) < 0 ? n : -n;
                    for (int c = 0; c < 3; c++) {
                        f.normalWorld.c[size_t(c)].at(x, y) = float(facing[c]);
                        f.colorLinear.c[size_t(c)].at(x, y) = 0.2f * float(card.id) + 0.05f * float(c);
                    }
                    f.objectId.at(x, y) = card.id;
                }
                f.depthView.at(x, y) = float(z);
                const dvec2 motion = p - positionOf(before, eye + direction * std::min(z, 1e7));
                f.motionXPx.at(x, y) = float(motion.x);
                f.motionYPx.at(x, y) = float(motion.y);
            }
        return f;
    }
    template <class Change>
    void eachPixel(Change change) {
        for (Frame& f : frames)
            for (int y = 0; y < kHeight; y++)
                for (int x = 0; x < kWidth; x++) change(f, x, y);
    }
};

class CheckCamera : public testing::Test {
  protected:
    void SetUp() override {
        folder = fs::path(testing::TempDir()) /
                 (std::string("aa_camera_") + testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(folder / "frames");
    }
    void TearDown() override { fs::remove_all(folder); }
    CheckReport checked(Shot& s) {
        s.manifest.folder = folder;
        for (size_t i = 0; i < s.frames.size(); i++)
            writeFrame(folder / s.manifest.frames[i].file, s.frames[i], !s.manifest.isStatic);
        writeManifest(s.manifest);
        return checkShot(folder);
    }
    static std::string lines(const CheckReport& r) {
        std::string all;
        for (const auto& f : r.findings) all += f.line() + "\n";
        return all;
    }
    static void expectOnly(const CheckReport& r, const char* check, const char* says) {
        EXPECT_FALSE(r.clean());
        for (const auto& f : r.findings) EXPECT_EQ(f.check, check) << f.line();
        EXPECT_THAT(lines(r), HasSubstr(says));
    }
    fs::path folder;
};

TEST_F(CheckCamera, AMovingCameraMeasuresTheScaleOfDepth) {
    Shot s(true);
    const CheckReport r = checked(s);
    EXPECT_EQ(lines(r), "");
    double scale = 0;
    for (const auto& m : r.measured)
        if (m.name == "depth.scale.parallax") scale = m.value;
    EXPECT_NEAR(scale, 1, 1e-3);
}

TEST_F(CheckCamera, ScaledDepth) {
    for (const float scale : {1.1f, 0.97f}) {
        Shot s(true);
        s.eachPixel([&](Frame& f, int x, int y) {
            if (f.depthView.at(x, y) < 1e9f) f.depthView.at(x, y) *= scale;
        });
        expectOnly(checked(s), "depth", scale > 1 ? "1.1 times as deep (by the parallax)" : "0.97 times as deep");
    }
}

TEST_F(CheckCamera, ARestingCameraSaysThatItCannotTell) {
    Shot s(false);
    s.manifest.isStatic = true;
    s.eachPixel([](Frame& f, int x, int y) {
        if (f.depthView.at(x, y) < 1e9f) f.depthView.at(x, y) *= 1.1f;
    });
    const CheckReport r = checked(s);
    EXPECT_EQ(lines(r), "");
    EXPECT_THAT(r.notChecked, Contains(HasSubstr("a scaled depth looks the same")));
}

TEST_F(CheckCamera, MotionSignsAndAxes) {
    const auto damaged = [&](auto change) {
        Shot s(true);
        s.eachPixel([&](Frame& f, int x, int y) { change(f.motionXPx.at(x, y), f.motionYPx.at(x, y)); });
        return checked(s);
    };
    expectOnly(damaged([](float& x, float& y) { x = -x, y = -y; }), "motion", "turn the sign of both");
    expectOnly(damaged([](float& x, float&) { x = -x; }), "motion", "turn the sign of motion.X");
    expectOnly(damaged([](float& x, float& y) { std::swap(x, y); }), "motion", "exchange motion.X and motion.Y");
}

TEST_F(CheckCamera, MotionIsJudgedWithoutIds) {
    const auto checkedWithout = [&](auto change) {
        Shot s(true);
        for (Frame& f : s.frames) f.passes = f.passes.without(Pass::object);
        s.eachPixel([&](Frame& f, int x, int y) { change(f.motionXPx.at(x, y), f.motionYPx.at(x, y)); });
        return checked(s);
    };
    EXPECT_EQ(lines(checkedWithout([](float&, float&) {})), "");
    expectOnly(checkedWithout([](float& x, float& y) { x = -x, y = -y; }), "motion", "turn the sign of both");
    expectOnly(checkedWithout([](float& x, float& y) { std::swap(x, y); }), "motion", "exchange motion.X and motion.Y");
}

TEST_F(CheckCamera, IdsThatChange) {
    Shot s(true);
    s.eachPixel([](Frame& f, int x, int y) {  // every object is numbered anew in frame 4
        uint32_t& id = f.objectId.at(x, y);
        if (f.number >= 4 && id) id = id % 4 + 1;
    });
    expectOnly(checked(s), "object", "frame 4, id");
    Shot one(true);
    one.eachPixel([](Frame& f, int x, int y) {
        uint32_t& id = f.objectId.at(x, y);
        if (f.number >= 3 && id == 3) id = 9;
    });
    one.manifest.objects[9] = "the third under another id";
    expectOnly(checked(one), "object", "ids that stay with their objects: 3 as in frame 2, found 9");
}

TEST_F(CheckCamera, IdsThatChangeWhileNothingMoves) {
    Shot s(false);
    s.manifest.isStatic = true;
    s.eachPixel([](Frame& f, int x, int y) {
        uint32_t& id = f.objectId.at(x, y);
        if (f.number == 2 && (id == 3 || id == 4)) id = 7 - id;
    });
    expectOnly(checked(s), "object", "ids that stay with their objects");
}
}  // namespace
}  // namespace aa
