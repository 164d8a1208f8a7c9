#include "report/summary.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

namespace aa {
namespace {
constexpr double kInf = std::numeric_limits<double>::infinity();

// A run whose methods have these mean squared errors; every tile of a method is off its mean by up to `scatter`.
RunResults runOf(const std::string& shot, std::vector<std::pair<std::string, double>> methods, double scatter = 0.05) {
    RunResults run;
    run.shot = shot, run.width = run.height = 32, run.programVersion = "1", run.isa = "x", run.precision = "fast";
    std::vector<TileErrors> errors;
    for (const auto& [text, mse] : methods) {
        MethodResult m;
        m.id = m.text = m.folder = text;
        FrameResult f;
        f.frame = 1, f.seconds = 1e-5;
        f.metrics = frameMetrics(SquaredError{mse, 0.2});
        f.metrics->others["ssimLuma"] = 0.9;
        m.frames = {f};
        run.methods.push_back(m);
        TileErrors e;
        e.columns = 4;
        e.values.assign(16, 192);
        for (size_t i = 0; i < 16; i++)
            e.sum.push_back(192 * mse * (1 + scatter * std::sin(double(i * i + 3 * run.methods.size()))));
        errors.push_back(e);
    }
    finish(run, errors);
    return run;
}
const SummaryRow& rowOf(const Summary& s, const std::string& text) {
    return *std::find_if(s.rows.begin(), s.rows.end(), [&](const auto& r) { return r.text == text; });
}

TEST(Summary, AveragesDifferencesInDecibels) {
    const auto runs = namedRuns({{"out/a", runOf("easy", {{"noaa", 1e-4}, {"fxaa311", 5e-5}, {"dear", 1e-5}})},
                                 {"out/b", runOf("hard", {{"noaa", 1e-2}, {"fxaa311", 1e-3}, {"late", 2e-2}})},
                                 {"out/c", runOf("exact", {{"noaa", 1e-3}, {"fxaa311", 0}, {"dear", 1e-3}})}});
    EXPECT_EQ(runs[1].name, "hard");
    const Summary s = summarise(runs);
    const SummaryRow& fxaa = rowOf(s, "fxaa311");
    // About 3.0 and 10 dB; the scene without error is counted apart, and no mean becomes infinite.
    EXPECT_EQ(fxaa.scenes, 2);
    EXPECT_EQ(fxaa.infinite, 1);
    EXPECT_NEAR(fxaa.mean->gainDb, (3.01 + 10) / 2, 0.3);
    EXPECT_DOUBLE_EQ(fxaa.mean->gainDb, (fxaa.cells[0]->gain->gainDb + fxaa.cells[1]->gain->gainDb) / 2);
    EXPECT_EQ(fxaa.cells[2]->gain->gainDb, kInf);
    EXPECT_NEAR(fxaa.least, 3.01, 0.3);
    EXPECT_NEAR(fxaa.most, 10, 0.3);
    EXPECT_EQ(fxaa.cells[0]->rank, 2);
    EXPECT_EQ(*fxaa.meanRank, (2 + 1 + 1) / 3.0);
    // The interval of a mean of two is narrower than the wider of its parts, and about it.
    ASSERT_TRUE(fxaa.mean);
    const auto half = [](const Comparison& c) { return (c.gainHigh - c.gainLow) / 2; };
    const double expected = std::hypot(half(*fxaa.cells[0]->gain), half(*fxaa.cells[1]->gain)) / 2;
    EXPECT_NEAR((fxaa.mean->high - fxaa.mean->low) / 2, expected, 0.05 * expected);
    EXPECT_FALSE(fxaa.ofSuch) << "two scenes say nothing of others";
    EXPECT_FALSE(rowOf(s, "noaa").mean);
    EXPECT_EQ(rowOf(s, "late").cells[0], std::nullopt);
    EXPECT_EQ(s.rows.front().text, "fxaa311") << "in all three scenes, while dear is in two";
    EXPECT_EQ(s.rows.back().text, "noaa");
    const auto words = summaryInWords(runs, s, {});
    EXPECT_NE(words[0].find("fxaa311 gains most over no anti-aliasing: +"), std::string::npos);
    EXPECT_EQ(words[1], "Identical to the truth in a scene, where the gain has no number: fxaa311.");
}
TEST(Summary, ScenesLikeTheseFromFourUp) {
    std::vector<std::pair<std::string, RunResults>> four;
    const double gains[] = {2, 3, 4, 7};
    for (const double g : gains)
        four.emplace_back("r",
                          runOf("scene" + std::to_string(g), {{"noaa", 1e-3}, {"m", 1e-3 * std::pow(10, -g / 10)}}, 0));
    const Summary s = summarise(namedRuns(four));
    const SummaryRow& m = rowOf(s, "m");
    EXPECT_NEAR(m.mean->gainDb, 4, 1e-9);
    ASSERT_TRUE(m.ofSuch);
    // t(3) = 3.182, standard deviation 2.1602
    EXPECT_NEAR(m.ofSuch->second - 4, 3.182 * 2.160247 / 2, 1e-4);
    EXPECT_NEAR(4 - m.ofSuch->first, 3.182 * 2.160247 / 2, 1e-4);
}
TEST(Summary, ASceneCountsOnceAndItsRunsAreHeldAgainstEachOther) {
    RunResults before = runOf("pipe", {{"noaa", 1e-3}, {"a", 5e-4}, {"b", 4e-4}, {"gone", 1e-4}}),
               after = runOf("pipe", {{"noaa", 1e-3}, {"a", 2.5e-4}, {"b", 4e-4}, {"new", 1e-4}});
    after.threads = 2;
    const auto runs =
        namedRuns({{"old/run", before}, {"new/run/", after}, {"x", runOf("other", {{"noaa", 1e-3}, {"a", 1e-3}})}});
    EXPECT_EQ(runs[0].name, "pipe (run)");
    EXPECT_EQ(runs[1].name, "pipe (run) 2");
    const Summary s = summarise(runs);
    EXPECT_EQ(rowOf(s, "a").scenes, 2);
    EXPECT_DOUBLE_EQ(rowOf(s, "a").mean->gainDb,
                     (rowOf(s, "a").cells[1]->gain->gainDb + rowOf(s, "a").cells[2]->gain->gainDb) / 2);
    EXPECT_FALSE(s.differences.empty());
    const auto against = againstEachOther(runs);
    ASSERT_EQ(against.size(), 1u);
    EXPECT_EQ(against[0].before, 0u);
    EXPECT_EQ(against[0].after, 1u);
    EXPECT_EQ(against[0].onlyBefore, std::vector<std::string>{"gone"});
    EXPECT_EQ(against[0].onlyAfter, std::vector<std::string>{"new"});
    EXPECT_EQ(against[0].differences, std::vector<std::string>{"threads: 1 against 2"});
    for (const RunChange& c : against[0].changes) {
        EXPECT_EQ(c.comparison.resolved, c.text == "a");
        if (c.text == "a")
            EXPECT_NEAR(c.comparison.gainDb, 3.01, 0.01);
        else
            EXPECT_EQ(c.comparison.why, Unresolved::equal) << c.text;
    }
    // Other frames are other pictures.
    after.methods[0].frames[0].frame = 2;
    EXPECT_TRUE(againstEachOther(namedRuns({{"a", before}, {"b", after}})).empty());
}
// The comparison of a method with noaa, as a run gives it.
void setGain(RunResults& run, const std::string& text, double gain, double low, double high) {
    const size_t method = *indexOf(run, text), noaa = *noaaOf(run);
    for (PairResult& p : run.pairs)
        if (p.first == noaa && p.second == method)
            p.comparison.gainDb = -gain, p.comparison.gainLow = -high, p.comparison.gainHigh = -low,
            p.comparison.resolved = low > 0 || high < 0, p.comparison.why = Unresolved::no;
}
TEST(Summary, AnIntervalWithOneEndIsShownAsInItsRun) {
    RunResults one = runOf("one", {{"noaa", 1e-3}, {"bad", 1e-2}}),
               other = runOf("other", {{"noaa", 1e-3}, {"bad", 2e-3}});
    setGain(one, "bad", -11.39, -kInf, -7.25);
    const SummaryRow alone = rowOf(summarise(namedRuns({{"a", one}})), "bad");
    EXPECT_EQ(alone.mean->high, -7.25);
    EXPECT_EQ(alone.mean->low, -kInf);
    EXPECT_TRUE(alone.mean->resolved);
    const auto runs = namedRuns({{"a", one}});
    EXPECT_NE(summaryInWords(runs, summarise(runs), {})[0].find("-11.39 dB (95 %: below -7.25)."), std::string::npos);
    EXPECT_NE(summaryHtml(runs).find(R"("mean":{"gain":-11.39,"low":"-Inf","high":-7.25,"resolved":true,"why":"no"})"),
              std::string::npos);
    setGain(other, "bad", -3, -4, -2);
    const SummaryRow both = rowOf(summarise(namedRuns({{"a", one}, {"b", other}})), "bad");
    EXPECT_EQ(both.mean->low, -kInf);
    EXPECT_NEAR(both.mean->high, (-11.39 - 3 + std::hypot(11.39 - 7.25, 1)) / 2, 1e-12);
    EXPECT_TRUE(both.mean->resolved);
    EXPECT_FALSE(both.mean->why);
    // Of one scene the run's word counts, not whether 0 lies between the ends.
    one.pairs[0].comparison.resolved = false, one.pairs[0].comparison.why = Unresolved::truthNoise;
    EXPECT_FALSE(rowOf(summarise(namedRuns({{"a", one}})), "bad").mean->resolved);
}
TEST(Summary, ALaterRunWithoutNoaaTakesNoGainAway) {
    const auto runs = namedRuns({{"a", runOf("pipe", {{"noaa", 1e-3}, {"best", 1e-4}, {"next", 3e-4}})},
                                 {"b", runOf("pipe", {{"best", 1e-4}, {"other", 2e-4}})}});
    const Summary s = summarise(runs);
    EXPECT_NEAR(rowOf(s, "best").mean->gainDb, 10, 0.1);
    EXPECT_EQ(rowOf(s, "best").scenes, 1);
    EXPECT_EQ(*rowOf(s, "best").meanRank, 1);
    EXPECT_EQ(*rowOf(s, "next").meanRank, 2);
    EXPECT_EQ(summaryInWords(runs, s, {})[0].find("best gains most"), 0u);
}
TEST(Summary, LinksToTheReportsThatAreThere) {
    namespace fs = std::filesystem;
    const fs::path folder = fs::temp_directory_path() / ("aaresolve_summary_" + std::to_string(::getpid()));
    fs::create_directories(folder / "runs/a");
    std::ofstream(folder / "runs/a/report.html") << "x";
    const auto runs = namedRuns({{(folder / "runs/a/").string(), runOf("first", {{"noaa", 1e-3}, {"m", 5e-4}})},
                                 {(folder / "runs/b").string(), runOf("second", {{"noaa", 1e-3}, {"m", 5e-4}})}});
    const std::string page = summaryHtml(runs, folder / "pages/summary.html");
    EXPECT_NE(page.find("\"report\":\"../runs/a/report.html\""), std::string::npos);
    EXPECT_NE(page.find("\"report\":\"\""), std::string::npos);
    fs::remove_all(folder);
}
TEST(Summary, OneSceneIsNoMean) {
    const auto runs = namedRuns(
        {{"a", runOf("pipe", {{"noaa", 1e-3}, {"m", 5e-4}})}, {"b", runOf("pipe", {{"noaa", 1e-3}, {"m", 5e-4}})}});
    const std::string words = summaryInWords(runs, summarise(runs), {})[0];
    EXPECT_NE(words.find("m gains most over no anti-aliasing: +3."), std::string::npos) << words;
    EXPECT_EQ(words.find("scene"), std::string::npos) << words;
}
TEST(Summary, ThePageHoldsNoScriptOfAName) {
    const auto runs = namedRuns({{"a", runOf("</script><b>", {{"noaa", 1e-3}, {"m", 5e-4}})},
                                 {"b", runOf("second", {{"noaa", 1e-3}, {"m", 5e-4}})}});
    const std::string page = summaryHtml(runs);
    EXPECT_EQ(page.find("</script><b>"), std::string::npos);
    EXPECT_NE(page.find("\\u003c/script>\\u003cb>"), std::string::npos);
    EXPECT_EQ(page.find("{{"), std::string::npos);
}
}  // namespace
}  // namespace aa
