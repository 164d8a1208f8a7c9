#include "study/summary.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "metrics/student.h"

namespace aa {
namespace {

bool sameScene(const RunResults& a, const RunResults& b) {
    return a.shot == b.shot && a.width == b.width && a.height == b.height;
}
std::set<int> judgedFrames(const RunResults& r) {
    std::set<int> frames;
    for (const auto& m : r.methods)
        for (const auto& f : m.frames)
            if (f.judged && f.metrics) frames.insert(f.frame);
    return frames;
}
// Which of two results, told by what differs.
std::vector<std::string> differencesOf(const RunResults& a, const RunResults& b) {
    std::vector<std::string> all;
    const auto compare = [&](const char* what, const std::string& x, const std::string& y) {
        if (x != y) all.push_back(std::string(what) + ": " + x + " against " + y);
    };
    compare("protocol", inWords(a.protocol), inWords(b.protocol));
    compare("program", a.programVersion, b.programVersion);
    compare("machine", a.machine, b.machine);
    compare("instruction set", a.isa, b.isa);
    compare("precision", a.precision, b.precision);
    compare("threads", std::to_string(a.threads), std::to_string(b.threads));
    return all;
}

// The mean of quantities with intervals of their own that need not be symmetric: deviations to either side add in
// squares [Zou 2008].
std::optional<MeanGain> meanOf(const std::vector<Comparison>& gains) {
    if (gains.empty()) return {};
    if (gains.size() == 1) {
        const Comparison& c = gains[0];
        return MeanGain{c.gainDb, c.gainLow, c.gainHigh, c.resolved, c.why};
    }
    double sum = 0, below = 0, above = 0;
    for (const Comparison& c : gains) {
        sum += c.gainDb;
        below += (c.gainDb - c.gainLow) * (c.gainDb - c.gainLow);
        above += (c.gainHigh - c.gainDb) * (c.gainHigh - c.gainDb);
    }
    const double n = double(gains.size());
    MeanGain mean{sum / n, (sum - std::sqrt(below)) / n, (sum + std::sqrt(above)) / n};
    mean.resolved = mean.low > 0 || mean.high < 0;
    return mean;
}
std::optional<std::pair<double, double>> overScenes(const std::vector<Comparison>& gains) {
    const size_t n = gains.size();
    if (n < 4) return {};
    double mean = 0, squares = 0;
    for (const Comparison& c : gains) mean += c.gainDb / double(n);
    for (const Comparison& c : gains) squares += (c.gainDb - mean) * (c.gainDb - mean);
    const double half = student975(n - 1) * std::sqrt(squares / double(n - 1) / double(n));
    return std::pair{mean - half, mean + half};
}
// Whether run k says something of a method, and no later run of its scene does: one without noaa knows no gains.
template <class Says>
bool isLastOfScene(const std::vector<NamedRun>& runs, const SummaryRow& row, size_t k, Says says) {
    if (!row.cells[k] || !says(*row.cells[k])) return false;
    for (size_t later = k + 1; later < runs.size(); later++)
        if (sameScene(runs[later].results, runs[k].results) && row.cells[later] && says(*row.cells[later]))
            return false;
    return true;
}
}  // namespace

std::vector<NamedRun> namedRuns(std::vector<std::pair<std::string, RunResults>> byFolder) {
    std::map<std::string, int> ofShot;
    for (const auto& [folder, r] : byFolder) ofShot[r.shot]++;
    std::vector<NamedRun> runs;
    for (auto& [folder, r] : byFolder) {
        std::filesystem::path path = std::filesystem::path(folder).lexically_normal();
        if (path.filename().empty()) path = path.parent_path();
        std::string name = r.shot;
        if (ofShot[name] > 1) name += " (" + path.filename().string() + ")";
        runs.push_back({std::move(name), std::move(r), folder});
    }
    // Folders of one name in different places.
    std::map<std::string, int> seen;
    for (NamedRun& run : runs)
        if (const int n = ++seen[run.name]; n > 1) run.name += " " + std::to_string(n);
    return runs;
}

Summary summarise(const std::vector<NamedRun>& runs) {
    Summary s;
    std::map<std::string, size_t> rowOf;
    for (size_t k = 0; k < runs.size(); k++) {
        const RunResults& r = runs[k].results;
        std::vector<size_t> ranked;
        for (size_t i = 0; i < r.methods.size(); i++)
            if (r.methods[i].pooled) ranked.push_back(i);
        std::stable_sort(ranked.begin(), ranked.end(), [&](size_t a, size_t b) {
            return r.methods[a].pooled->mean.mse < r.methods[b].pooled->mean.mse;
        });
        const auto noaa = noaaOf(r);
        for (size_t i = 0; i < r.methods.size(); i++) {
            const MethodResult& m = r.methods[i];
            const auto [at, isNew] = rowOf.emplace(m.text, s.rows.size());
            if (isNew) {
                s.rows.push_back({.text = m.text, .id = m.id, .title = m.title, .family = m.family});
                s.rows.back().cells.resize(runs.size());
            }
            SummaryCell cell{.method = i};
            for (size_t place = 0; place < ranked.size(); place++)
                if (ranked[place] == i) cell.rank = int(place) + 1;
            if (noaa && i != *noaa) cell.gain = compared(r, i, *noaa);
            s.rows[at->second].cells[k] = cell;
        }
    }
    for (SummaryRow& row : s.rows) {
        std::vector<Comparison> gains;
        double rank = 0;
        int ranks = 0;
        const auto hasRank = [](const SummaryCell& c) { return c.rank > 0; };
        const auto hasGain = [](const SummaryCell& c) { return c.gain.has_value(); };
        for (size_t k = 0; k < runs.size(); k++) {
            if (isLastOfScene(runs, row, k, hasRank)) rank += row.cells[k]->rank, ranks++;
            if (!isLastOfScene(runs, row, k, hasGain)) continue;
            if (std::isfinite(row.cells[k]->gain->gainDb))
                gains.push_back(*row.cells[k]->gain);
            else
                row.infinite++;
        }
        if (ranks) row.meanRank = rank / ranks;
        row.scenes = int(gains.size());
        if (gains.empty()) continue;
        row.least = row.most = gains[0].gainDb;
        for (const Comparison& c : gains)
            row.least = std::min(row.least, c.gainDb), row.most = std::max(row.most, c.gainDb);
        row.mean = meanOf(gains);
        row.ofSuch = overScenes(gains);
    }
    std::stable_sort(s.rows.begin(), s.rows.end(), [](const SummaryRow& a, const SummaryRow& b) {
        const bool known = a.mean.has_value();
        if (known != b.mean.has_value()) return known;
        const int scenesA = a.scenes + a.infinite, scenesB = b.scenes + b.infinite;
        if (scenesA != scenesB) return scenesA > scenesB;
        return known && a.mean->gainDb > b.mean->gainDb;
    });
    std::set<std::string> told;
    for (size_t k = 1; k < runs.size(); k++)
        for (const std::string& d : differencesOf(runs[0].results, runs[k].results))
            if (told.insert(d).second) s.differences.push_back(runs[k].name + ": " + d);
    return s;
}

std::vector<RunAgainstRun> againstEachOther(const std::vector<NamedRun>& runs) {
    std::vector<RunAgainstRun> all;
    for (size_t after = 1; after < runs.size(); after++)
        for (size_t before = after; before-- > 0;) {
            const RunResults &a = runs[before].results, &b = runs[after].results;
            if (!sameScene(a, b) || judgedFrames(a) != judgedFrames(b) || judgedFrames(a).empty()) continue;
            RunAgainstRun r{.before = before, .after = after};
            r.differences = differencesOf(a, b);
            for (const MethodResult& m : b.methods) {
                const auto i = indexOf(a, m.text);
                if (!i) {
                    r.onlyAfter.push_back(m.text);
                    continue;
                }
                const MethodResult& old = a.methods[*i];
                if (!m.pooled || !old.pooled || !comparable(m, old)) continue;
                r.changes.push_back({m.text, old.pooled->mean.psnr, m.pooled->mean.psnr,
                                     compareMethods(m.parts, old.parts), old.nsPerPixel, m.nsPerPixel});
            }
            for (const MethodResult& m : a.methods)
                if (!indexOf(b, m.text)) r.onlyBefore.push_back(m.text);
            if (!r.changes.empty()) all.push_back(std::move(r));
            break;
        }
    return all;
}

}  // namespace aa
