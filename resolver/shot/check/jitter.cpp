#include "shot/check/jitter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "shot/manifest.h"

namespace aa {
using glm::dvec2;

namespace {
constexpr size_t kFewestFitted = 60;     // below, the standard error of a fit exceeds 0.1 px
constexpr double kLeastContrast = 0.02;  // linear; weaker edges drown in shading
constexpr double kTolerancePx = 0.12;    // busy edges shorten an offset of 0.5 px by about this much
constexpr double kSigmas = 4;
// Of the edge pixels, what an offset that is the right one explains: 0.97 and more where edges are straight and alone.
// Among hair even the right one explains only 0.85, and the fit, shortened there, would pass for another.
constexpr double kLeastBorneOut = 0.92;
constexpr size_t kDirections = 16, kFewestOfADirection = 12;
constexpr double kLeastIsotropy = 0.35;  // of edge directions: 4 l1 l2 / (l1 + l2)^2; 0.64 when 80 % run one way

// Where an edge between two flat sides crosses a pixel of the mean picture.
struct Edge {
    size_t channel = 0;
    double contrast = 0;  // 0: none
    dvec2 normal{0.0};    // unit, towards the brighter side
    double share = 0;     // of the brighter side in the pixel
};
double bilinear(const PlaneF& p, double x, double y) {  // in units of pixel indices
    const int i = int(std::floor(x)), j = int(std::floor(y));
    const double fx = x - i, fy = y - j;
    return (1 - fy) * ((1 - fx) * p.clamped(i, j) + fx * p.clamped(i + 1, j)) +
           fy * ((1 - fx) * p.clamped(i, j + 1) + fx * p.clamped(i + 1, j + 1));
}
// Both sides must be flat from 1.5 px on: there the band of a diagonal edge (0.71 px) and the bilinear filter have
// ended, and shading, lines and patterns, of which the fit would not give the offset itself, drop out.
Edge edgeAt(const std::vector<const PlaneF*>& mean, int x, int y) {
    Edge e;
    for (size_t c = 0; c < mean.size(); c++) {
        const PlaneF& t = *mean[c];
        const auto at = [&](int i, int j) { return double(t.at(x + i, y + j)); };
        const dvec2 sobel(at(1, -1) + 2 * at(1, 0) + at(1, 1) - at(-1, -1) - 2 * at(-1, 0) - at(-1, 1),
                          at(-1, 1) + 2 * at(0, 1) + at(1, 1) - at(-1, -1) - 2 * at(0, -1) - at(1, -1));
        const double length = glm::length(sobel);
        if (!(length > 8 * 0.3 * std::max(kLeastContrast, e.contrast))) continue;  // 8 K for a step, less across it
        const dvec2 n = sobel / length;
        const auto along = [&](double d) { return bilinear(t, x + d * n.x, y + d * n.y); };
        const double low = along(-1.5), high = along(1.5), contrast = high - low;
        if (!(contrast > kLeastContrast && contrast > e.contrast && contrast > 0.1 * high)) continue;
        const bool flat = std::abs(along(2.5) - high) < 0.1 * contrast && std::abs(along(-2.5) - low) < 0.1 * contrast;
        const bool crossed = at(0, 0) > low + 0.02 * contrast && at(0, 0) < high - 0.02 * contrast;
        if (flat && crossed) e = {c, contrast, n, (at(0, 0) - low) / contrast};
    }
    return e;
}
double extentAlong(dvec2 n, const std::vector<dvec2>& positions) {
    double lo = INFINITY, hi = -INFINITY;
    for (const dvec2& p : positions) lo = std::min(lo, glm::dot(n, p)), hi = std::max(hi, glm::dot(n, p));
    return std::max(hi - lo, 0.05);  // samples in one place make no band
}
std::string px(dvec2 v) {
    char text[64];
    std::snprintf(text, sizeof text, "(%.3f, %.3f) px", v.x, v.y);
    return text;
}
}  // namespace

Registration registerSamples(const std::vector<const PlaneF*>& sample, const std::vector<const PlaneF*>& mean,
                             const std::vector<dvec2>& meanOver, const Plane<uint8_t>& usable) {
    struct Sample {
        dvec2 v;
        double difference;
        size_t direction, half;
    };
    Registration r;
    std::vector<Sample> samples;
    std::array<std::array<size_t, 2>, kDirections> count{};
    const int w = mean[0]->width(), h = mean[0]->height();
    for (int y = 1; y + 1 < h; y++)
        for (int x = 1; x + 1 < w; x++) {
            if (!usable.empty() && !usable.at(x, y)) continue;
            const Edge e = edgeAt(mean, x, y);
            if (e.contrast == 0) continue;
            const double difference = (double(sample[e.channel]->at(x, y)) - mean[e.channel]->at(x, y)) / e.contrast;
            if (!(std::abs(difference) <= 1.1)) continue;  // lit differently: not this edge
            const double turn =
                std::atan2(e.normal.y, e.normal.x) / std::numbers::pi;  // a line is the same after half a turn
            const size_t direction = size_t((turn - std::floor(turn)) * kDirections) % kDirections;
            const size_t half = e.share > 0.5;
            samples.push_back({e.normal / extentAlong(e.normal, meanOver), difference, direction, half});
            const double shown = e.share + difference;  // 0 or 1 at a sample of one of the two sides
            if (std::abs(shown - 0.5) > 0.25) r.votes.add(e.normal, e.share, shown > 0.5);
            count[direction][half]++;
        }
    // Every direction counts the same, however many edges run that way: one wall of stripes must not drown the rest.
    // And pixels that an edge covers by less than half count as much as those it covers by more: a level horizon lies
    // at one offset in all its pixels, which would look like jitter.
    const auto counts = [&](const Sample& s) {
        const auto& halves = count[s.direction];
        return std::min(halves[0], halves[1]) >= kFewestOfADirection / 3 &&
               halves[0] + halves[1] >= kFewestOfADirection;
    };
    glm::dmat2 normalMatrix(0.0), weightSquares(0.0);
    dvec2 right(0.0);
    for (const Sample& s : samples) {
        if (!counts(s)) continue;
        const double weight = 0.5 / double(count[s.direction][s.half]);
        normalMatrix += weight * glm::outerProduct(s.v, s.v);
        weightSquares += weight * weight * glm::outerProduct(s.v, s.v);
        right += weight * s.difference * s.v;
        r.pixels++;
    }
    // Edges of one direction say nothing about the offset along them, and noise in their normals would say it wrongly.
    const double determinant = glm::determinant(normalMatrix), trace = normalMatrix[0][0] + normalMatrix[1][1];
    if (r.pixels < 3 || !(determinant > kLeastIsotropy * trace * trace / 4)) return {};
    const glm::dmat2 inverse = glm::inverse(normalMatrix);
    r.offsetPx = inverse * right;
    double squares = 0;
    for (const Sample& s : samples)
        if (counts(s)) squares += std::pow(s.difference - glm::dot(s.v, r.offsetPx), 2);
    const glm::dmat2 covariance = inverse * weightSquares * inverse * (squares / double(r.pixels - 2));
    r.sigmaPx = {std::sqrt(covariance[0][0]), std::sqrt(covariance[1][1])};
    return r;
}

void JitterCheck::add(const FrameEntry& entry, const Registration& found, double slackPx) {
    frames_.push_back({entry.frame, entry.jitterPx, found, slackPx});
}

std::vector<JitterCheck::Registered> JitterCheck::registered() const {
    std::vector<Registered> good;
    for (const auto& f : frames_)
        if (f.found.pixels >= kFewestFitted) good.push_back(f);
    return good;
}

std::optional<dvec2> JitterCheck::scaleFound() const {
    dvec2 cross(0.0), stated(0.0);
    for (const auto& f : registered()) {
        cross += f.found.offsetPx * f.statedPx;
        stated += f.statedPx * f.statedPx;
    }
    if (!(std::min(stated.x, stated.y) > 1e-6)) return std::nullopt;
    return cross / stated;
}

MeanOf JitterCheck::meanOf(const glm::dmat2& change) const {
    std::vector<dvec2> places;
    for (const dvec2& p : meanOver_) places.push_back(change * p);
    return MeanOf(places);
}

Contest JitterCheck::contest(const std::vector<Registered>& good, const glm::dmat2& change) const {
    const MeanOf stated = meanOf(glm::dmat2(1.0)), rival = meanOf(change);
    Contest c;
    for (const auto& f : good) c.add(f.found.votes, stated, f.statedPx, rival, change * f.statedPx);
    return c;
}

void JitterCheck::judge(CheckReport& report) const {
    const std::vector<Registered> good = registered();
    if (good.empty()) {
        report.notChecked.emplace_back("jitter: no frame has enough edges that can be registered");
        return;
    }
    const MeanOf mean = meanOf(glm::dmat2(1.0));
    double sum = 0;
    size_t undecided = 0;
    std::vector<const Registered*> suspects, wrong;
    for (const auto& f : good) {
        const dvec2 error = f.found.offsetPx - f.statedPx;
        sum += glm::length(error);
        const dvec2 tolerance =
            glm::max(dvec2(kTolerancePx + f.slackPx) + 0.3 * glm::abs(f.statedPx), kSigmas * f.found.sigmaPx);
        if (std::abs(error.x) <= tolerance.x && std::abs(error.y) <= tolerance.y) continue;
        suspects.push_back(&f);
        Contest c;
        c.add(f.found.votes, mean, f.statedPx, mean, f.found.offsetPx);
        const bool tangled = mean.borneOut(f.found.votes, f.found.offsetPx) < kLeastBorneOut;
        if (c.rivalWins() && !tangled) wrong.push_back(&f);
        undecided += !c.told() || tangled;
    }
    report.measured.push_back({"jitter.frames", double(good.size())});
    report.measured.push_back({"jitter.meanErrorPx", sum / double(good.size())});
    // Many wrong frames have one cause, a few have their own.
    if (suspects.size() * 3 > good.size() && judgeTogether(good, report)) return;
    if (wrong.empty()) {
        if (undecided)
            report.notChecked.push_back(
                "jitter of " + std::to_string(undecided) + " of " + std::to_string(good.size()) +
                " frames: their edges lie at too few places in their pixels, or too tangled, to tell");
        nameUntold(good, report);
        return;
    }
    const Registered& f = *wrong[0];
    report.findings.push_back({"jitter", f.frame, "jitter", std::nullopt,
                               "samples at " + px(f.statedPx) + " from the pixel centres (shot.json)",
                               px(f.found.offsetPx) + " in the pixels (" + std::to_string(wrong.size()) + " of " +
                                   std::to_string(good.size()) + " frames differ)",
                               "correct the frame's jitter or render it again", 0});
}

// What would stay unseen in this shot: a turned sign or exchanged axes that no edge pixel could show.
void JitterCheck::nameUntold(const std::vector<Registered>& good, CheckReport& report) const {
    dvec2 largest(0.0);
    for (const auto& f : good) largest = glm::max(largest, glm::abs(f.statedPx));
    std::string untold;
    const auto say = [&](bool jittered, const glm::dmat2& change, const char* what) {
        if (jittered && !contest(good, change).told()) untold += (untold.empty() ? "" : ", ") + std::string(what);
    };
    say(largest.x > kTolerancePx, glm::dmat2(-1, 0, 0, 1), "a turned sign in x");
    say(largest.y > kTolerancePx, glm::dmat2(1, 0, 0, -1), "a turned sign in y");
    say(std::max(largest.x, largest.y) > kTolerancePx, glm::dmat2(0, 1, 1, 0), "exchanged axes");
    if (!untold.empty()) report.notChecked.push_back("jitter: the edges of this picture could not show " + untold);
}

// found = A stated over all frames: A shows flips, exchanged axes and a wrong unit at once, however noisy one frame is.
bool JitterCheck::judgeTogether(const std::vector<Registered>& good, CheckReport& report) const {
    glm::dmat2 stated(0.0), cross(0.0);
    for (const auto& f : good) {
        stated += glm::outerProduct(f.statedPx, f.statedPx);
        cross += glm::outerProduct(f.found.offsetPx, f.statedPx);
    }
    // Some jitter on both axes, or A means nothing; then each frame is compared by itself.
    if (!(std::min(stated[0][0], stated[1][1]) > 1e-6) ||
        !(glm::determinant(stated) > 0.02 * stated[0][0] * stated[1][1]))
        return false;
    const glm::dmat2 a = cross * glm::inverse(stated);
    const double xx = a[0][0], yx = a[0][1], xy = a[1][0], yy = a[1][1];  // a[column][row]
    report.measured.push_back({"jitter.scaleX", xx});
    report.measured.push_back({"jitter.scaleY", yy});
    std::string advice;
    glm::dmat2 change = a;
    if (std::abs(xy) + std::abs(yx) > std::abs(xx) + std::abs(yy)) {
        advice = "exchange the axes of the jitter";
        change = glm::dmat2(0, std::copysign(1.0, yx), std::copysign(1.0, xy), 0);
    } else if (xx < 0 || yy < 0) {
        advice = std::string("turn the sign of the jitter in ") +
                 (xx < 0 && yy < 0 ? "x and y"
                  : xx < 0         ? "x"
                                   : "y") +
                 " (x right, y down)";
        change = glm::dmat2(std::copysign(1.0, xx), 0, 0, std::copysign(1.0, yy));
    } else if (std::min(xx, yy) < 0.5 || std::max(xx, yy) > 1.6) {
        advice = "write the jitter in pixels, sample position minus pixel centre";
    }
    if (advice.empty() || !contest(good, change).rivalWins()) return false;
    char found[160];
    std::snprintf(found, sizeof found, "x = %.2f jx %+.2f jy, y = %.2f jx %+.2f jy in the pixels of %zu frames", xx, xy,
                  yx, yy, good.size());
    report.findings.push_back(
        {"jitter", good[0].frame, "jitter", std::nullopt, "samples at x = jx, y = jy (shot.json)", found, advice, 0});
    return true;
}

}  // namespace aa
