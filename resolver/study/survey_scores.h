// What the answers of a survey say: the score of [Stejmar n.d., eq 4.5] and its kin, with intervals, and how far
// metrics agree with viewers.
//
// - rank: score = sum over ranks of rank * share = mean rank; 1 is best.
// - rating: the mean; 5 is best.
// - pair: the share of wins. Pair questions about the same part of the same frames make one set; of three pictures or
//   more it is scored by the model of [Bradley 1952], P(a beats b) = 1 / (1 + exp(s_b - s_a)), fitted as in [Hunter
//   2004] with half a win either way for every pair that was asked, so that who never lost stays finite; the scores of
//   a set sum to 0, more is better.
//
// Intervals are 95 %, by 2000 bootstraps over participants: one draw serves every score, difference and correlation.
// Shares of votes, and differences of two that add up to 1, have that of [Wilson 1927], which does not shrink to
// nothing where all agree. Below kFewestForIntervals participants none is given: a two-sided sign test reaches
// 5 % with six who all agree (2 / 2^6) and not with five.
#pragma once
#include <optional>

#include "study/survey.h"
#include "study/survey_statistics.h"

namespace aa {

inline constexpr size_t kFewestObservers = 15;  // [ITU 2019] asks for at least so many

struct ScoredPicture {
    const SurveyPicture* picture = nullptr;
    std::vector<size_t> counts{};  // rank, rating: how often 1, 2, ...; pair: wins, times asked
    Estimate score{};
    Estimate best{};  // rank: share of participants who put it first; pair: share of its comparisons won
    // Score less that of the next better picture of the set; absent of the best. Resolved: the interval excludes 0.
    std::optional<Estimate> toNext{};
    bool resolved = false;
};
// Of two pictures, over who preferred one. A rating that is equal is half a win either way.
struct ScoredPair {
    size_t first = 0, second = 0;  // into ScoredSet::pictures
    Estimate firstWins;
};
// Kendall's tau b and Spearman's rho between score and figure, +1 where both agree on what is better. Absent where one
// of both is the same for all pictures.
struct Agreement {
    std::string figure, title;
    bool ofShown = false;  // figure of what was shown; else of the whole run
    size_t pairs = 0;      // of pictures that tau counts
    std::optional<Estimate> kendall, spearman;
};
// What is scored together: a rank or rating question, or the pair questions about one part of one shot.
struct ScoredSet {
    QuestionKind kind = QuestionKind::rank;
    std::vector<const SurveyQuestion*> questions{};
    std::vector<ScoredPicture> pictures{};  // as in the key
    std::vector<size_t> order{};            // best first
    std::vector<ScoredPair> pairs{};
    std::optional<double> kendallW{};   // rank: concordance [Kendall 1939], 1 = all gave the same ranks
    std::vector<double> meanByPlace{};  // rank: mean rank by place on the screen, without a habit (n + 1) / 2 each
    double secondsMedian = 0;           // that participants took
    std::vector<Agreement> agreements{};
    bool lowIsBetter() const { return kind == QuestionKind::rank; }
    bool isBradleyTerry() const { return kind == QuestionKind::pair && pictures.size() > 2; }
    bool isShare() const { return kind == QuestionKind::pair && !isBradleyTerry(); }  // scores are shares of wins
};
struct SurveyScores {
    const SurveyKey* key = nullptr;  // outlives the scores
    size_t participants = 0;
    std::vector<ScoredSet> sets;
    // Over all sets: tau counts pairs of pictures within sets, rho correlates ranks within sets.
    std::vector<Agreement> pooled;
    std::vector<std::string> notes;  // what was counted once, and whether the participants are too few
};
SurveyScores scoreSurvey(const SurveyKey& key, const Answers& answers);

std::string toJsonText(const SurveyScores& scores);
std::string toCsvText(const SurveyScores& scores);  // one line per set and picture

}  // namespace aa
