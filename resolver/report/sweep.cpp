#include "report/sweep.h"

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "image/colour_map.h"
#include "methods/spec.h"
#include "report/format.h"
#include "report/page.h"
#include "report/web/web_files.h"
#include "study/json_number.h"

namespace aa {
namespace {
using json = nlohmann::ordered_json;

bool isNumber(const std::string& text) {
    char* end = nullptr;
    std::strtod(text.c_str(), &end);
    return !text.empty() && *end == 0;
}
bool isNumeric(const SweepAxis& axis) { return std::all_of(axis.values.begin(), axis.values.end(), isNumber); }

// A swept method's variants that have figures, best first.
struct Base {
    std::string text;
    std::vector<SweepVariant> ranked;
    std::vector<SweepVariant> alike;     // that cannot be told apart from the best
    std::vector<SweepVariant> unjudged;  // that this picture is too small to hold against the best
};
double mseOf(const RunResults& run, const SweepVariant& v) { return run.methods[v.method].pooled->mean.mse; }
std::vector<Base> basesOf(const RunResults& run, const SweepOptions& o) {
    std::vector<Base> bases;
    for (const auto& text : o.methods) bases.emplace_back().text = text;
    for (const SweepVariant& v : sweepVariants(run, o))
        for (Base& b : bases)
            if (b.text == v.base && run.methods[v.method].pooled && !run.isReference(run.methods[v.method]))
                b.ranked.push_back(v);
    for (Base& b : bases) {
        std::stable_sort(b.ranked.begin(), b.ranked.end(),
                         [&](const auto& x, const auto& y) { return mseOf(run, x) < mseOf(run, y); });
        for (size_t i = 1; i < b.ranked.size(); i++)
            if (const auto c = compared(run, b.ranked[0].method, b.ranked[i].method); c && !c->resolved)
                (c->why == Unresolved::tooSmall ? b.unjudged : b.alike).push_back(b.ranked[i]);
    }
    return bases;
}
std::string valuesAt(const std::vector<SweepAxis>& axes, const SweepVariant& v) {
    std::string all;
    for (size_t a = 0; a < axes.size(); a++) all += (a ? ", " : "") + axes[a].name + "=" + axes[a].values[v.at[a]];
    return all;
}
// "kmin=0.86 and 0.88"; of several parameters each in full.
std::string alikeInWords(const std::vector<SweepAxis>& axes, std::vector<SweepVariant> alike) {
    std::sort(alike.begin(), alike.end(), [](const auto& x, const auto& y) { return x.at < y.at; });
    std::vector<std::string> parts;
    // A run of neighbours on a single axis is a range.
    const bool range =
        axes.size() == 1 && alike.size() > 2 && alike.back().at[0] - alike.front().at[0] + 1 == alike.size();
    if (range)
        return axes[0].name + "=" + axes[0].values[alike.front().at[0]] + " to " + axes[0].values[alike.back().at[0]] +
               " (" + std::to_string(alike.size()) + " values)";
    for (size_t i = 0; i < alike.size(); i++)
        parts.push_back(axes.size() > 1 ? "(" + valuesAt(axes, alike[i]) + ")"
                                        : (i == 0 ? axes[0].name + "=" : "") + axes[0].values[alike[i].at[0]]);
    return enumerated(parts, 6);
}
// Whether the parameter takes no value beyond this one.
bool isLimit(const std::string& method, const std::string& name, double value) {
    const MethodSpec spec = parseMethod(method);
    for (const ParamSpec& p : spec.method->params)
        if (p.name == name) return value <= p.min || value >= p.max;
    return false;
}

void tell(const RunResults& run, const std::vector<SweepAxis>& axes, const Base& b, std::vector<std::string>& words) {
    const SweepVariant& best = b.ranked.front();
    const auto& pooled = *run.methods[best.method].pooled;
    std::string s = b.text + ": " + valuesAt(axes, best) + " is best, PSNR " + decibels(pooled.mean.psnr);
    const auto noaa = noaaOf(run);
    if (const auto gain = noaa ? compared(run, best.method, *noaa) : std::nullopt)
        s += ", " + signedDecibelNumber(gain->gainDb) + " dB over no anti-aliasing " + intervalInBrackets(*gain);
    const size_t unjudged = b.unjudged.size();
    if (unjudged)
        s += "; to hold it against " + std::to_string(unjudged) + (unjudged == 1 ? " other value" : " other values") +
             " this picture is too small";
    if (b.alike.empty())
        s += b.ranked.size() > 1 + unjudged ? (unjudged ? "; every value that can be judged" : "; every other value") +
                                                  std::string(" is worse by more than the error bar.")
                                            : ".";
    else if (b.alike.size() + 1 == b.ranked.size())
        s += "; no other value can be told apart from it.";
    else
        s += "; " + alikeInWords(axes, b.alike) + " cannot be told apart from it.";
    words.push_back(s);
    if (b.ranked.size() > 1)
        if (const auto loss = compared(run, b.ranked.back().method, best.method))
            words.push_back(b.text + ": the worst is " + valuesAt(axes, b.ranked.back()) + ", " +
                            signedDecibelNumber(loss->gainDb) + " dB against the best " + intervalInBrackets(*loss) +
                            ".");
    for (size_t a = 0; a < axes.size(); a++) {
        if (axes[a].values.size() < 3 || !isNumeric(axes[a])) continue;
        std::vector<double> tried;
        for (const auto& text : axes[a].values) tried.push_back(std::strtod(text.c_str(), nullptr));
        const double at = tried[best.at[a]];
        const auto [least, most] = std::minmax_element(tried.begin(), tried.end());
        if ((at > *least && at < *most) || isLimit(b.text, axes[a].name, at)) continue;
        const bool isLeast = at == *least;
        words.push_back(b.text + ": the best " + axes[a].name + " lies at the " + (isLeast ? "lower" : "upper") +
                        " end of the values that were tried; go on " + (isLeast ? "below " : "above ") +
                        axes[a].values[best.at[a]] + ".");
    }
}
json comparisonOrNull(const std::optional<Comparison>& c) { return c ? comparisonJson(*c) : json(); }

// Figures that curves and maps can show, besides those with intervals.
json figuresOf(const MethodResult& m, const RunResults& run, json& legend) {
    json values = json::object();
    const auto add = [&](const std::string& name, const std::string& title, const char* better, double v) {
        if (std::none_of(legend.begin(), legend.end(), [&](const json& f) { return f["name"] == name; }))
            legend.push_back({{"name", name}, {"title", title}, {"better", better}});
        values[name] = jsonNumber(v);
    };
    if (m.pooled)
        for (const Figure* f : figuresIn(run))
            if (const auto v = m.pooled->mean.figure(f->name))
                add(std::string(f->name), std::string(f->title) + (f->form == FigureForm::decibels ? ", dB" : ""),
                    f->higherIsBetter ? "high" : "low", *v);
    if (m.nsPerPixel > 0) add("time", "Time, ns per pixel", "low", m.nsPerPixel);
    if (m.temporal) {
        const auto flicker = run.isStatic ? m.temporal->flickerStatic : m.temporal->flickerMoving;
        if (flicker) add("flicker", "Flicker, 8-bit codes", "low", *flicker);
        if (m.temporal->ghostExcess) add("ghosts", "Ghosts, times no anti-aliasing", "low", *m.temporal->ghostExcess);
    }
    return values;
}
}  // namespace

std::vector<std::string> sweepWords(const RunResults& run, const SweepOptions& o) {
    std::vector<std::string> words;
    const auto axes = axesOf(o);
    const auto bases = basesOf(run, o);
    std::vector<const Base*> judged;
    for (const Base& b : bases)
        if (!b.ranked.empty()) judged.push_back(&b), tell(run, axes, b, words);
    if (judged.empty()) return {"There is no ground truth: only times can be compared."};
    if (judged.size() < 2) return words;
    std::stable_sort(judged.begin(), judged.end(),
                     [&](const Base* x, const Base* y) { return mseOf(run, x->ranked[0]) < mseOf(run, y->ranked[0]); });
    const auto gain = compared(run, judged[0]->ranked[0].method, judged[1]->ranked[0].method);
    std::string s = "Of the methods at their best, " + judged[0]->text + " is first";
    if (gain)
        s += ", " + signedDecibelNumber(gain->gainDb) + " dB against " + judged[1]->text +
             (gain->resolved                      ? ""
              : gain->why == Unresolved::tooSmall ? ", for which this picture is too small to judge"
                                                  : ", which cannot be told apart from it");
    words.insert(words.begin(), s + ".");
    return words;
}

std::string sweepHtml(const RunResults& run, const SweepOptions& o) {
    const auto axes = axesOf(o);
    json data = {{"shot", run.shot},
                 {"line", runLine(run)},
                 {"version", run.programVersion},
                 {"words", sweepWords(run, o)},
                 {"protocol", inWords(run.protocol)},
                 {"reference", referenceInWords(run.protocol)}};
    data["axes"] = json::array();
    for (const auto& a : axes)
        data["axes"].push_back({{"name", a.name}, {"values", a.values}, {"numeric", isNumeric(a)}});
    data["bases"] = o.methods;
    data["figures"] = json::array();
    data["variants"] = json::array();
    const auto bases = basesOf(run, o);
    const auto noaa = noaaOf(run);
    for (const SweepVariant& v : sweepVariants(run, o)) {
        const auto base = std::find_if(bases.begin(), bases.end(), [&](const Base& b) { return b.text == v.base; });
        const bool best = !base->ranked.empty() && base->ranked[0].method == v.method;
        const auto among = [&](const std::vector<SweepVariant>& some) {
            return std::any_of(some.begin(), some.end(), [&](const auto& x) { return x.method == v.method; });
        };
        json one = {
            {"text", run.methods[v.method].text}, {"base", base - bases.begin()},     {"at", v.at}, {"best", best},
            {"alike", among(base->alike)},        {"unjudged", among(base->unjudged)}};
        one["gain"] = comparisonOrNull(noaa ? compared(run, v.method, *noaa) : std::nullopt);
        if (best)
            one["toBest"] = comparisonJson({});
        else if (!base->ranked.empty())
            one["toBest"] = comparisonOrNull(compared(run, v.method, base->ranked[0].method));
        one["values"] = figuresOf(run.methods[v.method], run, data["figures"]);
        data["variants"].push_back(std::move(one));
    }
    data["colours"] = errorColoursJson();
    return filled(web::sweepHtml, {{"head", pageHead("AA Resolve: sweep of " + run.shot, {web::css})},
                                   {"chart", web::chart},
                                   {"common", web::common},
                                   {"tables", web::tables},
                                   {"js", web::sweepJs},
                                   {"data", forScript(data)}});
}

}  // namespace aa
