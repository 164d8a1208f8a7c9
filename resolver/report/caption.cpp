#include "report/caption.h"

#include <algorithm>
#include <cmath>

#include "report/format.h"
#include "report/gallery.h"
#include "report/sheet.h"

namespace aa {
namespace {

bool resolved(const RunResults& run, size_t a, size_t b) {
    const auto c = compared(run, a, b);
    return !c || c->resolved;
}
// What the errors are errors of.
std::string truth(const RunResults& run) {
    return run.protocol.reference.empty() ? "the truth" : run.protocol.reference;
}
// Over no anti-aliasing, with its interval.
std::string gain(const RunResults& run, const MethodResult& m) {
    std::string s = signedDecibelNumber(*m.pooled->gainDb) + " dB";
    const auto method = size_t(&m - run.methods.data());
    if (const auto noaa = noaaOf(run); noaa && *noaa != method)
        if (const auto c = compared(run, method, *noaa); c && c->why != Unresolved::equal)
            s += " " + intervalInBrackets(*c);
    return s;
}

// Methods with figures, best first.
std::vector<size_t> ranking(const RunResults& run) {
    std::vector<size_t> order;
    for (size_t i = 0; i < run.methods.size(); i++)
        if (run.methods[i].pooled) order.push_back(i);
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
        return run.methods[a].pooled->mean.mse < run.methods[b].pooled->mean.mse;
    });
    return order;
}

std::string bestSentence(const RunResults& run, const std::vector<size_t>& order) {
    const MethodResult& best = run.methods[order[0]];
    std::vector<std::string> peers, same;
    size_t unjudged = 0;
    for (size_t i = 1; i < order.size(); i++)
        if (const auto c = compared(run, order[0], order[i]); c && !c->resolved) {
            if (c->why == Unresolved::tooSmall)
                unjudged++;
            else
                (c->why == Unresolved::equal ? same : peers).push_back(run.methods[order[i]].text);
        }
    std::string s = best.text + " is nearest to " +
                    (run.protocol.reference.empty() ? "the ground truth" : run.protocol.reference) + ": PSNR " +
                    decibels(best.pooled->mean.psnr);
    if (best.pooled->gainDb && best.id != "noaa") s += ", " + gain(run, best) + " over no anti-aliasing";
    if (!same.empty())
        s +=
            "; " + enumerated(same, 4) + (same.size() == 1 ? " gives" : " give") + " the same picture but for rounding";
    if (!peers.empty()) s += "; " + enumerated(peers, 4) + " cannot be told apart from it";
    if (unjudged)
        s += "; to hold it against " + (unjudged + 1 == order.size() ? "the" : std::to_string(unjudged)) +
             (unjudged == 1 ? " other" : " others") + " this picture is too small";
    return s + ".";
}

// The cheapest method that is nearer to the truth than no anti-aliasing, when it is not the best one anyway.
std::string cheapestSentence(const RunResults& run, const std::vector<size_t>& order, size_t noaa) {
    const MethodResult* cheapest = nullptr;
    for (const size_t i : order) {
        const MethodResult& m = run.methods[i];
        if (i != noaa && m.nsPerPixel > 0 && *m.pooled->gainDb > 0 && resolved(run, i, noaa) &&
            (!cheapest || m.nsPerPixel < cheapest->nsPerPixel))
            cheapest = &m;
    }
    if (!cheapest || cheapest == &run.methods[order[0]]) return {};
    return cheapest->text + " is the cheapest that helps: " + gain(run, *cheapest) + " for " +
           shortNumber(cheapest->nsPerPixel) + " ns per pixel, where " + run.methods[order[0]].text + " takes " +
           shortNumber(run.methods[order[0]].nsPerPixel) + ".";
}
std::string harmSentence(const RunResults& run, const std::vector<size_t>& order, size_t noaa) {
    std::vector<std::string> worse;
    for (const size_t i : order)
        if (i != noaa && *run.methods[i].pooled->gainDb < 0 && resolved(run, i, noaa))
            worse.push_back(run.methods[i].text + ", " + gain(run, run.methods[i]));
    if (worse.empty()) return {};
    std::string s = "Farther from " + truth(run) + " than no anti-aliasing at all: ";
    for (size_t i = 0; i < worse.size(); i++) s += (i ? "; " : "") + worse[i];
    return s + ".";
}

// Two forms of one method that differ in sharpening only: X and XNorm or XNoSharpen, or one parameter named sharpen*.
bool differInSharpening(const MethodResult& sharp, const MethodResult& plain) {
    if (sharp.id == plain.id) {
        std::vector<std::string> differing;
        for (const auto& [name, value] : sharp.parameters)
            if (const auto other = plain.parameters.find(name);
                other == plain.parameters.end() || other->second != value)
                differing.push_back(name);
        return differing.size() == 1 && differing[0].starts_with("sharpen") &&
               sharp.pooled->mean.mse > plain.pooled->mean.mse;
    }
    return plain.id == sharp.id + "Norm" || plain.id == sharp.id + "NoSharpen";
}
std::vector<std::string> sharpenSentences(const RunResults& run, const std::vector<size_t>& order) {
    std::vector<std::string> sentences;
    for (const size_t s : order)
        for (const size_t p : order) {
            const MethodResult &sharp = run.methods[s], &plain = run.methods[p];
            if (s == p || !differInSharpening(sharp, plain)) continue;
            const double cost = plain.pooled->mean.psnr - sharp.pooled->mean.psnr;
            if (!resolved(run, s, p))
                sentences.push_back("The sharpen filter makes no difference that can be resolved between " +
                                    sharp.text + " and " + plain.text + ".");
            else if (cost > 0)
                sentences.push_back("The sharpen filter of " + sharp.text + " costs " + decibels(cost) + ": " +
                                    plain.text + ", the same method " +
                                    (plain.id.ends_with("NoSharpen") ? "without it" : "with another") + ", reaches " +
                                    decibels(plain.pooled->mean.psnr) + ".");
            else
                sentences.push_back("The sharpen filter of " + sharp.text + " gains " + decibels(-cost) + " over " +
                                    plain.text + ".");
        }
    return sentences;
}

// Methods with history by a figure over time, least first; those without the figure are left out.
template <class Get>
std::vector<size_t> leastFirst(const RunResults& run, Get get) {
    std::vector<size_t> order;
    for (size_t i = 0; i < run.methods.size(); i++)
        if (run.methods[i].family == "temporal" && run.methods[i].temporal && get(*run.methods[i].temporal))
            order.push_back(i);
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
        return *get(*run.methods[a].temporal) < *get(*run.methods[b].temporal);
    });
    return order;
}
// Whether two methods differ over time by more than their frames do; `get` picks the comparison of a pair.
template <class Get>
bool resolvedOverTime(const RunResults& run, size_t a, size_t b, Get get) {
    for (const auto& p : run.pairs)
        if ((p.first == a && p.second == b) || (p.first == b && p.second == a)) return get(p) && get(p)->resolved;
    return false;
}
std::string ghostSentence(const RunResults& run) {
    const auto order = leastFirst(run, [](const TemporalMetrics& t) { return t.ghostExcess; });
    if (order.empty()) return {};
    const auto times = [&](size_t i) {
        return run.methods[i].text + " (" + significant(*run.methods[i].temporal->ghostExcess, 2) + " times)";
    };
    std::string s =
        "Where something comes into view, the error of the methods with history against no anti-aliasing is ";
    if (order.size() == 1) return s + significant(*run.methods[order[0]].temporal->ghostExcess, 2) + " times.";
    const size_t least = order.front(), most = order.back();
    s += "least for " + times(least) + " and largest for " + times(most);
    return s + (resolvedOverTime(run, least, most, [](const PairResult& p) { return p.ghost; })
                    ? "."
                    : ", a difference that these frames cannot resolve.");
}
std::string flickerSentence(const RunResults& run) {
    const auto flicker = [&](const TemporalMetrics& t) { return run.isStatic ? t.flickerStatic : t.flickerMoving; };
    const auto order = leastFirst(run, flicker);
    if (order.size() < 2) return {};
    const auto codes = [&](size_t i) {
        return run.methods[i].text + " (" + significant(*flicker(*run.methods[i].temporal), 2) + " codes of 255)";
    };
    const size_t least = order.front(), most = order.back();
    if (!resolvedOverTime(run, least, most, [](const PairResult& p) { return p.flicker; })) return {};
    return "Of the methods with history, " + codes(least) + " flickers least and " + codes(most) + " most.";
}

// One sentence for each reason for which pairs are not told apart.
std::vector<std::string> unresolvedSentences(const RunResults& run) {
    if (run.pairs.empty()) return {};
    struct Reason {
        Unresolved why;
        const char* words;
    };
    constexpr Reason kReasons[] = {
        {Unresolved::truthNoise, "Not told apart, for the truth's noise hides what they differ by"},
        {Unresolved::varies, "Not told apart, for now one is better and now the other over the picture"},
        {Unresolved::tooSmall, "Too little picture to judge: it has too few independent parts"},
        {Unresolved::equal, "Not told apart, for they give the same picture but for rounding"},
    };
    constexpr size_t kListed = 6;
    std::vector<std::string> sentences;
    for (const Reason& reason : kReasons) {
        std::vector<std::string> pairs;
        for (const auto& p : run.pairs)
            if (!p.comparison.resolved && p.comparison.why == reason.why)
                pairs.push_back(run.methods[p.first].text + " and " + run.methods[p.second].text);
        if (pairs.empty()) continue;
        const size_t more = pairs.size() > kListed ? pairs.size() - kListed : 0;
        pairs.resize(pairs.size() - more);
        std::string s = std::string(reason.words) + ": ";
        for (size_t i = 0; i < pairs.size(); i++) s += (i ? "; " : "") + pairs[i];
        sentences.push_back(s + (more ? "; and " + std::to_string(more) + " more pairs." : "."));
    }
    if (sentences.empty())
        sentences.push_back("All methods can be told apart: no 95 % interval of a difference holds zero.");
    return sentences;
}
std::string truthSentence(const RunResults& run, const std::vector<size_t>& order) {
    if (!run.truthNoise || *run.truthNoise == 0) return {};
    double smallest = run.methods[order[0]].pooled->mean.mse;
    if (smallest == 0) return {};
    const double share = *run.truthNoise / smallest;
    std::string s = "The truth's own noise is " + significant(100 * share, 2) + " % of the smallest error";
    // conventions 13.9 asks for less than 1 %.
    return s + (share < 0.01 ? "."
                             : ": more than the 1 % that a fair ranking asks for; render the truth with more samples.");
}
}  // namespace

std::vector<std::string> captions(const RunResults& run) {
    const auto order = ranking(run);
    std::vector<std::string> all;
    if (!run.complete)
        all.push_back("This run was " + incompleteInWords(run) +
                      ": its figures are not those of the whole shot. `run --resume` goes on with it.");
    if (order.empty()) {
        all.push_back(framesWithPictures(run).empty()
                          ? "This run has no ground truth and wrote no pictures: only times can be compared. "
                            "`run --write-frames all` writes pictures of frames without truth, too."
                          : "This run has no ground truth: only times and pictures can be compared.");
        return all;
    }
    if (const std::string& method = run.protocol.reference; !method.empty())
        all.push_back("The figures hold every method against " + method +
                      ", another method of this run, and not against the truth: what " + method +
                      " gets wrong counts as right here.");
    if (run.protocol.region)
        all.push_back("The figures are of the region of " + inWords(*run.protocol.region) + " alone.");
    all.push_back(bestSentence(run, order));
    const auto add = [&](std::string sentence) {
        if (!sentence.empty()) all.push_back(std::move(sentence));
    };
    if (const auto noaa = noaaOf(run)) {
        add(cheapestSentence(run, order, *noaa));
        add(harmSentence(run, order, *noaa));
    }
    for (auto& s : sharpenSentences(run, order)) add(s);
    add(ghostSentence(run));
    add(flickerSentence(run));
    for (auto& s : unresolvedSentences(run)) add(s);
    add(truthSentence(run, order));
    add(leftOutInWords(run));
    add(busyInWords(run));
    return all;
}

}  // namespace aa
