#include "report/advice.h"

#include <algorithm>

#include "report/format.h"

namespace aa {
namespace {

// What a method asks for: 0 colour, 1 a G-buffer of one sample (depth, normals, ids, motion), 2 more than one sample of
// colour or geometry a pixel, or the edges of triangles.
int needOf(const MethodResult& m) {
    int need = 0;
    for (const std::string& pass : m.passes)
        if (pass.starts_with("subsample") || pass == "edges" || pass == "segments")
            need = 2;
        else if (pass != "color")
            need = std::max(need, 1);
    return need;
}
constexpr const char* kNeeds[] = {"From colour alone", "With depth, motion and the like",
                                  "With sub-samples or triangle edges"};
}  // namespace

std::vector<AdviceGroup> adviceOf(const RunResults& run) {
    const auto noaa = noaaOf(run);
    if (!noaa) return {};
    std::vector<size_t> cheapestFirst;
    for (size_t i = 0; i < run.methods.size(); i++)
        if (const MethodResult& m = run.methods[i];
            m.pooled && m.nsPerPixel > 0 && m.id != "noaa" && m.family != "reference" && !run.isReference(m))
            cheapestFirst.push_back(i);
    std::stable_sort(cheapestFirst.begin(), cheapestFirst.end(),
                     [&](size_t a, size_t b) { return run.methods[a].nsPerPixel < run.methods[b].nsPerPixel; });
    constexpr double kSeenDb = 1;  // less, and unresolved, is not worth the time
    const auto better = [&](size_t a, size_t b) {
        const auto c = compared(run, a, b);
        return c && c->mseDifference < 0 && (c->resolved || c->gainDb >= kSeenDb);
    };
    const auto mse = [&](size_t i) { return run.methods[i].pooled->mean.mse; };
    std::vector<AdviceGroup> groups;
    for (int need = 0; need < 3; need++) {
        AdviceGroup g{kNeeds[need], {}};
        size_t best = *noaa;
        std::vector<size_t> seen;
        for (const size_t i : cheapestFirst) {
            if (needOf(run.methods[i]) > need) continue;
            if (better(i, best)) {
                AdviceStep step{i, run.methods[i].nsPerPixel, {}};
                for (const size_t other : seen)
                    if (const auto c = compared(run, i, other); c && !c->resolved && better(other, *noaa))
                        step.alike.push_back(other);
                std::stable_sort(step.alike.begin(), step.alike.end(),
                                 [&](size_t a, size_t b) { return mse(a) < mse(b); });
                if (const auto c = compared(run, i, *noaa); c && !c->resolved)
                    step.alike.insert(step.alike.begin(), *noaa);
                g.steps.push_back(step);
                best = i;
            }
            seen.push_back(i);
        }
        const bool adds = std::any_of(g.steps.begin(), g.steps.end(),
                                      [&](const AdviceStep& s) { return needOf(run.methods[s.method]) == need; });
        if (adds) groups.push_back(std::move(g));
    }
    return groups;
}

std::vector<std::string> adviceInWords(const RunResults& run) {
    const auto noaa = noaaOf(run);  // there where any advice is
    std::vector<std::string> all;
    for (const AdviceGroup& g : adviceOf(run)) {
        std::string s = g.needs + ": ";
        for (size_t i = 0; i < g.steps.size(); i++) {
            const AdviceStep& step = g.steps[i];
            const MethodResult& m = run.methods[step.method];
            const auto gain = compared(run, step.method, *noaa);
            s += (i ? "; " : "") + std::string("from ") + shortNumber(step.nsPerPixel) + " ns/px " + m.text;
            if (gain) s += ", " + signedDecibelNumber(gain->gainDb) + " dB " + intervalInBrackets(*gain);
            std::vector<std::string> alike;
            for (const size_t k : step.alike) alike.push_back(run.methods[k].text);
            if (!alike.empty()) s += ", not told apart from " + enumerated(alike, 3);
        }
        all.push_back(s + ".");
    }
    return all;
}

}  // namespace aa
