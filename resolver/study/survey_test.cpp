#include "study/survey.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "image/error.h"
#include "image/io.h"
#include "study/survey_scores.h"

namespace aa {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;
using json = nlohmann::ordered_json;

SurveyQuestion question(const std::string& id, QuestionKind kind, const std::vector<std::string>& methods) {
    SurveyQuestion q;
    q.id = id, q.kind = kind, q.run = q.shot = "scene", q.frames = {16}, q.region = {0, 0, 64, 32};
    for (const auto& m : methods) q.pictures.push_back({"code-" + m, m, {}, {}});
    return q;
}
SurveyKey keyOf(std::vector<SurveyQuestion> questions) { return {"s1", "A survey", "1", std::move(questions)}; }
// A participant who gives these values, in the order of the key's pictures, on a screen in that order.
Participant participant(const std::string& id, const std::vector<std::vector<int>>& values) {
    Participant p{id + ".json", id, {}, {}};
    for (const auto& v : values) {
        std::vector<size_t> shown(v.size());
        std::iota(shown.begin(), shown.end(), 0);
        p.answers.push_back({v, shown, 10});
    }
    return p;
}
Answers answersOf(const std::vector<std::vector<int>>& oneQuestion) {
    Answers a;
    for (size_t i = 0; i < oneQuestion.size(); i++)
        a.participants.push_back(participant("p" + std::to_string(i), {oneQuestion[i]}));
    return a;
}

// ---- the published survey ----
struct Published {
    std::vector<std::string> methods;
    std::vector<std::vector<double>> shares;  // by method and rank, %
    std::vector<double> scores;
};
// [Stejmar n.d., tables 5.7-5.10, 5.13-5.15]: questions 1, 2, 3, 4, 7, 8, 9.
const std::vector<Published> kPublished = {
    {{"No AA", "GBAA", "FXAA", "FXAA CS", "T2MSAA"},
     {{3.03, 3.03, 6.06, 1.52, 86.36},
      {7.58, 6.06, 9.09, 75.76, 1.52},
      {51.52, 27.27, 16.67, 4.55, 0},
      {7.58, 46.97, 27.27, 12.12, 6.06},
      {30.30, 16.67, 40.91, 6.06, 6.06}},
     {4.65, 3.58, 1.74, 2.62, 2.41}},
    {{"T2MSAA", "ASAA", "2x", "4x", "8x"},
     {{4.55, 6.06, 42.42, 42.42, 4.55},
      {1.52, 1.52, 1.52, 3.03, 92.42},
      {0, 3.03, 46.97, 50.00, 0},
      {9.09, 81.82, 4.55, 4.55, 0},
      {84.85, 7.58, 4.55, 0, 3.03}},
     {3.36, 4.83, 3.47, 2.05, 1.29}},
    {{"8x", "No AA", "T2MSAA", "ASAA", "FXAA CS"},
     {{89.39, 9.09, 0, 0, 1.52},
      {1.52, 0, 0, 9.09, 89.39},
      {0, 16.67, 81.82, 1.52, 0},
      {0, 3.03, 0, 87.88, 9.09},
      {9.09, 71.21, 18.18, 1.52, 0}},
     {1.15, 4.85, 2.85, 4.03, 2.12}},
    {{"4x", "T2MSAA", "2x", "FXAA", "GBAA"},
     {{53.03, 34.85, 10.61, 0, 1.52},
      {6.06, 36.36, 56.06, 1.52, 0},
      {0, 0, 6.06, 65.15, 28.79},
      {24.24, 28.79, 24.24, 21.21, 1.52},
      {16.67, 0, 3.03, 12.12, 68.18}},
     {1.62, 2.53, 4.23, 2.47, 4.15}},
    {{"8x", "T2MSAA", "FXAA CS", "GBAA", "2x"},
     {{98.48, 0, 0, 0, 1.52},
      {0, 68.18, 22.73, 9.09, 0},
      {0, 24.24, 60.61, 6.06, 9.09},
      {0, 6.06, 9.09, 59.09, 25.76},
      {1.52, 1.52, 7.58, 25.76, 63.64}},
     {1.06, 2.41, 3.00, 4.05, 4.49}},
    {{"T2MSAA", "ASAA", "FXAA", "No AA", "4x"},
     {{7.58, 75.76, 9.09, 7.58, 0},
      {0, 1.52, 30.30, 56.06, 12.12},
      {4.55, 10.61, 53.03, 21.21, 10.61},
      {1.52, 1.52, 6.06, 15.15, 75.76},
      {86.36, 10.61, 1.52, 0, 1.52}},
     {2.17, 3.79, 3.23, 4.62, 1.20}},
    {{"FXAA", "No AA", "ASAA"}, {{19.70, 69.70, 10.61}, {0, 15.15, 84.85}, {80.30, 15.15, 4.55}}, {1.91, 2.85, 1.24}},
};
constexpr size_t kPublishedParticipants = 66;

// Rankings of single participants with the published shares: counts with equal sums of rows and columns are a sum of
// permutations (Birkhoff), any of which may be taken away first.
std::vector<std::vector<int>> rankingsOf(const Published& q) {
    const size_t n = q.methods.size();
    std::vector<std::vector<int>> counts(n, std::vector<int>(n)), rankings;
    for (size_t m = 0; m < n; m++)
        for (size_t r = 0; r < n; r++) counts[m][r] = int(std::lround(q.shares[m][r] / 100 * kPublishedParticipants));
    std::vector<int> ranks(n);
    while (rankings.size() < kPublishedParticipants) {
        std::iota(ranks.begin(), ranks.end(), 1);
        const auto fits = [&] {
            for (size_t m = 0; m < n; m++)
                if (counts[m][size_t(ranks[m]) - 1] == 0) return false;
            return true;
        };
        bool found = fits();
        while (!found && std::next_permutation(ranks.begin(), ranks.end())) found = fits();
        if (!found) break;
        for (size_t m = 0; m < n; m++) counts[m][size_t(ranks[m]) - 1]--;
        rankings.push_back(ranks);
    }
    return rankings;
}

TEST(SurveyScores, OfThePublishedShares) {
    for (const Published& q : kPublished) {
        const auto rankings = rankingsOf(q);
        ASSERT_EQ(rankings.size(), kPublishedParticipants) << q.methods[0];
        const SurveyKey key = keyOf({question("q1", QuestionKind::rank, q.methods)});
        const SurveyScores scores = scoreSurvey(key, answersOf(rankings));
        ASSERT_EQ(scores.sets.size(), 1u);
        for (size_t m = 0; m < q.methods.size(); m++) {
            const ScoredPicture& p = scores.sets[0].pictures[m];
            // Printed with two decimals, of shares that are rounded to 0.005 %: 0.005 + (1 + 2 + 3 + 4 + 5) * 0.00005.
            EXPECT_NEAR(p.score.value, q.scores[m], 0.00575) << q.methods[m];
            for (size_t r = 0; r < p.counts.size(); r++)
                EXPECT_NEAR(100 * double(p.counts[r]) / kPublishedParticipants, q.shares[m][r], 0.0051);
            ASSERT_TRUE(p.score.low);
            EXPECT_LE(*p.score.low, p.score.value);
            EXPECT_GE(*p.score.high, p.score.value);
        }
        EXPECT_TRUE(scores.notes.empty());
    }
}
// The thesis finds that its MSE and its viewers do not agree in scene 1 [Stejmar n.d., 6.1]: table 5.1 beside
// question 1.
TEST(SurveyScores, AgreementOfThePublishedFirstQuestion) {
    const Published& q = kPublished[0];
    auto asked = question("q1", QuestionKind::rank, q.methods);
    const double mse[] = {0.5796, 0.4204, 1.8214, 1.6349, 0.3212};
    for (size_t m = 0; m < q.methods.size(); m++) asked.pictures[m].run["fmagMse"] = mse[m];
    const SurveyKey key = keyOf({asked});
    const SurveyScores scores = scoreSurvey(key, answersOf(rankingsOf(q)));
    const Agreement& a = scores.sets[0].agreements.at(0);
    // Viewers: FXAA, T2MSAA, FXAA CS, GBAA, No AA; MSE: T2MSAA, GBAA, No AA, FXAA CS, FXAA. Four pairs of ten agree.
    EXPECT_NEAR(a.kendall->value, (4.0 - 6) / 10, 1e-12);
    // Places differ by 4, -1, 1, -2, -2: rho = 1 - 6 * 26 / 120.
    EXPECT_NEAR(a.spearman->value, -0.3, 1e-12);
    EXPECT_LT(*a.kendall->low, 0);
    EXPECT_LT(*a.kendall->high, 0.01);
}
TEST(SurveyScores, OfThePublishedVotes) {  // questions 5 and 6: 65 of 66 and 63 of 66 for T2MSAA
    const SurveyKey key = keyOf({question("q5", QuestionKind::pair, {"T2MSAA", "2x"})});
    std::vector<std::vector<int>> votes(65, {1, 0});
    votes.push_back({0, 1});
    const SurveyScores scores = scoreSurvey(key, answersOf(votes));
    const ScoredPicture& p = scores.sets[0].pictures[0];
    EXPECT_EQ(p.counts, (std::vector<size_t>{65, 66}));
    EXPECT_NEAR(100 * p.best.value, 98.48, 0.005);
    // Wilson by hand: z^2 / n = 0.058204; middle (0.984848 + 0.029102) / 1.058204 = 0.958180, half
    // 1.959964 / 1.058204 * sqrt(0.984848 * 0.015152 / 66 + 0.058204 / 264) = 0.039140.
    EXPECT_NEAR(*p.best.low, 0.91904, 5e-5);
    EXPECT_NEAR(*p.best.high, 0.99732, 5e-5);
    EXPECT_FALSE(scores.sets[0].isBradleyTerry());
    EXPECT_NEAR(p.score.value, 65.0 / 66, 1e-12);
    EXPECT_NEAR(*p.score.low, 0.91904, 5e-5);
    EXPECT_NEAR(*p.score.high, 0.99732, 5e-5);
    const ScoredPicture& next = scores.sets[0].pictures[1];
    EXPECT_NEAR(*next.toNext->low, 1 - 2 * 0.99732, 1e-4);
    EXPECT_NEAR(*next.toNext->high, 1 - 2 * 0.91904, 1e-4);
    EXPECT_TRUE(next.resolved);
}
TEST(SurveyScores, AShareOfVotesHasOneIntervalAndItIsWilsons) {
    const SurveyKey key = keyOf({question("q1", QuestionKind::pair, {"a", "b"})});
    std::vector<std::vector<int>> votes(6, {1, 0});
    votes.insert(votes.end(), 2, {0, 1});
    const SurveyScores scores = scoreSurvey(key, answersOf(votes));
    const ScoredPicture &a = scores.sets[0].pictures[0], &b = scores.sets[0].pictures[1];
    EXPECT_NEAR(*a.score.low, 0.40927, 5e-5);  // six of eight
    EXPECT_NEAR(*a.score.high, 0.92852, 5e-5);
    EXPECT_EQ(*a.score.low, *a.best.low);
    EXPECT_EQ(*b.score.low, *b.best.low);
    EXPECT_DOUBLE_EQ(*b.toNext->high, 2 * *b.best.high - 1);
    EXPECT_FALSE(b.resolved) << "0.5 lies within";
    // All agree: no interval without width, and six are told apart, as the sign test does.
    const SurveyScores all = scoreSurvey(key, answersOf(std::vector<std::vector<int>>(6, {1, 0})));
    EXPECT_LT(*all.sets[0].pictures[0].score.low, 0.7);
    EXPECT_TRUE(all.sets[0].pictures[1].resolved);
}

// ---- by hand ----
TEST(SurveyScores, RanksByHand) {
    // Four participants: b always first, a and c change places.
    const SurveyKey key = keyOf({question("q1", QuestionKind::rank, {"a", "b", "c"})});
    const SurveyScores scores = scoreSurvey(key, answersOf({{2, 1, 3}, {2, 1, 3}, {2, 1, 3}, {3, 1, 2}}));
    const ScoredSet& set = scores.sets[0];
    EXPECT_DOUBLE_EQ(set.pictures[0].score.value, 2.25);
    EXPECT_DOUBLE_EQ(set.pictures[1].score.value, 1);
    EXPECT_DOUBLE_EQ(set.pictures[2].score.value, 2.75);
    EXPECT_EQ(set.order, (std::vector<size_t>{1, 0, 2}));
    EXPECT_DOUBLE_EQ(set.pictures[2].toNext->value, 0.5);
    // W = 12 S / (m^2 (n^3 - n)), S = (9 - 8)^2 + (4 - 8)^2 + (11 - 8)^2 = 26: 312 / 384.
    EXPECT_DOUBLE_EQ(*set.kendallW, 0.8125);
    EXPECT_EQ(set.meanByPlace, (std::vector<double>{2.25, 1, 2.75}));
    ASSERT_EQ(set.pairs.size(), 3u);
    EXPECT_DOUBLE_EQ(set.pairs[1].firstWins.value, 0.75);  // a before c
    // Four are too few for any interval.
    EXPECT_FALSE(set.pictures[0].score.low);
    EXPECT_FALSE(set.pictures[0].toNext->low);
    EXPECT_FALSE(set.pairs[1].firstWins.low);
    EXPECT_FALSE(set.pictures[0].resolved);
    ASSERT_EQ(scores.notes.size(), 1u);
    EXPECT_THAT(scores.notes[0], HasSubstr("too few: 4 participants; below 6"));
}
TEST(SurveyScores, FewParticipantsAreSaidUpToFifteen) {
    const SurveyKey key = keyOf({question("q1", QuestionKind::rank, {"a", "b"})});
    const auto notes = [&](size_t n) {
        return scoreSurvey(key, answersOf(std::vector<std::vector<int>>(n, {1, 2}))).notes;
    };
    EXPECT_THAT(notes(5).at(0), HasSubstr("too few: 5"));
    EXPECT_THAT(notes(6).at(0), HasSubstr("few: 6 participants; ITU-R BT.500 asks for at least 15"));
    EXPECT_THAT(notes(14).at(0), HasSubstr("few: 14"));
    EXPECT_TRUE(notes(15).empty());
    EXPECT_TRUE(scoreSurvey(key, answersOf(std::vector<std::vector<int>>(6, {1, 2}))).sets[0].pictures[1].resolved);
}
TEST(SurveyScores, RatingsByHand) {
    const SurveyKey key = keyOf({question("q1", QuestionKind::rating, {"a", "b"})});
    const SurveyScores scores = scoreSurvey(key, answersOf({{5, 3}, {4, 4}, {3, 3}, {5, 1}, {4, 2}, {3, 2}}));
    const ScoredSet& set = scores.sets[0];
    EXPECT_DOUBLE_EQ(set.pictures[0].score.value, 4);
    EXPECT_DOUBLE_EQ(set.pictures[1].score.value, 2.5);
    EXPECT_EQ(set.pictures[0].counts, (std::vector<size_t>{0, 0, 2, 2, 2}));
    EXPECT_DOUBLE_EQ(set.pairs[0].firstWins.value, 5.0 / 6);  // four of six, and two halves
    // The standard error of the mean of a is 0.333: a bootstrap interval of about 4 +- 0.65.
    EXPECT_NEAR(*set.pictures[0].score.low, 3.4, 0.11);
    EXPECT_NEAR(*set.pictures[0].score.high, 4.6, 0.11);
    EXPECT_TRUE(set.pictures[1].resolved);
}
TEST(SurveyScores, BradleyTerryByHand) {
    // Two: the odds with half a win either way, 3.5 : 1.5; scores are about their mean.
    const auto two = bradleyTerry({{0, 3}, {1, 0}});
    EXPECT_NEAR(two[0] - two[1], std::log(3.5 / 1.5), 1e-6);
    EXPECT_NEAR(two[0] + two[1], 0, 1e-9);
    // Three whose odds are 4 : 2 : 1, with as many votes as the model expects less the half of each side.
    const auto expected = [](double p, double q) { return 30 * p / (p + q) - 0.5; };
    const auto three = bradleyTerry({{0, expected(4, 2), expected(4, 1)},
                                     {expected(2, 4), 0, expected(2, 1)},
                                     {expected(1, 4), expected(1, 2), 0}});
    EXPECT_NEAR(three[0] - three[1], std::log(2), 1e-6);
    EXPECT_NEAR(three[1] - three[2], std::log(2), 1e-6);
}
TEST(SurveyScores, PairsOfOnePartAreOneSet) {
    auto other = question("q4", QuestionKind::pair, {"a", "b"});
    other.frames = {17};
    const SurveyKey key =
        keyOf({question("q1", QuestionKind::pair, {"a", "b"}), question("q2", QuestionKind::pair, {"c", "b"}),
               question("q3", QuestionKind::pair, {"a", "c"}), other});
    Answers answers;
    for (int i = 0; i < 8; i++)
        answers.participants.push_back(participant("p" + std::to_string(i), {{1, 0}, {i < 6, i >= 6}, {1, 0}, {0, 1}}));
    const SurveyScores scores = scoreSurvey(key, answers);
    ASSERT_EQ(scores.sets.size(), 2u);
    const ScoredSet& set = scores.sets[0];
    EXPECT_TRUE(set.isBradleyTerry());
    EXPECT_EQ(set.order, (std::vector<size_t>{0, 2, 1}));  // a, c, b; pictures as met: a, b, c
    EXPECT_EQ(set.pictures[0].counts, (std::vector<size_t>{16, 16}));
    EXPECT_EQ(set.pictures[2].counts, (std::vector<size_t>{6, 16}));
    EXPECT_NEAR(set.pictures[0].score.value + set.pictures[1].score.value + set.pictures[2].score.value, 0, 1e-9);
    EXPECT_TRUE(std::isfinite(set.pictures[0].score.value));  // it never lost
    EXPECT_EQ(scores.sets[1].order, (std::vector<size_t>{1, 0}));
}

// ---- beside the metrics ----
TEST(SurveyScores, AgreementByHand) {
    // Viewers: a, b, c, d. PSNR: a, c, b, d (one pair of six discordant): tau 4/6, rho 1 - 6 * 2 / (4 * 15) = 0.8.
    auto q1 = question("q1", QuestionKind::rank, {"a", "b", "c", "d"});
    const double psnr[] = {40, 30, 35, 20};
    for (size_t i = 0; i < 4; i++) q1.pictures[i].run["psnr"] = psnr[i], q1.pictures[i].run["flip"] = double(i);
    // A pair in which both figures are wrong.
    auto q2 = question("q2", QuestionKind::pair, {"a", "d"});
    q2.pictures[0].run = {{"psnr", 40}, {"flip", 0}}, q2.pictures[1].run = {{"psnr", 20}, {"flip", 3}};
    const SurveyKey key = keyOf({q1, q2});
    Answers answers;
    for (int i = 0; i < 8; i++)
        answers.participants.push_back(participant("p" + std::to_string(i), {{1, 2, 3, 4}, {0, 1}}));
    const SurveyScores scores = scoreSurvey(key, answers);
    const auto of = [](const std::vector<Agreement>& all, const std::string& figure) {
        return *std::find_if(all.begin(), all.end(), [&](const Agreement& a) { return a.figure == figure; });
    };
    const Agreement psnr1 = of(scores.sets[0].agreements, "psnr"), flip1 = of(scores.sets[0].agreements, "flip");
    EXPECT_NEAR(psnr1.kendall->value, 4.0 / 6, 1e-12);
    EXPECT_NEAR(psnr1.spearman->value, 0.8, 1e-12);
    EXPECT_EQ(psnr1.pairs, 6u);
    EXPECT_DOUBLE_EQ(flip1.kendall->value, 1);  // less is better
    EXPECT_DOUBLE_EQ(of(scores.sets[1].agreements, "psnr").kendall->value, -1);
    // Pooled: (4 - 1) / 7 pairs; rho (4 - 0.5) / (5 + 0.5).
    const Agreement all = of(scores.pooled, "psnr");
    EXPECT_NEAR(all.kendall->value, 3.0 / 7, 1e-12);
    EXPECT_NEAR(all.spearman->value, 3.5 / 5.5, 1e-12);
    EXPECT_NEAR(*all.kendall->low, 3.0 / 7, 1e-12);  // all participants agree
}
TEST(SurveyScores, AgreementHasAnInterval) {
    auto q = question("q1", QuestionKind::rank, {"a", "b", "c"});
    for (size_t i = 0; i < 3; i++) q.pictures[i].shown["psnr"] = 30 - double(i);
    const SurveyKey key = keyOf({q});
    std::vector<std::vector<int>> ranks(11, {1, 2, 3});
    for (int i = 0; i < 9; i++) ranks.push_back({2, 1, 3});
    const SurveyScores scores = scoreSurvey(key, answersOf(ranks));
    const Agreement& a = scores.sets[0].agreements[0];
    EXPECT_TRUE(a.ofShown);
    EXPECT_NEAR(a.kendall->value, 1, 1e-12);
    EXPECT_NEAR(*a.kendall->low, 1.0 / 3, 1e-12);  // a and b may change places
    EXPECT_FALSE(scores.sets[0].pictures[1].resolved);
    EXPECT_TRUE(scores.sets[0].pictures[2].resolved);
    EXPECT_EQ(toJsonText(scores), toJsonText(scoreSurvey(key, answersOf(ranks))));  // a fixed seed
}

// ---- files ----
class SurveyFiles : public testing::Test {
  protected:
    SurveyFiles() {
        fs::create_directories(folder_);
        key_ = keyOf({question("q1", QuestionKind::rank, {"a", "b"}), question("q2", QuestionKind::pair, {"a", "b"}),
                      question("q3", QuestionKind::rating, {"a"})});
        good_ = json::parse(R"({"format": "aaresolve-survey-answers", "version": 1, "survey": "s1",
            "participant": "p", "seed": 1, "answers": [
            {"question": "q3", "shown": ["code-a"], "ratings": {"code-a": 4}, "seconds": 3.5},
            {"question": "q1", "shown": ["code-b", "code-a"], "ranks": {"code-b": 1, "code-a": 2}, "seconds": 9},
            {"question": "q2", "shown": ["code-b", "code-a"], "better": "code-a", "seconds": 5}]})");
    }
    ~SurveyFiles() override { fs::remove_all(folder_); }
    std::string write(const std::string& name, const std::string& text) {
        writeText(folder_ / name, text);
        return (folder_ / name).string();
    }
    // What is said of the answers after a change.
    std::string said(const std::function<void(json&)>& change) {
        json j = good_;
        change(j);
        return saidOf(j.dump());
    }
    std::string saidOf(const std::string& text) {
        try {
            readAnswers({write("answers.json", text)}, key_);
        } catch (const InputError& e) {
            return e.what();
        }
        return "accepted";
    }
    fs::path folder_ = fs::path(testing::TempDir()) /
                       (std::string("survey_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    SurveyKey key_;
    json good_;
};

TEST_F(SurveyFiles, AnswersAreRead) {
    const Participant p = readParticipant(write("a.json", good_.dump()), key_);
    EXPECT_EQ(p.id, "p");
    EXPECT_EQ(p.answers[0].values, (std::vector<int>{2, 1}));
    EXPECT_EQ(p.answers[0].shown, (std::vector<size_t>{1, 0}));
    EXPECT_EQ(p.answers[1].values, (std::vector<int>{1, 0}));
    EXPECT_EQ(p.answers[2].values, (std::vector<int>{4}));
    EXPECT_DOUBLE_EQ(p.answers[2].seconds, 3.5);
}
TEST_F(SurveyFiles, BadAnswersAreNamed) {
    const std::string file = (folder_ / "answers.json").string();
    EXPECT_EQ(said([](json&) {}), "accepted");
    EXPECT_EQ(
        said([](json& j) { j["survey"] = "s2"; }),
        file + ": survey: expected \"s1\" as in the key, for these answers belong to another survey, found \"s2\"");
    EXPECT_EQ(said([](json& j) { j["answers"][0]["question"] = "q9"; }),
              file + ": answers[0].question: expected a question of the survey, q1 to q3, found \"q9\"");
    EXPECT_EQ(said([](json& j) { j["answers"].erase(2); }),
              file + ": answers: expected an answer to every question, found none to q2");
    EXPECT_EQ(said([](json& j) { j["answers"].push_back(j["answers"][0]); }),
              file + ": answers[3].question: expected each question once, found a second answer to q3");
    EXPECT_EQ(said([](json& j) { j["answers"][1]["ranks"].erase("code-a"); }),
              file + ": answers[1].ranks: expected a rank of every picture, found none of \"code-a\"");
    EXPECT_EQ(said([](json& j) { j["answers"][1]["ranks"]["code-a"] = 1; }),
              file + ": answers[1].ranks: expected every rank from 1 to 2 once, found rank 1 2 times");
    EXPECT_EQ(said([](json& j) { j["answers"][1]["ranks"]["code-a"] = 3; }),
              file + ": answers[1].ranks.code-a: expected a whole number from 1 to 2, found 3");
    EXPECT_EQ(said([](json& j) { j["answers"][1]["ranks"]["code-x"] = 1; }),
              file + ": answers[1].ranks: expected pictures of question q1 alone, found \"code-x\"");
    EXPECT_EQ(said([](json& j) { j["answers"][2]["better"] = nullptr; }),
              file + ": answers[2].better: expected a text, found null");
    EXPECT_EQ(said([](json& j) { j["answers"][0]["ratings"]["code-a"] = 6; }),
              file + ": answers[0].ratings.code-a: expected a whole number from 1 to 5, found 6");
    EXPECT_EQ(said([](json& j) {
                  j["answers"][1]["shown"] = {"code-a", "code-a"};
              }),
              file + ": answers[1].shown: expected every picture of question q1 once, found [\"code-a\",\"code-a\"]");
    EXPECT_EQ(said([](json& j) { j.erase("participant"); }), file + ": expected a member \"participant\", found none");
    EXPECT_THAT(said([](json& j) { j["format"] = "aaresolve-results"; }), HasSubstr("format: expected"));
    EXPECT_EQ(saidOf(good_.dump().substr(0, 100)),
              file + ": not valid JSON at line 1, column 101; expected answers that the survey's page saved");
    EXPECT_THAT(saidOf("[]"), HasSubstr("expected an object with \"format\", found []"));
}
TEST_F(SurveyFiles, AParticipantCountsOnce) {
    const std::string a = write("a.json", good_.dump()), b = write("b.json", good_.dump());
    const Answers all = readAnswers({a, b, a}, key_);
    EXPECT_EQ(all.participants.size(), 1u);
    ASSERT_EQ(all.notes.size(), 2u);
    EXPECT_EQ(all.notes[0], b + ": the same answers as " + a + ", counted once");
    good_["answers"][2]["better"] = "code-b";
    const std::string c = write("c.json", good_.dump());
    try {
        readAnswers({a, c}, key_);
        FAIL();
    } catch (const InputError& e) {
        EXPECT_EQ(std::string(e.what()), c + ": participant: expected the answers of " + a +
                                             ", which are of the same participant (p), found others to q2; keep one "
                                             "of the two files");
    }
}
TEST_F(SurveyFiles, TheKeyIsReadAsWritten) {
    key_.questions[0].pictures[0].shown["psnr"] = INFINITY;
    key_.questions[0].framesPerSecond = 24;
    const std::string text = toJsonText(key_), file = write("survey.key.json", text);
    EXPECT_EQ(toJsonText(readSurveyKey(file)), text);
    EXPECT_EQ(toJsonText(readSurveyKey(folder_ / "survey.html")), text);  // of the page that it lies beside
    EXPECT_THROW(readSurveyKey(folder_ / "other.html"), InputError);
    EXPECT_THROW(readSurveyKey(write("answers.json", good_.dump())), InputError);
}

TEST(SurveyScores, AsCsv) {
    auto q = question("q1", QuestionKind::rank, {"a", "b"});
    q.pictures[0].run["psnr"] = 30, q.pictures[1].run["psnr"] = INFINITY;
    const SurveyKey key = keyOf({q, question("q2", QuestionKind::pair, {"a", "b"})});
    Answers answers;
    for (int i = 0; i < 4; i++)
        answers.participants.push_back(participant(std::to_string(i), {{1, 2}, {i > 0, i == 0}}));
    const std::string text = toCsvText(scoreSurvey(key, answers));
    EXPECT_THAT(text, HasSubstr("q1,rank,\"scene\",\"a\",4,1.0,,,,,1.0,0.0,,,,,,,30.0\n"));
    EXPECT_THAT(text, HasSubstr("q1,rank,\"scene\",\"b\",4,2.0,,,1.0,no,0.0,1.0,,,,,,,Inf\n"));
    EXPECT_THAT(text, HasSubstr("q2,pair,\"scene\",\"a\",4,0.75,,,,,,,,,,3,4,,\n"));
    // Every line has as many fields as the head.
    const std::string head = text.substr(0, text.find('\n'));
    for (size_t at = 0, end; (end = text.find('\n', at)) != std::string::npos; at = end + 1)
        EXPECT_EQ(std::count(text.begin() + long(at), text.begin() + long(end), ','),
                  std::count(head.begin(), head.end(), ','));
}
}  // namespace
}  // namespace aa
