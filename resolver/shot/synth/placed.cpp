#include "shot/synth/placed.h"

#include <algorithm>
#include <cmath>

namespace aa {
using glm::dvec2;

namespace {
// Pixels are counted as crossed from so far on, so that no rounding decides between an outline and what it encloses.
constexpr double kMarginPx = 1e-3;

bool holds(const Placed& shape, dvec2 p) {
    return p.x >= shape.bounds.min.x && p.x <= shape.bounds.max.x && p.y >= shape.bounds.min.y &&
           p.y <= shape.bounds.max.y && contains(shape.region, p);
}
// The nearest whole number in [0, limit].
int within(double v, int limit) { return v <= 0 ? 0 : v >= limit ? limit : int(v); }
}  // namespace

std::vector<Placed> placedAt(const std::vector<SynthShape>& shapes, double time) {
    std::vector<Placed> r;
    r.reserve(shapes.size());
    for (const SynthShape& s : shapes) {
        Placed p{&s, s.region, {}};
        if (!s.motion.rests()) {
            if (auto* disc = std::get_if<Disc>(&p.region)) disc->centre = s.motion.apply(disc->centre, time);
            if (auto* polygon = std::get_if<Polygon>(&p.region))
                for (dvec2& corner : *polygon) corner = s.motion.apply(corner, time);
        }
        p.bounds = bounds(p.region);
        r.push_back(std::move(p));
    }
    return r;
}

const Placed* frontMost(const std::vector<Placed>& all, dvec2 p) {
    for (const Placed& c : all)
        if (holds(c, p)) return &c;
    return nullptr;
}

std::vector<std::vector<const Placed*>> shapesOfRows(const std::vector<Placed>& frontToBack, int height,
                                                     double reachPx) {
    std::vector<std::vector<const Placed*>> rows(static_cast<size_t>(height));
    for (const Placed& p : frontToBack) {
        const int first = within(std::ceil(p.bounds.min.y - 1 - reachPx), height),
                  end = within(std::floor(p.bounds.max.y + reachPx) + 1, height);
        for (int y = first; y < end; y++) rows[size_t(y)].push_back(&p);
    }
    return rows;
}

PlacedRow::PlacedRow(const std::vector<const Placed*>& frontToBack, int y, int width, double reachPx)
    : reachPx_(reachPx + kMarginPx), crossed_(size_t(width)), blocks_((size_t(width) + kBlock - 1) / kBlock) {
    const double top = y - reachPx_, bottom = y + 1 + reachPx_;
    for (const Placed* p : frontToBack) {
        const int first = within(std::ceil(p->bounds.min.x - 1 - reachPx_), width),
                  end = within(std::floor(p->bounds.max.x + reachPx_) + 1, width);
        for (size_t b = size_t(first) / kBlock; b * kBlock < size_t(end); b++) blocks_[b].push_back(p);
        if (const auto* disc = std::get_if<Disc>(&p->region)) {
            addCircle(*disc, top, bottom);
            continue;
        }
        const auto& polygon = std::get<Polygon>(p->region);
        for (size_t i = 0; i < polygon.size(); i++) addEdge(polygon[i], polygon[(i + 1) % polygon.size()], top, bottom);
    }
}

const Placed* PlacedRow::frontMost(int x, dvec2 p) const {
    for (const Placed* c : near(x))
        if (holds(*c, p)) return c;
    return nullptr;
}

// The part of the edge between two heights.
void PlacedRow::addEdge(dvec2 a, dvec2 b, double top, double bottom) {
    if (a.y > b.y) std::swap(a, b);
    if (b.y < top || a.y > bottom) return;
    const auto at = [&](double y) { return a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)); };
    const double x0 = a.y < top ? at(top) : a.x, x1 = b.y > bottom ? at(bottom) : b.x;
    cross(std::min(x0, x1), std::max(x0, x1));
}

// Both arcs between two heights.
void PlacedRow::addCircle(const Disc& disc, double top, double bottom) {
    const double up = top - disc.centre.y, down = bottom - disc.centre.y, r = disc.radius;
    const double nearest = up > 0 ? up : down < 0 ? -down : 0, farthest = std::max(std::abs(up), std::abs(down));
    if (nearest > r) return;
    const auto halfWidth = [r](double d) { return std::sqrt(std::max(0.0, r * r - d * d)); };
    const double outer = halfWidth(nearest), inner = halfWidth(farthest), x = disc.centre.x;
    cross(x - outer, x - inner);
    cross(x + inner, x + outer);
}

void PlacedRow::cross(double fromX, double toX) {
    const int width = int(crossed_.size());
    const int first = within(std::ceil(fromX - 1 - reachPx_), width),
              end = within(std::floor(toX + reachPx_) + 1, width);
    std::fill(crossed_.begin() + first, crossed_.begin() + std::max(first, end), char(1));
}

}  // namespace aa
