#include "report/summary.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "report/format.h"
#include "report/page.h"
#include "report/web/web_files.h"
#include "study/json_number.h"

namespace aa {
namespace {
using json = nlohmann::ordered_json;

json intervalJson(const std::optional<std::pair<double, double>>& i) {
    return i ? json{jsonNumber(i->first), jsonNumber(i->second)} : json(nullptr);
}
json meanJson(const std::optional<MeanGain>& m) {
    if (!m) return nullptr;
    json j = {{"gain", jsonNumber(m->gainDb)},
              {"low", jsonNumber(m->low)},
              {"high", jsonNumber(m->high)},
              {"resolved", m->resolved}};
    if (m->why) j["why"] = nameOf(*m->why);
    return j;
}
json maybeJson(const std::optional<double>& v) { return v ? jsonNumber(*v) : json(nullptr); }

// Figures of one method in one run, by the names of the program's table and of the JSON of results.
json cellJson(const RunResults& run, const SummaryCell& cell, const std::vector<const Figure*>& figures) {
    const MethodResult& m = run.methods[cell.method];
    json j = {{"rank", cell.rank}, {"reference", run.isReference(m)}};
    if (cell.gain) j["gain"] = comparisonJson(*cell.gain);
    if (m.pooled)
        for (const Figure* f : figures)
            if (const auto v = m.pooled->mean.figure(f->name)) j[std::string(f->name)] = jsonNumber(*v);
    if (m.nsPerPixel > 0) j["nsPerPixel"] = m.nsPerPixel;
    if (m.temporal) {
        if (const auto flicker = run.isStatic ? m.temporal->flickerStatic : m.temporal->flickerMoving)
            j["flicker"] = jsonNumber(*flicker);
        if (m.temporal->ghostExcess) j["ghosts"] = jsonNumber(*m.temporal->ghostExcess);
    }
    return j;
}
json rowJson(const std::vector<NamedRun>& runs, const SummaryRow& row, const std::vector<const Figure*>& figures) {
    json j = {{"text", row.text},
              {"id", row.id},
              {"title", row.title},
              {"family", row.family},
              {"scenes", row.scenes},
              {"infinite", row.infinite},
              {"mean", meanJson(row.mean)},
              {"rank", maybeJson(row.meanRank)},
              {"least", jsonNumber(row.least)},
              {"most", jsonNumber(row.most)},
              {"ofSuch", intervalJson(row.ofSuch)},
              {"cells", json::array()}};
    for (size_t k = 0; k < runs.size(); k++)
        j["cells"].push_back(row.cells[k] ? cellJson(runs[k].results, *row.cells[k], figures) : json(nullptr));
    return j;
}
json againstJson(const RunAgainstRun& r) {
    json j = {{"before", r.before},           {"after", r.after},
              {"onlyBefore", r.onlyBefore},   {"onlyAfter", r.onlyAfter},
              {"differences", r.differences}, {"changes", json::array()}};
    for (const RunChange& c : r.changes)
        j["changes"].push_back({{"text", c.text},
                                {"psnrBefore", jsonNumber(c.psnrBefore)},
                                {"psnrAfter", jsonNumber(c.psnrAfter)},
                                {"comparison", comparisonJson(c.comparison)},
                                {"nsPerPixelBefore", c.nsPerPixelBefore},
                                {"nsPerPixelAfter", c.nsPerPixelAfter}});
    return j;
}
// The run's own report as seen from a page; empty where there is none.
std::string reportOf(const NamedRun& run, const std::filesystem::path& page) {
    const auto report = std::filesystem::path(run.folder) / "report.html";
    if (page.empty() || run.folder.empty() || !std::filesystem::is_regular_file(report)) return {};
    return std::filesystem::weakly_canonical(report)
        .lexically_relative(std::filesystem::weakly_canonical(page).parent_path())
        .generic_string();
}
}  // namespace

std::vector<std::string> summaryInWords(const std::vector<NamedRun>& runs, const Summary& summary,
                                        const std::vector<RunAgainstRun>& against) {
    std::vector<std::string> words;
    std::vector<const SummaryRow*> known;
    for (const SummaryRow& row : summary.rows)
        if (row.mean) known.push_back(&row);
    if (known.empty()) {
        words.push_back("No run has both ground truth and noaa, without which gains are unknown.");
    } else {
        const SummaryRow& best = *known[0];
        std::string s =
            best.text + " gains most over no anti-aliasing: " + signedDecibelNumber(best.mean->gainDb) + " dB";
        if (best.scenes > 1) s += " in the mean of " + std::to_string(best.scenes) + " scenes";
        words.push_back(s + " " + intervalInBrackets(best.mean->low, best.mean->high) + ".");
        std::string exact;
        for (const SummaryRow& row : summary.rows)
            if (row.infinite > 0) exact += (exact.empty() ? "" : ", ") + row.text;
        if (!exact.empty())
            words.push_back("Identical to the truth in a scene, where the gain has no number: " + exact + ".");
        std::string uneven;
        for (const SummaryRow* row : known)
            if (row->least < 0 && row->most > 0)
                uneven += (uneven.empty() ? "" : ", ") + row->text + " (" + signedDecibelNumber(row->least) + " to " +
                          signedDecibelNumber(row->most) + " dB)";
        if (!uneven.empty()) words.push_back("Better than nothing in one scene and worse in another: " + uneven + ".");
        std::string partly;
        for (const SummaryRow* row : known)
            if (row->scenes + row->infinite < best.scenes + best.infinite)
                partly += (partly.empty() ? "" : ", ") + row->text;
        if (!partly.empty())
            words.push_back("In fewer scenes than the others, so that their means do not compare: " + partly + ".");
    }
    for (const RunAgainstRun& r : against) {
        std::string better, worse;
        for (const RunChange& c : r.changes)
            if (c.comparison.resolved)
                (c.comparison.mseDifference < 0 ? better : worse) +=
                    " " + c.text + " (" + signedDecibelNumber(c.comparison.gainDb) + " dB)";
        words.push_back(runs[r.after].name + " against " + runs[r.before].name + ": " +
                        (better.empty() && worse.empty() ? "no change that is resolved."
                         : worse.empty()                 ? "nearer to the truth:" + better + "."
                         : better.empty()                ? "farther from the truth:" + worse + "."
                                          : "nearer to the truth:" + better + "; farther:" + worse + "."));
    }
    for (const std::string& d : summary.differences) words.push_back("The runs do not share all: " + d + ".");
    for (const NamedRun& run : runs)
        if (const std::string busy = busyInWords(run.results); !busy.empty()) words.push_back(run.name + ": " + busy);
    return words;
}

std::string summaryHtml(const std::vector<NamedRun>& runs, const std::filesystem::path& page) {
    const Summary summary = summarise(runs);
    const auto against = againstEachOther(runs);
    std::set<std::string_view> present;
    for (const NamedRun& run : runs)
        for (const Figure* f : figuresIn(run.results)) present.insert(f->name);
    std::vector<const Figure*> figures;
    for (const Metric& metric : metrics())
        for (const Figure& f : metric.figures)
            if (present.contains(f.name) && f.spreadOf.empty()) figures.push_back(&f);
    json data = {{"words", summaryInWords(runs, summary, against)},
                 {"runs", json::array()},
                 {"figures", json::array()},
                 {"rows", json::array()},
                 {"against", json::array()}};
    for (const Figure* f : figures) data["figures"].push_back(figureJson(*f));
    for (const NamedRun& run : runs) {
        int judged = 0;
        for (const auto& m : run.results.methods)
            if (m.pooled) judged = m.pooled->frames;
        data["runs"].push_back({{"name", run.name},
                                {"shot", run.results.shot},
                                {"line", runLine(run.results)},
                                {"protocol", inWords(run.results.protocol)},
                                {"program", run.results.programVersion},
                                {"frames", judged},
                                {"report", reportOf(run, page)}});
    }
    for (const SummaryRow& row : summary.rows) data["rows"].push_back(rowJson(runs, row, figures));
    for (const RunAgainstRun& r : against) data["against"].push_back(againstJson(r));
    return filled(web::summaryHtml, {{"head", pageHead("AA Resolve: several runs", {web::css})},
                                     {"data", forScript(data)},
                                     {"chart", web::chart},
                                     {"common", web::common},
                                     {"tables", web::tables},
                                     {"js", web::summaryJs}});
}

}  // namespace aa
