#include "study/survey_scores.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "metrics/metric.h"
#include "metrics/pcg32.h"
#include "study/survey_statistics.h"

namespace aa {
namespace {
constexpr size_t kResamples = 2000;

// The sets before any answer: which pictures, and where each stands in its questions.
std::vector<ScoredSet> setsOf(const SurveyKey& key) {
    std::vector<ScoredSet> sets;
    for (const SurveyQuestion& q : key.questions) {
        const auto joins = [&](const ScoredSet& s) {
            const SurveyQuestion& o = *s.questions[0];
            return q.kind == QuestionKind::pair && o.kind == q.kind && o.run == q.run && o.shot == q.shot &&
                   o.frames == q.frames && o.region == q.region && o.zoom == q.zoom;
        };
        auto set = std::find_if(sets.begin(), sets.end(), joins);
        if (set == sets.end()) set = sets.insert(set, ScoredSet{.kind = q.kind});
        set->questions.push_back(&q);
        for (const SurveyPicture& p : q.pictures)
            if (std::none_of(set->pictures.begin(), set->pictures.end(),
                             [&](const ScoredPicture& other) { return other.picture->code == p.code; }))
                set->pictures.push_back({.picture = &p});
    }
    return sets;
}
size_t placeOf(const ScoredSet& set, const SurveyPicture& p) {
    return size_t(std::find_if(set.pictures.begin(), set.pictures.end(),
                               [&](const ScoredPicture& s) { return s.picture->code == p.code; }) -
                  set.pictures.begin());
}

using Matrix = std::vector<std::vector<double>>;
Matrix square(size_t n) { return Matrix(n, std::vector<double>(n, 0)); }

// One participant's answers to a set, as scores are made from them.
struct Ballot {
    std::vector<double> values;  // rank, rating: by picture
    Matrix wins;                 // wins[a][b]: a was preferred to b
};
Ballot ballotOf(const ScoredSet& set, const SurveyKey& key, const Participant& who) {
    const size_t n = set.pictures.size();
    Ballot ballot{std::vector<double>(n, 0), square(n)};
    for (const SurveyQuestion* q : set.questions) {
        const SurveyAnswer& answer = who.answers[size_t(q - key.questions.data())];
        const double better = set.lowIsBetter() ? -1 : 1;
        for (size_t i = 0; i < q->pictures.size(); i++) {
            const size_t a = placeOf(set, q->pictures[i]);
            ballot.values[a] = answer.values[i];
            for (size_t k = 0; k < q->pictures.size(); k++)
                if (const double more = better * (answer.values[i] - answer.values[k]); i != k && more >= 0)
                    ballot.wins[a][placeOf(set, q->pictures[k])] += more > 0 ? 1 : 0.5;
        }
    }
    return ballot;
}
// Scores of the participants drawn, by picture.
std::vector<double> scoresOf(const ScoredSet& set, const std::vector<Ballot>& ballots,
                             const std::vector<size_t>& drawn) {
    const size_t n = set.pictures.size();
    std::vector<double> scores(n, 0);
    if (set.kind != QuestionKind::pair) {
        for (const size_t who : drawn)
            for (size_t a = 0; a < n; a++) scores[a] += ballots[who].values[a];
        for (double& s : scores) s /= double(drawn.size());
        return scores;
    }
    Matrix wins = square(n);
    for (const size_t who : drawn)
        for (size_t a = 0; a < n; a++)
            for (size_t b = 0; b < n; b++) wins[a][b] += ballots[who].wins[a][b];
    if (n > 2) return bradleyTerry(wins);
    const double of = wins[0][1] + wins[1][0];
    return {wins[0][1] / of, wins[1][0] / of};
}

// A figure that pictures carry: its value where more is better.
struct FigureOfPictures {
    std::string name, title;
    bool ofShown = false, higherIsBetter = false;
    std::optional<double> of(const SurveyPicture& p) const {
        const Figures& figures = ofShown ? p.shown : p.run;
        const auto v = figures.find(name);
        if (v == figures.end() || std::isnan(v->second)) return {};
        return higherIsBetter ? v->second : -v->second;
    }
};
// Figures over time, which the table of metrics of one frame does not hold.
struct FigureOverTime {
    const char *name, *title;
    bool higherIsBetter;
};
constexpr FigureOverTime kOverTime[] = {{"tPsnr", "tPSNR", true},
                                        {"flickerStatic", "flicker at rest", false},
                                        {"flickerMoving", "flicker in motion", false},
                                        {"ghostMse", "ghost MSE", false}};
std::vector<FigureOfPictures> figuresIn(const SurveyKey& key) {
    std::vector<FigureOfPictures> all;
    const auto add = [&](const std::string& name, const std::string& title, bool higher) {
        for (const bool ofShown : {true, false}) {
            const FigureOfPictures f{name, title, ofShown, higher};
            for (const auto& q : key.questions)
                if (std::any_of(q.pictures.begin(), q.pictures.end(), [&](auto& p) { return f.of(p); })) {
                    all.push_back(f);
                    break;
                }
        }
    };
    for (const Metric& m : metrics())
        for (const Figure& f : m.figures) add(std::string(f.name), std::string(f.title), f.higherIsBetter);
    for (const auto& f : kOverTime) add(f.name, f.title, f.higherIsBetter);
    return all;
}
// The set's scores where more is better, and a figure, of the pictures that have it.
void addTo(RankSums& sums, const ScoredSet& set, const std::vector<double>& scores, const FigureOfPictures& figure) {
    std::vector<double> x, y;
    for (size_t a = 0; a < set.pictures.size(); a++)
        if (const auto v = figure.of(*set.pictures[a].picture)) {
            x.push_back(set.lowIsBetter() ? -scores[a] : scores[a]);
            y.push_back(*v);
        }
    sums.add(x, y);
}

// A statistic over the resamples: the interval is between its 2.5th and 97.5th percentile. One that is undefined in
// more than a tenth of them has none.
class Resampled {
  public:
    void add(std::optional<double> v) {
        if (v) values_.push_back(*v);
    }
    void into(Estimate& e) {
        if (values_.size() * 10 < kResamples * 9) return;
        std::sort(values_.begin(), values_.end());
        const auto n = double(values_.size());
        e.low = values_[size_t(0.025 * n)];
        e.high = values_[size_t(0.975 * n) - 1];
    }

  private:
    std::vector<double> values_;
};

void countVotes(ScoredSet& set, const SurveyKey& key, const Answers& answers, const std::vector<Ballot>& ballots) {
    const size_t n = set.pictures.size(), most = set.kind == QuestionKind::rating ? size_t(kBestRating) : n;
    Matrix wins = square(n);
    for (const Ballot& b : ballots)
        for (size_t a = 0; a < n; a++)
            for (size_t k = 0; k < n; k++) wins[a][k] += b.wins[a][k];
    for (size_t a = 0; a < n; a++) {
        ScoredPicture& p = set.pictures[a];
        if (set.kind == QuestionKind::pair) {
            double won = 0, asked = 0;
            for (size_t k = 0; k < n; k++) won += wins[a][k], asked += wins[a][k] + wins[k][a];
            p.counts = {size_t(won), size_t(asked)};
            p.best = wilsonShare(won, size_t(asked));
        } else {
            p.counts.assign(most, 0);
            for (const Ballot& b : ballots) p.counts[size_t(b.values[a]) - 1]++;
            if (set.kind == QuestionKind::rank) p.best = wilsonShare(double(p.counts[0]), ballots.size());
        }
    }
    for (size_t a = 0; a < n; a++)
        for (size_t b = a + 1; b < n; b++)
            if (const double asked = wins[a][b] + wins[b][a]; asked > 0)
                set.pairs.push_back({a, b, wilsonShare(wins[a][b], size_t(asked))});
    std::vector<double> seconds;
    for (const auto& who : answers.participants) {
        double sum = 0;
        for (const SurveyQuestion* q : set.questions) sum += who.answers[size_t(q - key.questions.data())].seconds;
        seconds.push_back(sum);
    }
    std::sort(seconds.begin(), seconds.end());
    const size_t half = seconds.size() / 2;
    set.secondsMedian = seconds.size() % 2 ? seconds[half] : (seconds[half - 1] + seconds[half]) / 2;
}
// What only ranks have: concordance [Kendall 1939] and habits of place.
void judgeRanks(ScoredSet& set, const SurveyKey& key, const Answers& answers) {
    const SurveyQuestion& q = *set.questions[0];
    const double n = double(set.pictures.size()), m = double(answers.participants.size());
    set.meanByPlace.assign(set.pictures.size(), 0);
    for (const auto& who : answers.participants) {
        const SurveyAnswer& answer = who.answers[size_t(&q - key.questions.data())];
        for (size_t place = 0; place < answer.shown.size(); place++)
            set.meanByPlace[place] += answer.values[answer.shown[place]] / m;
    }
    if (m < 2) return;
    double squares = 0;
    for (const auto& p : set.pictures) squares += std::pow(m * p.score.value - m * (n + 1) / 2, 2);
    set.kendallW = 12 * squares / (m * m * (n * n * n - n));
}
// Of a share of wins, and of its difference from the other's: 2 share - 1.
void giveWilsons(ScoredPicture& p) {
    p.score = p.best;
    if (!p.toNext || !p.best.low) return;
    p.toNext->low = 2 * *p.best.low - 1, p.toNext->high = 2 * *p.best.high - 1;
}
void addIntervals(SurveyScores& scores, const std::vector<std::vector<Ballot>>& ballots,
                  const std::vector<FigureOfPictures>& figures) {
    Pcg32 random;
    std::vector<std::vector<Resampled>> score, next;
    std::vector<std::vector<std::array<Resampled, 2>>> agreement;  // by set and figure; the last: pooled
    for (const auto& set : scores.sets) {
        score.emplace_back(set.pictures.size()), next.emplace_back(set.pictures.size());
        agreement.emplace_back(figures.size());
    }
    agreement.emplace_back(figures.size());
    std::vector<size_t> drawn(scores.participants);
    for (size_t r = 0; r < kResamples; r++) {
        for (size_t& who : drawn) who = random.below(scores.participants);
        std::vector<RankSums> pooled(figures.size());
        for (size_t s = 0; s < scores.sets.size(); s++) {
            const ScoredSet& set = scores.sets[s];
            const auto values = scoresOf(set, ballots[s], drawn);
            for (size_t a = 0; a < values.size(); a++) score[s][a].add(values[a]);
            for (size_t k = 1; k < set.order.size(); k++)
                next[s][set.order[k]].add(values[set.order[k]] - values[set.order[k - 1]]);
            for (size_t f = 0; f < figures.size(); f++) {
                RankSums alone;
                addTo(alone, set, values, figures[f]);
                addTo(pooled[f], set, values, figures[f]);
                agreement[s][f][0].add(alone.kendall()), agreement[s][f][1].add(alone.spearman());
            }
        }
        for (size_t f = 0; f < figures.size(); f++)
            agreement.back()[f][0].add(pooled[f].kendall()), agreement.back()[f][1].add(pooled[f].spearman());
    }
    for (size_t s = 0; s < scores.sets.size(); s++)
        for (size_t a = 0; a < scores.sets[s].pictures.size(); a++) {
            ScoredPicture& p = scores.sets[s].pictures[a];
            if (scores.sets[s].isShare()) {
                giveWilsons(p);
            } else {
                score[s][a].into(p.score);
                if (p.toNext) next[s][a].into(*p.toNext);
            }
            p.resolved = p.toNext && p.toNext->low && (*p.toNext->low > 0 || *p.toNext->high < 0);
        }
    const auto give = [&](std::vector<Agreement>& to, std::vector<std::array<Resampled, 2>>& from) {
        for (size_t f = 0; f < figures.size(); f++) {
            if (to[f].kendall) from[f][0].into(*to[f].kendall);
            if (to[f].spearman) from[f][1].into(*to[f].spearman);
        }
    };
    for (size_t s = 0; s < scores.sets.size(); s++) give(scores.sets[s].agreements, agreement[s]);
    give(scores.pooled, agreement.back());
}
Agreement agreementOf(const FigureOfPictures& figure, const RankSums& sums) {
    Agreement a{figure.name, figure.title, figure.ofShown, sums.pairs, {}, {}};
    if (const auto tau = sums.kendall()) a.kendall = Estimate{*tau, {}, {}};
    if (const auto rho = sums.spearman()) a.spearman = Estimate{*rho, {}, {}};
    return a;
}
std::string tooFew(size_t participants) {
    const std::string number = std::to_string(participants) + " participant" + (participants == 1 ? "" : "s");
    if (participants < kFewestForIntervals)
        return "too few: " + number + "; below " + std::to_string(kFewestForIntervals) +
               " no two pictures can be told apart at 95 %, even if all agree (two-sided sign test), so no intervals "
               "are "
               "given";
    if (participants < kFewestObservers)
        return "few: " + number + "; ITU-R BT.500 asks for at least " + std::to_string(kFewestObservers) +
               " observers, and the bootstrap's intervals are too narrow for so few";
    return {};
}
}  // namespace

SurveyScores scoreSurvey(const SurveyKey& key, const Answers& answers) {
    SurveyScores scores;
    scores.key = &key, scores.participants = answers.participants.size(), scores.sets = setsOf(key);
    scores.notes = answers.notes;
    const std::string few = tooFew(scores.participants);
    if (!few.empty()) scores.notes.push_back(few);
    const auto figures = figuresIn(key);
    std::vector<size_t> all(scores.participants);
    std::iota(all.begin(), all.end(), 0);
    std::vector<std::vector<Ballot>> ballots;
    std::vector<RankSums> pooled(figures.size());
    for (ScoredSet& set : scores.sets) {
        auto& own = ballots.emplace_back();
        for (const auto& who : answers.participants) own.push_back(ballotOf(set, key, who));
        const auto values = scoresOf(set, own, all);
        for (size_t a = 0; a < values.size(); a++) set.pictures[a].score.value = values[a], set.order.push_back(a);
        std::stable_sort(set.order.begin(), set.order.end(), [&](size_t a, size_t b) {
            return set.lowIsBetter() ? values[a] < values[b] : values[a] > values[b];
        });
        for (size_t k = 1; k < set.order.size(); k++)
            set.pictures[set.order[k]].toNext = Estimate{values[set.order[k]] - values[set.order[k - 1]], {}, {}};
        countVotes(set, key, answers, own);
        if (set.kind == QuestionKind::rank) judgeRanks(set, key, answers);
        for (size_t f = 0; f < figures.size(); f++) {
            RankSums sums;
            addTo(sums, set, values, figures[f]);
            addTo(pooled[f], set, values, figures[f]);
            set.agreements.push_back(agreementOf(figures[f], sums));
        }
    }
    for (size_t f = 0; f < figures.size(); f++) scores.pooled.push_back(agreementOf(figures[f], pooled[f]));
    if (scores.participants >= kFewestForIntervals) addIntervals(scores, ballots, figures);
    return scores;
}

}  // namespace aa
