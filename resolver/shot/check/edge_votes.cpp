#include "shot/check/edge_votes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace aa {
using glm::dvec2;

namespace {
constexpr double kMarginPx = 0.1;  // what directions and shares in classes, and the truth's noise, leave uncertain
constexpr double kMarginRank = 1;
constexpr size_t kFewestDiffering = 40;

// Place of an edge along its normal when it leaves `share` of a pixel's area on the side that the normal points to.
// Along n the area of a square is a trapezoid: |n_x| and |n_y| are its half sum and half difference of sides.
double placeInArea(dvec2 n, double share) {
    const double a = std::max(std::abs(n.x), std::abs(n.y)), b = std::min(std::abs(n.x), std::abs(n.y));
    const double less = std::min(share, 1 - share);
    const double fromCentre = 2 * a * less < b ? (a + b) / 2 - std::sqrt(2 * a * b * less) : a * (0.5 - less);
    return share < 0.5 ? fromCentre : -fromCentre;
}
}  // namespace

dvec2 EdgeVotes::normalOf(size_t direction) {
    const double angle = std::numbers::pi * double(direction) / double(kDirections);
    return {std::cos(angle), std::sin(angle)};
}

void EdgeVotes::add(dvec2 normal, double share, bool bright) {
    const double steps = std::atan2(normal.y, normal.x) / std::numbers::pi * double(kDirections);
    const long nearest = std::lround(steps), turns = long(kDirections);
    const bool turned = nearest < 0 || nearest >= turns;  // the same edge, seen from its other side
    const size_t direction = size_t((nearest + turns) % turns);
    if (turned) share = 1 - share, bright = !bright;
    counts_[direction][std::min(kShares - 1, size_t(std::clamp(share, 0.0, 1.0) * double(kShares)))][bright]++;
}

MeanOf::MeanOf(std::span<const dvec2> positionsPx) {
    for (size_t direction = 0; direction < sorted_.size(); direction++) {
        for (const dvec2& p : positionsPx) sorted_[direction].push_back(glm::dot(EdgeVotes::normalOf(direction), p));
        std::sort(sorted_[direction].begin(), sorted_[direction].end());
    }
}

std::optional<bool> MeanOf::bright(size_t direction, size_t share, dvec2 placePx) const {
    const dvec2 n = EdgeVotes::normalOf(direction);
    const double along = glm::dot(n, placePx);
    const auto& places = sorted_[direction];
    if (places.empty()) {
        const double beyond = along - placeInArea(n, EdgeVotes::shareOf(share));
        if (std::abs(beyond) < kMarginPx) return std::nullopt;
        return beyond > 0;
    }
    // The bright samples are those farthest along n; this one's rank among all tells whether it is one of them.
    const double before = double(places.end() - std::upper_bound(places.begin(), places.end(), along + 1e-9));
    const double beyond = EdgeVotes::shareOf(share) * double(places.size()) - before - 0.5;
    if (std::abs(beyond) < kMarginRank) return std::nullopt;
    return beyond > 0;
}

double MeanOf::borneOut(const EdgeVotes& votes, dvec2 placePx) const {
    size_t shown = 0, all = 0;
    for (size_t direction = 0; direction < EdgeVotes::kDirections; direction++)
        for (size_t share = 0; share < EdgeVotes::kShares; share++)
            if (const auto foretold = bright(direction, share, placePx)) {
                shown += votes.count(direction, share, *foretold);
                all += votes.count(direction, share, false) + votes.count(direction, share, true);
            }
    return all ? double(shown) / double(all) : 0;
}

void Contest::add(const EdgeVotes& votes, const MeanOf& stated, dvec2 statedPx, const MeanOf& rival, dvec2 rivalPx) {
    for (size_t direction = 0; direction < EdgeVotes::kDirections; direction++)
        for (size_t share = 0; share < EdgeVotes::kShares; share++) {
            const auto one = stated.bright(direction, share, statedPx), other = rival.bright(direction, share, rivalPx);
            if (!one || !other || *one == *other) continue;
            differing += votes.count(direction, share, false) + votes.count(direction, share, true);
            forRival += votes.count(direction, share, *other);
        }
}

bool Contest::told() const { return differing >= kFewestDiffering; }

}  // namespace aa
