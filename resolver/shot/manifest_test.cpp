#include "shot/manifest.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "image/error.h"

namespace aa {
namespace {
using nlohmann::json;
using ::testing::HasSubstr;

json identity() {
    json m = json::array();
    for (int i = 0; i < 16; i++) m.push_back(i % 5 == 0 ? 1.0 : 0.0);
    return m;
}
json validShot() {
    json j = json::parse(R"({
      "format": "aaresolve-shot", "version": 1, "name": "pipe", "resolution": [480, 270], "fps": 24,
      "jitter": {"sequence": "halton23", "start": 1, "period": 16}, "static": false,
      "subsamples": {"pattern": "d3d2", "positions": [[0.25, 0.25], [-0.25, -0.25]]},
      "objects": {"1": "Pipe", "4294967295": "Wall"},
      "truth": {"samples_per_half": 256, "filter": "box", "filter_width": 1.0},
      "frames": [{"frame": 7, "file": "frames/000007.exr", "truth": "truth/000007.exr", "reset": true,
                  "jitter": [0.0, -0.1667], "render_seconds": {"color": 0.4, "truth": 51.0}},
                 {"frame": 8, "file": "frames/000008.exr", "jitter": [0.25, 0.125]}],
      "producer": {"name": "aa_resolve", "blender": "3.4.1"}})");
    j["frames"][0]["camera"] = {
        {"kind", "perspective"}, {"view", identity()}, {"projection", identity()}, {"near", 0.1}, {"far", 100}};
    return j;
}
Manifest parse(const json& j) { return parseManifest(j.dump(), "SHOT/shot.json"); }
std::string errorOf(const std::string& text) {
    try {
        parseManifest(text, "SHOT/shot.json");
    } catch (const InputError& e) {
        return e.what();
    }
    return "no error";
}
std::string errorOf(const json& j) { return errorOf(j.dump()); }

TEST(Manifest, PremultipliedJitterIsKeptAndNeverAssumed) {
    json j = validShot();
    EXPECT_FALSE(parse(j).jitterPremultiplied);
    EXPECT_FALSE(toJson(parse(j))["jitter"].contains("projection"));
    j["jitter"]["projection"] = "postmultiplied";
    EXPECT_FALSE(parse(j).jitterPremultiplied);
    j["jitter"]["projection"] = "premultiplied";
    EXPECT_TRUE(parse(j).jitterPremultiplied);
    EXPECT_EQ(toJson(parse(j))["jitter"]["projection"], "premultiplied");
    j["jitter"]["projection"] = "pre";
    EXPECT_THAT(errorOf(j), HasSubstr("jitter.projection"));
}

TEST(Manifest, ReadsEveryMember) {
    const Manifest m = parse(validShot());
    EXPECT_EQ(m.name, "pipe");
    EXPECT_EQ(m.width, 480);
    EXPECT_EQ(m.height, 270);
    EXPECT_EQ(m.jitterSequence, "halton23");
    EXPECT_EQ(m.jitterPeriod, 16);
    EXPECT_FALSE(m.isStatic);
    EXPECT_EQ(m.subsamplePositionsPx.size(), 2u);
    EXPECT_EQ(m.subsamplePositionsPx[1], glm::dvec2(-0.25, -0.25));
    EXPECT_EQ(m.objects.at(4294967295u), "Wall");
    EXPECT_EQ(m.truthSamplesPerHalf, 256);
    ASSERT_EQ(m.frames.size(), 2u);
    EXPECT_EQ(m.frames[0].frame, 7);
    EXPECT_TRUE(m.frames[0].reset);
    EXPECT_FALSE(m.frames[1].reset);
    EXPECT_EQ(m.frames[0].jitterPx, glm::dvec2(0.0, -0.1667));
    EXPECT_EQ(m.frames[0].renderSeconds.at("truth"), 51.0);
    EXPECT_TRUE(m.frames[1].truth.empty());
    EXPECT_EQ(m.folder, "SHOT");
    EXPECT_EQ(m.find(8), &m.frames[1]);
    EXPECT_EQ(m.find(9), nullptr);
}

TEST(Manifest, MatricesAreRowMajorInTheFile) {
    json j = validShot();
    for (int i = 0; i < 16; i++) j["frames"][0]["camera"]["view"][size_t(i)] = i;
    const glm::dmat4 view = parse(j).frames[0].camera->view;
    EXPECT_EQ(view[3][0], 3.0);  // glm: column 3, row 0 = the x translation
    EXPECT_EQ(view[0][3], 12.0);
    EXPECT_EQ(toJson(parse(j))["frames"][0]["camera"]["view"], j["frames"][0]["camera"]["view"]);
}

TEST(Manifest, RoundTripKeepsUnknownMembersEverywhere) {
    json j = validShot();
    j["future"] = {{"deep", {1, 2, "three"}}};
    j["jitter"]["centre"] = true;
    j["subsamples"]["note"] = "x";
    j["truth"]["seed"] = 3;
    j["frames"][1]["note"] = 5;
    j["frames"][0]["camera"]["lens"] = 50;
    const json written = toJson(parse(j));
    for (const char* path : {"/future", "/jitter/centre", "/subsamples/note", "/truth/seed", "/frames/1/note",
                             "/frames/0/camera/lens", "/producer"})
        EXPECT_EQ(written.value(json::json_pointer(path), json()), j[json::json_pointer(path)]) << path;
    EXPECT_EQ(toJson(parse(written)), written);
}

TEST(Manifest, ErrorsNameFileMemberExpectedAndFound) {
    const auto broken = [](const char* path, const json& value) {
        json j = validShot();
        j[json::json_pointer(path)] = value;
        return errorOf(j);
    };
    const std::tuple<const char*, json, const char*, const char*> cases[] = {
        {"/frames/1/jitter", "abc", "frames[1].jitter", "array of 2 numbers, found \"abc\""},
        {"/frames/1/jitter", {0.1}, "frames[1].jitter", "array of 2 numbers, found an array of 1"},
        {"/frames/1/jitter/0", "x", "frames[1].jitter[0]", "a number, found \"x\""},
        {"/frames/1/jitter/0", 17.0, "frames[1].jitter", "within -0.5..0.5 px, found [17.0, 0.125]"},
        {"/frames/1/frame", 7, "frames[1].frame", "a frame number of its own, found 7 for the second time"},
        {"/frames/1/frame", 3, "frames[1].frame", "increase (after 7), found 3"},
        {"/frames/1/frame", 1.5, "frames[1].frame", "an integer"},
        {"/frames/1/frame", 18446744073709551615ull, "frames[1].frame", "an integer"},
        {"/frames/1/file", "../x.exr", "frames[1].file", "below the shot's folder"},
        {"/frames/1/file", "/etc/passwd", "frames[1].file", "below the shot's folder"},
        {"/frames/1/file", "a/../../b.exr", "frames[1].file", "below the shot's folder"},
        {"/frames/1/file", "", "frames[1].file", "below the shot's folder"},
        {"/frames/0/truth", 3, "frames[0].truth", "a text, found 3"},
        {"/frames/0/reset", 1, "frames[0].reset", "true or false, found 1"},
        {"/frames/0/camera/view/15", nullptr, "frames[0].camera.view[15]", "a number, found null"},
        {"/frames/0/camera/kind", "fisheye", "frames[0].camera.kind", "\"perspective\""},
        {"/frames/0/camera/far", 0.01, "frames[0].camera.far", "at least `near`"},
        {"/frames/0/render_seconds/color", "fast", "frames[0].render_seconds.color", "a number"},
        {"/frames", json::array(), "frames", "at least one frame"},
        {"/frames", 5, "frames", "an array, found 5"},
        {"/resolution", {480}, "resolution", "[width, height]"},
        {"/resolution/0", 0, "resolution[0]", "1..16384, found 0"},
        {"/resolution/1", 16385, "resolution[1]", "1..16384, found 16385"},
        {"/resolution/1", "270", "resolution[1]", "found \"270\""},
        {"/format", "other", "format", "\"aaresolve-shot\", found \"other\""},
        {"/version", 2, "version", "version 1"},
        {"/static", "yes", "static", "true or false"},
        {"/fps", 0, "fps", "frames per second"},
        {"/jitter/period", 0, "jitter.period", "an integer in 1.."},
        {"/jitter/sequence", nullptr, "jitter.sequence", "a text"},
        {"/subsamples/positions/1", {0.7, 0.0}, "subsamples.positions[1]", "within -0.5..0.5"},
        {"/objects/x", "Pipe", "objects", "ids"},
        {"/objects/4294967296", "Pipe", "objects", "ids"},
        {"/objects/2", 2, "objects.2", "a text"},
    };
    for (const auto& [path, value, member, expected] : cases) {
        const std::string e = broken(path, value);
        EXPECT_THAT(e, HasSubstr("SHOT/shot.json: ")) << path;
        EXPECT_THAT(e, HasSubstr(std::string(member) + ": expected ")) << path;
        EXPECT_THAT(e, HasSubstr(expected)) << path;
        EXPECT_EQ(e.find('\n'), std::string::npos) << path;
    }
}

TEST(Manifest, MissingRequiredMembersAreErrorsAndOptionalOnesAreNot) {
    for (const char* path :
         {"/format", "/version", "/resolution", "/frames", "/jitter/sequence", "/subsamples/pattern",
          "/subsamples/positions", "/frames/0/frame", "/frames/0/file", "/frames/0/jitter", "/frames/0/camera/kind",
          "/frames/0/camera/view", "/frames/0/camera/projection", "/frames/0/camera/near", "/frames/0/camera/far"}) {
        json j = validShot();
        const json::json_pointer p(path);
        j[p.parent_pointer()].erase(p.back());
        EXPECT_THAT(errorOf(j), HasSubstr("missing")) << path;
    }
    for (const char* path :
         {"/name", "/fps", "/jitter", "/static", "/subsamples", "/objects", "/truth", "/producer", "/frames/0/truth",
          "/frames/0/reset", "/frames/0/camera", "/frames/0/render_seconds", "/truth/filter"}) {
        json j = validShot();
        const json::json_pointer p(path);
        j[p.parent_pointer()].erase(p.back());
        EXPECT_EQ(errorOf(j), "no error") << path;
    }
}

// Frames are read as they come: what is wrong with the document is still said first, then the first wrong frame.
TEST(Manifest, TheFirstFaultIsSaid) {
    json j = validShot();
    j["frames"][1]["frame"] = 7;
    EXPECT_THAT(errorOf(j), HasSubstr("frames[1].frame: expected a frame number of its own"));
    j["frames"].push_back({{"frame", 9}, {"file", 1}});
    EXPECT_THAT(errorOf(j), HasSubstr("frames[1].frame: expected a frame number of its own"));
    j["frames"][1]["frame"] = 8;
    EXPECT_THAT(errorOf(j), HasSubstr("frames[2].file: expected a text, found 1"));
    j["frames"].push_back("no frame");
    EXPECT_THAT(errorOf(j), HasSubstr("frames[2].file: expected a text, found 1"));
    j["version"] = 2;
    EXPECT_THAT(errorOf(j), HasSubstr("version 1 (what this program reads), found 2"));
    for (const json& frames : {json(3), json::object({{"0", validShot()["frames"][0]}}), json::array()}) {
        json other = validShot();
        other["frames"] = frames;
        EXPECT_THAT(errorOf(other), HasSubstr(": frames: expected "));
    }
    j = validShot();
    j["frames"] = json::array({"no frame"});
    EXPECT_THAT(errorOf(j), HasSubstr("frames[0]: expected an object, found \"no frame\""));
}
TEST(Manifest, NamesOfMembersMayHoldAnything) {
    json j = validShot();
    j["frames"][0]["render_seconds"][std::string("a\0b", 3)] = 1.5;
    EXPECT_EQ(parse(j).frames[0].renderSeconds.at(std::string("a\0b", 3)), 1.5);
}
// JSON lets the last of two members of one name count; nobody knows which was meant.
TEST(Manifest, AMemberThatStandsTwiceIsNamed) {
    const std::string text = validShot().dump(), frame = R"({"frame": 3, "file": "frames/3.exr", "jitter": [0, 0]})";
    const auto with = [&](const std::string& more) { return text.substr(0, text.size() - 1) + ", " + more + "}"; };
    for (const std::string name : {"frames", "resolution"})
        EXPECT_THAT(errorOf(with("\"" + name + "\": [16, 8]")),
                    HasSubstr("shot.json: member '" + name + "' stands twice in one object; correct it"));
    EXPECT_THAT(errorOf(with(R"("other": [{"a": {"b": 1, "c": 2, "b": 3}}])")), HasSubstr("member 'b' stands twice"));
    EXPECT_EQ(parseManifest(with(R"("other": {"frames": [)" + frame + "]}"), "SHOT/shot.json").frames.size(), 2u);
}

TEST(Manifest, DamagedTextIsOneLineWithThePlace) {
    EXPECT_THAT(errorOf(std::string("{\n \"format\": ,\n}")), HasSubstr("line 2, column 12"));
    EXPECT_THAT(errorOf(std::string()), HasSubstr("not valid JSON"));
    EXPECT_THAT(errorOf(std::string("[1, 2]")), HasSubstr("expected an object, found an array"));
    EXPECT_THAT(errorOf(std::string("{\"fps\": 1e999}")), HasSubstr("does not fit"));
    EXPECT_THAT(errorOf(std::string(100000, '[')), HasSubstr("nested deeper"));
    EXPECT_THAT(errorOf(std::string("{\"name\": \"\xff\"}")), HasSubstr("not valid JSON"));
}

TEST(Manifest, WritesThroughATemporaryNameAndReadsBack) {
    const auto folder = std::filesystem::path(testing::TempDir()) / "aa_manifest_test";
    std::filesystem::create_directories(folder);
    Manifest m = parse(validShot());
    m.folder = folder;
    writeManifest(m);
    EXPECT_EQ(toJson(readManifest(folder)), toJson(m));
    EXPECT_EQ(toJson(readManifest(folder / "shot.json")), toJson(m));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
    std::filesystem::remove_all(folder);
    EXPECT_THROW(readManifest(folder), InputError);
}
}  // namespace
}  // namespace aa
