// The scores as JSON and CSV.
#include <nlohmann/json.hpp>

#include "image/json_text.h"
#include "study/json_number.h"
#include "study/survey_scores.h"

namespace aa {
namespace {
using json = nlohmann::ordered_json;

json toJson(const Estimate& e) {
    json j = {{"value", e.value}, {"low95", nullptr}, {"high95", nullptr}};
    if (e.low) j["low95"] = *e.low, j["high95"] = *e.high;
    return j;
}
json toJson(const std::optional<Estimate>& e) { return e ? toJson(*e) : json(nullptr); }
json toJson(const std::vector<Agreement>& all) {
    json list = json::array();
    for (const Agreement& a : all)
        if (a.pairs > 0)
            list.push_back({{"figure", a.figure},
                            {"title", a.title},
                            {"of", a.ofShown ? "shown" : "run"},
                            {"pairs", a.pairs},
                            {"kendallTau", toJson(a.kendall)},
                            {"spearmanRho", toJson(a.spearman)}});
    return list;
}
json toJson(const ScoredSet& set, size_t participants) {
    const SurveyQuestion& q = *set.questions[0];
    json j = {{"questions", json::array()},
              {"kind", name(set.kind)},
              {"score", set.kind == QuestionKind::rank     ? "mean rank, 1 is best"
                        : set.kind == QuestionKind::rating ? "mean rating, 5 is best"
                        : set.isBradleyTerry()             ? "Bradley-Terry, more is better"
                                                           : "share of wins"},
              {"text", q.text},
              {"run", q.run},
              {"shot", q.shot},
              {"frames", q.frames},
              {"region", q.region},
              {"zoom", q.zoom},
              {"participants", participants},
              {"secondsMedian", set.secondsMedian},
              {"pictures", json::array()},
              {"pairs", json::array()}};
    for (const SurveyQuestion* question : set.questions) j["questions"].push_back(question->id);
    if (set.kendallW) j["kendallW"] = *set.kendallW;
    if (!set.meanByPlace.empty()) j["meanRankByPlace"] = set.meanByPlace;
    for (const size_t a : set.order) {
        const ScoredPicture& p = set.pictures[a];
        json picture = {{"method", p.picture->method}, {"code", p.picture->code}, {"score", toJson(p.score)}};
        if (set.kind == QuestionKind::pair) {
            picture["won"] = p.counts[0], picture["asked"] = p.counts[1];
            picture["winShare"] = toJson(p.best);
        } else {
            picture["counts"] = p.counts;
            for (const size_t count : p.counts) picture["shares"].push_back(double(count) / double(participants));
            if (set.kind == QuestionKind::rank) picture["firstShare"] = toJson(p.best);
        }
        picture["toNextBetter"] = toJson(p.toNext);
        if (p.toNext) picture["resolved"] = p.resolved;
        picture["shown"] = aa::toJson(p.picture->shown), picture["run"] = aa::toJson(p.picture->run);
        j["pictures"].push_back(std::move(picture));
    }
    for (const ScoredPair& pair : set.pairs)
        j["pairs"].push_back({{"first", set.pictures[pair.first].picture->method},
                              {"second", set.pictures[pair.second].picture->method},
                              {"firstWins", toJson(pair.firstWins)}});
    j["agreement"] = toJson(set.agreements);
    return j;
}
std::string field(double v) { return json(v).dump(); }
std::string field(const std::optional<double>& v) { return v ? field(*v) : ""; }
}  // namespace

std::string toJsonText(const SurveyScores& scores) {
    json j = {{"format", "aaresolve-survey-scores"},
              {"version", 1},
              {"survey", scores.key->survey},
              {"title", scores.key->title},
              {"participants", scores.participants},
              {"notes", scores.notes},
              {"sets", json::array()}};
    for (const ScoredSet& set : scores.sets) j["sets"].push_back(toJson(set, scores.participants));
    j["agreement"] = toJson(scores.pooled);
    return jsonText(j) + "\n";
}

std::string toCsvText(const SurveyScores& scores) {
    std::string text =
        "questions,kind,shot,method,participants,score,low95,high95,toNextBetter,resolved,share1,share2,share3,share4,"
        "share5,won,asked,shownPsnr,runPsnr\n";
    for (const ScoredSet& set : scores.sets)
        for (const size_t a : set.order) {
            const ScoredPicture& p = set.pictures[a];
            std::string questions;
            for (const SurveyQuestion* q : set.questions) questions += (questions.empty() ? "" : " ") + q->id;
            text += questions + "," + name(set.kind) + ",\"" + set.questions[0]->shot + "\",\"" + p.picture->method +
                    "\"," + std::to_string(scores.participants) + "," + field(p.score.value) + "," +
                    field(p.score.low) + "," + field(p.score.high) + ",";
            if (p.toNext) text += field(p.toNext->value) + "," + (p.resolved ? "yes" : "no");
            if (!p.toNext) text += ",";
            constexpr size_t kShares = 5;
            for (size_t r = 0; r < kShares; r++) {
                text += ",";
                if (set.kind != QuestionKind::pair && r < p.counts.size())
                    text += field(double(p.counts[r]) / double(scores.participants));
            }
            if (set.kind == QuestionKind::pair)
                text += "," + std::to_string(p.counts[0]) + "," + std::to_string(p.counts[1]);
            else
                text += ",,";
            for (const Figures* figures : {&p.picture->shown, &p.picture->run}) {
                const auto psnr = figures->find("psnr");
                const json number = psnr == figures->end() ? json("") : jsonNumber(psnr->second);
                text += "," + (number.is_string() ? number.get<std::string>() : number.dump());
            }
            text += "\n";
        }
    return text;
}

}  // namespace aa
