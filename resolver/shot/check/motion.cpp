#include "shot/check/motion.h"

#include <cmath>
#include <cstdio>

namespace aa {
using glm::dvec2;

namespace {
constexpr double kLeastMotionPx = 0.75;      // slower pixels cannot tell the variants apart
constexpr double kOccluderRatio = 0.99;      // nearer by 1 %: something hid the surface in the frame before
constexpr double kOtherSurfaceRatio = 0.85;  // the same without ids: a surface itself comes nearer from frame to frame
constexpr double kStaticTolerancePx = 1e-3;  // Cycles' Vector pass: 2e-4 px
constexpr double kLeastHitRate = 0.93;       // shadows of ids: hair and wires thinner than a pixel miss now and then
// Colours decide only where many pixels show them: a shadow that crosses one plain surface moves otherwise than it.
constexpr double kTellingColour = 0.02;      // by which the errors of two variants differ
constexpr double kLeastTellingShare = 0.03;  // of the pixels; textures give more than a third, a shadow's edge few

// Variant bits: 1 = turn x, 2 = turn y, 4 = exchange the axes first.
dvec2 varied(dvec2 mv, size_t variant) {
    if (variant & 4) std::swap(mv.x, mv.y);
    return {variant & 1 ? -mv.x : mv.x, variant & 2 ? -mv.y : mv.y};
}
const char* adviceFor(size_t variant) {
    static const char* text[8] = {"",
                                  "turn the sign of motion.X (current - previous, x right)",
                                  "turn the sign of motion.Y (current - previous, y down)",
                                  "turn the sign of both components (current - previous, not previous - current)",
                                  "exchange motion.X and motion.Y",
                                  "exchange motion.X and motion.Y and turn the sign of X",
                                  "exchange motion.X and motion.Y and turn the sign of Y",
                                  "exchange motion.X and motion.Y and turn both signs"};
    return text[variant];
}
double compressed(float v) { return v > 0 ? double(v) / (1 + double(v)) : 0; }

enum class Outcome { hit, miss, unknown };
struct Lookup {
    Outcome outcome = Outcome::unknown;
    uint32_t found = 0;
    double colourError = 0;
};
// What lies around position q of the frame before.
Lookup lookUp(const Frame& previous, const Frame& frame, int x, int y, dvec2 q) {
    const dvec2 base = q - previous.jitterPx - 0.5;  // in units of its samples
    const double bx = std::floor(base.x), by = std::floor(base.y);
    if (!(bx >= 0 && by >= 0 && bx + 1 < frame.width && by + 1 < frame.height)) return {};
    const bool ids = !frame.objectId.empty() && !previous.objectId.empty();
    const uint32_t id = ids ? frame.objectId.at(x, y) : 0;
    const float z = frame.depthView.at(x, y);
    Lookup r{Outcome::miss, ids ? previous.objectId.at(int(std::lround(base.x)), int(std::lround(base.y))) : 0, 0};
    bool hidden = false;
    double best = INFINITY;
    for (int j = 0; j <= 1; j++)
        for (int i = 0; i <= 1; i++) {
            const int px = int(bx) + i, py = int(by) + j;
            hidden = hidden || previous.depthView.at(px, py) < (ids ? kOccluderRatio : kOtherSurfaceRatio) * double(z);
            if (ids && previous.objectId.at(px, py) != id) continue;
            r.outcome = Outcome::hit;
            if (previous.colorLinear.empty() || frame.colorLinear.empty()) continue;
            double error = 0;
            for (size_t c = 0; c < 3; c++)
                error += std::abs(compressed(previous.colorLinear.c[c].at(px, py)) -
                                  compressed(frame.colorLinear.c[c].at(x, y)));
            best = std::min(best, error);
        }
    if (r.outcome == Outcome::hit && std::isfinite(best)) r.colourError = best;
    if ((r.outcome == Outcome::miss || !ids) && hidden) r.outcome = Outcome::unknown;
    return r;
}
}  // namespace

void MotionCheck::addStatic(const Frame& frame, CheckReport& report) {
    if (staticFound_) return;
    for (const auto& [channel, plane] : {std::pair{"motion.X", &frame.motionXPx}, {"motion.Y", &frame.motionYPx}})
        for (int y = 0; y < frame.height; y++)
            for (int x = 0; x < frame.width; x++) {
                const float v = plane->at(x, y);
                if (!(std::abs(v) > kStaticTolerancePx)) continue;
                report.findings.push_back({"motion", frame.number, channel, glm::ivec2(x, y),
                                           "0 px (the shot is static)", std::to_string(v) + " px",
                                           "remove \"static\" from shot.json or the motion from the frames", 0});
                staticFound_ = true;
                return;
            }
}

void MotionCheck::add(const Frame& previous, const Frame& frame) {
    ids_ = !frame.objectId.empty() && !previous.objectId.empty();
    const double widest = 2.0 * std::max(frame.width, frame.height);
    for (int y = 0; y < frame.height; y++)
        for (int x = 0; x < frame.width; x++) {
            const dvec2 mv(frame.motionXPx.at(x, y), frame.motionYPx.at(x, y));
            const double length = std::hypot(mv.x, mv.y);
            if (!(length >= kLeastMotionPx && length <= widest) || frame.depthView.at(x, y) >= 1e9f) continue;
            moving_++;
            const dvec2 p = dvec2(x + 0.5, y + 0.5) + frame.jitterPx;
            Lookup stated;
            for (size_t v = 0; v < variants_.size(); v++) {
                const Lookup l = lookUp(previous, frame, x, y, p - varied(mv, v));
                if (v == 0) stated = l;
                if (l.outcome == Outcome::hit) variants_[v].hits++, variants_[v].colourError += l.colourError;
                if (l.outcome == Outcome::hit && stated.outcome == Outcome::hit) {
                    variants_[v].both++;
                    const double gain = stated.colourError - l.colourError;
                    if (std::abs(gain) > kTellingColour) (gain > 0 ? variants_[v].nearer : variants_[v].farther)++;
                }
                if (l.outcome != Outcome::miss) continue;
                variants_[v].misses++;
                if (v == 0 && !firstMiss_)
                    firstMiss_ = Miss{frame.number, {x, y}, ids_ ? frame.objectId.at(x, y) : 0, l.found};
            }
        }
}

void MotionCheck::judge(CheckReport& report) const {
    const auto rate = [](const Variant& v) {
        return double(v.hits) / double(std::max<uint64_t>(v.hits + v.misses, 1));
    };
    const auto colour = [](const Variant& v) { return v.colourError / double(std::max<uint64_t>(v.hits, 1)); };
    const Variant& stated = variants_[0];
    if (stated.hits + stated.misses < 50) {
        report.notChecked.push_back("motion: fewer than 50 pixels of surfaces move by more than 0.75 px");
        return;
    }
    report.measured.push_back({"motion.pixels", double(moving_)});
    if (ids_)
        report.measured.push_back({"motion.sameObjectShare", rate(stated)});
    else
        report.measured.push_back({"motion.colourError", colour(stated)});
    // Judged by misses first: the ids are exact. By colour where the ids say the same of all (a wall fills the
    // picture).
    size_t winner = 0;
    bool undecided = false;
    for (size_t v = 1; v < variants_.size(); v++) {
        const Variant& other = variants_[v];
        if (other.hits < stated.hits / 2) continue;
        const double fewer = 1 - rate(stated) - (1 - rate(other));
        const bool byIds = fewer > 0.003 && (1 - rate(other)) < 0.6 * (1 - rate(stated));
        const bool nearer = std::abs(fewer) <= 0.003 && colour(other) < 0.6 * colour(stated) && colour(stated) > 1e-3;
        const bool byColour = nearer && double(other.nearer) > kLeastTellingShare * double(other.both) &&
                              other.nearer > 3 * other.farther;
        undecided = undecided || (nearer && !byColour);
        const bool better = byIds || byColour;
        if (better && (winner == 0 || rate(other) > rate(variants_[winner]) ||
                       (rate(other) == rate(variants_[winner]) && colour(other) < colour(variants_[winner]))))
            winner = v;
    }
    char found[200];
    const auto at = firstMiss_ ? std::optional(firstMiss_->pixel) : std::nullopt;
    const auto frame = firstMiss_ ? std::optional(firstMiss_->frame) : std::nullopt;
    if (winner != 0) {
        std::snprintf(found, sizeof found,
                      "%.2f %% as stated, %.2f %% with another sign or axis (colour error %.4f against %.4f)",
                      100 * rate(stated), 100 * rate(variants_[winner]), colour(stated), colour(variants_[winner]));
        report.findings.push_back({"motion", frame, "motion.X motion.Y", at,
                                   ids_ ? "p - motion on the same object in the frame before"
                                        : "p - motion on the same surface in the frame before",
                                   found, adviceFor(winner), stated.misses});
    } else if (rate(stated) < kLeastHitRate && ids_) {
        std::snprintf(found, sizeof found, "%.2f %% of %llu moving pixels do (object %u became %u)", 100 * rate(stated),
                      static_cast<unsigned long long>(stated.hits + stated.misses), firstMiss_->expected,
                      firstMiss_->found);
        report.findings.push_back({"motion", frame, "motion.X motion.Y", at,
                                   "p - motion on the same object in the frame before", found,
                                   "check the unit (pixels), the frame order and the ids", stated.misses});
    } else if (undecided) {
        report.notChecked.push_back(
            "signs and axes of motion: the moving surfaces are too plain, and what changes on them may be a shadow");
    }
}

}  // namespace aa
