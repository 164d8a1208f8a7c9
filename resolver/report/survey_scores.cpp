#include "study/survey_scores.h"

#include <nlohmann/json.hpp>

#include "report/page.h"
#include "report/survey.h"
#include "report/web/web_files.h"

namespace aa {
namespace {
using json = nlohmann::ordered_json;

// The first frame of every picture of the survey's page, by code; empty where the page is of another survey.
json picturesOf(const std::string& page, const std::string& survey) {
    constexpr std::string_view kFrom = "id=\"data\">", kTo = "</script>";
    json pictures = json::object();
    const size_t from = page.find(kFrom);
    if (from == std::string::npos) return pictures;
    const size_t start = from + kFrom.size();
    const json data = json::parse(page.substr(start, page.find(kTo, start) - start), nullptr, false);
    const auto isOf = [&](const json& d) { return d.is_object() && d.contains("survey") && d["survey"] == survey; };
    if (!isOf(data) || !data.contains("images") || !data["images"].is_object()) return pictures;
    for (const auto& [code, frames] : data["images"].items())
        if (frames.is_array() && !frames.empty() && frames[0].is_string()) pictures[code] = frames[0];
    return pictures;
}
}  // namespace

std::string scoresHtml(const SurveyScores& scores, const std::string& surveyPage) {
    const json data = {{"scores", json::parse(toJsonText(scores))},
                       {"pictures", picturesOf(surveyPage, scores.key->survey)}};
    return filled(web::scoresHtml, {{"head", pageHead("Scores: " + scores.key->title, {web::css})},
                                    {"chart", web::chart},
                                    {"common", web::common},
                                    {"js", web::scoresJs},
                                    {"data", forScript(data)}});
}

}  // namespace aa
