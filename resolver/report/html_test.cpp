#include "report/html.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <regex>

#include "image/io.h"
#include "report/advice.h"
#include "report/caption.h"

namespace aa {
namespace {
namespace fs = std::filesystem;

MethodResult method(const std::string& id, double mse, double seconds) {
    MethodResult m;
    m.id = m.text = m.folder = id;
    FrameResult f;
    FrameMetrics metrics;
    metrics.mse = mse, metrics.reference = 0.2, metrics.psnr = psnr(mse), metrics.snr = snr({mse, 0.2}),
    metrics.others["ssimLuma"] = 0.9;
    f.frame = 1, f.seconds = seconds, f.metrics = metrics;
    m.frames = {f};
    return m;
}
// Tile errors that agree with the methods' MSE, equal in all tiles: every difference is consistent.
// `noisy` moves every second tile of the last method up or down, `byTruth` by what the truth's halves differ in.
RunResults runOf(std::vector<MethodResult> methods, double noise, double noisy = 0, bool byTruth = false) {
    RunResults run;
    run.shot = "</script><b>shot", run.width = run.height = 100, run.truthNoise = noise, run.programVersion = "1";
    run.methods = std::move(methods);
    std::vector<TileErrors> errors;
    for (const auto& m : run.methods) {
        TileErrors e;
        e.values.assign(16, 3072);
        e.sum.assign(16, 3072 * m.frames[0].metrics->mse);
        if (noisy > 0) {
            e.againstA = e.againstB = e.sum;
            for (size_t i = 0; i < 16 && &m == &run.methods.back(); i++) {
                const double moved = 3072 * noisy * (i * 7 % 16 % 4 < 2 ? 1 : -1);
                for (auto* v : {&e.sum, &e.againstA, &e.againstB}) (*v)[i] += moved;
                if (byTruth) e.againstA[i] += moved, e.againstB[i] -= moved;
            }
        }
        errors.push_back(e);
    }
    finish(run, errors);
    return run;
}
std::string allOf(const std::vector<std::string>& sentences) {
    return std::accumulate(sentences.begin(), sentences.end(), std::string(),
                           [](auto a, auto& b) { return a + b + "\n"; });
}
bool says(const RunResults& run, const std::string& text) {
    return allOf(captions(run)).find(text) != std::string::npos;
}

TEST(Caption, FollowsTheFigures) {
    const RunResults run =
        runOf({method("noaa", 1e-3, 1e-5), method("accum", 1e-4, 9e-5), method("fxaa311", 5e-4, 3e-5),
               method("uncharted", 4e-3, 5e-5), method("unchartedNorm", 2e-4, 5e-5)},
              1e-7);
    EXPECT_TRUE(says(run,
                     "accum is nearest to the ground truth: PSNR 40.00 dB, +10.00 dB (95 %: +10.00 to +10.00) "
                     "over no anti-aliasing."))
        << allOf(captions(run));
    EXPECT_TRUE(says(run,
                     "fxaa311 is the cheapest that helps: +3.01 dB (95 %: +3.01 to +3.01) for 3 ns per pixel, where "
                     "accum takes 9."));
    EXPECT_TRUE(
        says(run, "Farther from the truth than no anti-aliasing at all: uncharted, -6.02 dB (95 %: -6.02 to -6.02)."));
    EXPECT_TRUE(says(run, "The sharpen filter of uncharted costs 13.01 dB"));
    EXPECT_TRUE(says(run, "All methods can be told apart"));
    EXPECT_TRUE(says(run, "0.1 % of the smallest error."));
}
TEST(Caption, SaysWhatIsNotResolved) {
    const auto threeOf = [](bool byTruth) {
        return runOf({method("noaa", 1e-3, 1e-5), method("a", 1.00e-4, 2e-5), method("b", 1.01e-4, 2e-5)}, 2e-6, 2e-5,
                     byTruth);
    };
    const RunResults run = threeOf(false);
    EXPECT_TRUE(says(run, "; b cannot be told apart from it.")) << allOf(captions(run));
    EXPECT_TRUE(says(run, "Not told apart, for now one is better and now the other over the picture: a and b."))
        << allOf(captions(run));
    EXPECT_TRUE(says(threeOf(true), "Not told apart, for the truth's noise hides what they differ by: a and b."))
        << allOf(captions(threeOf(true)));
    EXPECT_TRUE(says(run, "render the truth with more samples"));
    EXPECT_FALSE(says(run, "sharpen"));
    EXPECT_FALSE(says(run, "Farther"));
}
// What a budget buys: fxaa311 first, then the temporal method that asks for motion; the dear one that is not resolved
// from it, and the one that harms, are not named as steps.
TEST(Advice, NamesTheBestOfEveryBudgetAndInput) {
    auto methods =
        std::vector{method("noaa", 1e-3, 1e-5),    method("fxaa311", 5e-4, 3e-5), method("smaa1x", 4e-4, 6e-5),
                    method("worse", 2e-3, 2e-5),   method("karis", 1e-4, 9e-5),   method("gbaa", 4.5e-4, 9e-5),
                    method("same", 4.001e-4, 7e-5)};
    for (auto& m : methods) m.passes = {"color"};
    methods[4].passes = {"color", "depth", "motion"};
    methods[5].passes = {"color", "edges"};
    const RunResults run = runOf(methods, 0, 1e-5);
    const auto advice = adviceOf(run);
    ASSERT_EQ(advice.size(), 2u) << "edges buy nothing more here";
    ASSERT_EQ(advice[0].steps.size(), 2u);
    EXPECT_EQ(advice[0].steps[0].method, 1u);
    EXPECT_EQ(advice[0].steps[1].method, 2u);
    ASSERT_EQ(advice[1].steps.size(), 3u);
    EXPECT_EQ(advice[1].steps[2].method, 4u);
    const auto words = adviceInWords(run);
    EXPECT_NE(words[0].find("From colour alone: from 3 ns/px fxaa311, +3.01 dB (95 %: "), std::string::npos)
        << words[0];
    EXPECT_NE(words[1].find("With depth, motion and the like: "), std::string::npos) << words[1];
    EXPECT_TRUE(adviceOf(runOf({method("fxaa311", 5e-4, 3e-5)}, 0)).empty()) << "no noaa";
    // A cheaper method from which the chosen one is not told apart is named beside it.
    const RunResults near =
        runOf({method("noaa", 1e-3, 1e-5), method("late", 4.0e-4, 9e-5), method("early", 4.1e-4, 6e-5)}, 0, 5e-5);
    ASSERT_EQ(adviceOf(near).size(), 1u);
    EXPECT_EQ(adviceOf(near)[0].steps.size(), 1u) << "the dearer one is not resolved better";
    EXPECT_TRUE(adviceOf(near)[0].steps[0].alike.empty()) << "it is resolved better than noaa";
    // By a decibel and more, though unresolved: noaa is named first among those it is not told from.
    RunResults unsure =
        runOf({method("noaa", 1e-3, 1e-5), method("first", 7e-4, 2e-5), method("second", 5e-4, 3e-5)}, 0);
    for (PairResult& p : unsure.pairs) p.comparison.resolved = false, p.comparison.why = Unresolved::varies;
    const auto told = adviceInWords(unsure);
    EXPECT_NE(told[0].find("first, +1.55 dB (95 %: +1.55 to +1.55), not told apart from noaa;"), std::string::npos)
        << told[0];
    EXPECT_NE(told[0].find(", not told apart from noaa and first."), std::string::npos) << told[0];
}
TEST(Caption, SharpeningCanGainAndCanBeAParameter) {
    const RunResults gains = runOf({method("uncharted", 1e-4, 1e-5), method("unchartedNorm", 2e-4, 1e-5)}, 0);
    EXPECT_TRUE(says(gains, "The sharpen filter of uncharted gains 3.01 dB over unchartedNorm."));
    auto strong = method("x", 4e-4, 1e-5), weak = method("x", 1e-4, 1e-5);
    strong.text = "x:sharpen=1", weak.text = "x:sharpen=0";
    strong.parameters = {{"sharpen", "1"}, {"k", "2"}}, weak.parameters = {{"sharpen", "0"}, {"k", "2"}};
    EXPECT_TRUE(says(runOf({strong, weak}, 0), "The sharpen filter of x:sharpen=1 costs 6.02 dB"));
    weak.parameters["k"] = "3";  // now something else differs too
    EXPECT_FALSE(says(runOf({strong, weak}, 0), "sharpen filter"));
}
// A moving run of two methods with history over twelve frames; their ghosts scatter by 10 % from frame to frame.
RunResults overTime(double ghostOfB) {
    constexpr double scatter = 0.1;
    RunResults run = runOf({method("noaa", 1e-3, 1e-5), method("a", 2e-4, 2e-5), method("b", 3e-4, 2e-5)}, 0);
    for (size_t k = 0; k < 3; k++) {
        auto& m = run.methods[k];
        m.family = k ? "temporal" : "reference";
        m.temporal = TemporalMetrics{};
        const double ghost = k == 0 ? 0.02 : k == 1 ? 0.01 : ghostOfB, flicker = k == 1 ? 1e-4 : 4e-4;
        m.temporal->ghostMse = ghost, m.temporal->flickerMoving = 255 * std::sqrt(flicker);
        const FrameResult first = m.frames[0];
        m.frames.clear();
        for (int n = 0; n < 12; n++) {
            FrameResult f = first;
            f.frame = n;
            const double here = 1 + (n % 2 ? scatter : -scatter) * (k == 1 ? 1 : -1) * (n < 6 ? 1 : 0.2);
            f.temporal = TemporalFrame{ghost * here * 100, 100, flicker * here * 100, 100};
            if (k) f.rejected = FrameSum{ghost * here * 30, 30};
            m.frames.push_back(f);
        }
    }
    std::vector<TileErrors> errors(3);
    for (size_t k = 0; k < 3; k++) errors[k].values.assign(16, 3072), errors[k].sum.assign(16, double(k + 1));
    finish(run, errors);
    return run;
}
TEST(Caption, OverTime) {
    const RunResults run = overTime(0.04);
    EXPECT_TRUE(says(run, "is least for a (0.5 times) and largest for b (2 times).")) << allOf(captions(run));
    EXPECT_TRUE(says(run, "a (2.6 codes of 255) flickers least and b (5.1 codes of 255) most."))
        << allOf(captions(run));
    const PairResult& p = run.pairs[2];  // a and b
    EXPECT_NEAR(p.ghost->gainDb, 6.02, 0.3);
    EXPECT_TRUE(p.ghost->resolved);
    EXPECT_GT(*run.methods[1].temporal->ghostMseError, 0);
    EXPECT_LT(*run.methods[1].temporal->ghostMseError, 0.005);
    EXPECT_NEAR(*run.methods[2].rejectedMse, 0.04, 0.001);
    EXPECT_FALSE(run.methods[0].rejectedMse);
    EXPECT_FALSE(p.rejected);  // other methods, other pixels
}
TEST(Caption, GhostsThatCannotBeTold) {
    EXPECT_TRUE(says(overTime(0.0102), "a difference that these frames cannot resolve."))
        << allOf(captions(overTime(0.0102)));
}
TEST(Results, OverTimeSurvivesTheFile) {
    const fs::path folder = fs::temp_directory_path() / "aaresolve_results_time";
    makeWritableFolder(folder);
    const RunResults run = overTime(0.04);
    writeResults(run, folder);
    const RunResults back = readResults(folder);
    EXPECT_EQ(toJsonText(back), toJsonText(run));
    EXPECT_TRUE(back.methods[1].frames[3].rejected && back.methods[1].frames[3].temporal);
    EXPECT_EQ(back.methods[1].tileSquares.size(), 4u) << "four tiles of 32 px";
    EXPECT_TRUE(back.pairs[2].flicker);
    fs::remove_all(folder);
}
TEST(Caption, WithoutTruth) {
    RunResults run;
    run.methods = {method("noaa", 1, 1)};
    run.methods[0].frames[0].metrics.reset();
    finish(run, {});
    EXPECT_TRUE(says(run, "no ground truth"));
}

TEST(Html, Base64) {  // RFC 4648 s.10
    const auto encode = [](const std::string& s) { return base64({s.begin(), s.end()}); };
    EXPECT_EQ(encode(""), "");
    EXPECT_EQ(encode("f"), "Zg==");
    EXPECT_EQ(encode("fo"), "Zm8=");
    EXPECT_EQ(encode("foo"), "Zm9v");
    EXPECT_EQ(encode("foobar"), "Zm9vYmFy");
}
TEST(Html, PngKeepsTheCodes) {
    Rgb image(5, 3);
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < 3; y++)
            for (int x = 0; x < 5; x++) image.c[c].at(x, y) = float(int(c) * 50 + y * 10 + x) / 255;
    const auto bytes = pngBytes(image);
    const fs::path file = fs::temp_directory_path() / "aaresolve_html_test.png";
    writeText(file, std::string(bytes.begin(), bytes.end()));
    const Rgb back = readImage(file).rgb;
    for (size_t c = 0; c < 3; c++)
        for (int x = 0; x < 5; x++) EXPECT_NEAR(back.c[c].at(x, 2) * 255, float(int(c) * 50 + 20 + x), 1e-3);
    fs::remove(file);
}
nlohmann::json dataOf(const std::string& page) {
    const size_t begin = page.find("id=\"data\">") + 10, end = page.find("</script>", begin);
    return nlohmann::json::parse(page.substr(begin, end - begin));
}
TEST(Html, SelfContained) {
    const RunResults run = runOf({method("noaa", 1e-3, 1e-5), method("accum", 1e-4, 9e-5)}, 1e-7);
    PackedView view{{0, 0, 100, 100}, {1}, {}};
    for (const int source : {PackedPicture::kTruth, 0, 1})
        view.pictures.push_back({.frame = 1, .source = source, .bytes = {1, 2, 3}});
    const std::string page = reportHtml(run, {.views = {view}});
    EXPECT_EQ(page.find("{{"), std::string::npos);
    // Nothing is loaded from elsewhere.
    EXPECT_FALSE(std::regex_search(page.substr(0, page.find("id=\"data\"")), std::regex("(src|href)=\"?(https?:)?//")));
    // The shot's name cannot break out of the script.
    const auto data = dataOf(page);
    EXPECT_EQ(data["run"]["shot"]["name"], run.shot);
    EXPECT_EQ(data["order"], nlohmann::json({1, 0}));
    ASSERT_EQ(data["viewer"]["views"].size(), 1u);
    EXPECT_EQ(data["viewer"]["views"][0]["pictures"].size(), 3u);
    EXPECT_NE(page.find("id=\"picture-0-1-truth\">AQID</script>"), std::string::npos);
    EXPECT_NE(page.find("id=\"picture-0-1-1\">AQID</script>"), std::string::npos);
    EXPECT_NE(page.find("Chart.js"), std::string::npos);
}
TEST(Html, WithoutPictures) {
    const std::string page = reportHtml(runOf({method("noaa", 1e-3, 1e-5)}, 0), {});
    EXPECT_TRUE(dataOf(page)["viewer"]["views"].empty());
    EXPECT_EQ(page.find("id=\"picture-"), std::string::npos);
}
}  // namespace
}  // namespace aa
