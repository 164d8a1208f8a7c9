#include "shot/synth/coverage.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace aa {
using glm::dvec2;

namespace {
double cross(dvec2 a, dvec2 b) { return a.x * b.y - a.y * b.x; }

// +1 when the corners run so that the interior has positive cross products, else -1.
double orientation(const Polygon& p) {
    double twice = 0;
    for (size_t i = 0; i < p.size(); i++) twice += cross(p[i], p[(i + 1) % p.size()]);
    return twice < 0 ? -1 : 1;
}
// The half-plane on the inner side of edge i.
HalfPlane innerSide(const Polygon& p, size_t i, double orient) {
    const dvec2 a = p[i], d = p[(i + 1) % p.size()] - a;
    const dvec2 outward = orient * dvec2(d.y, -d.x);
    return {outward, glm::dot(outward, a)};
}
HalfPlane opposite(const HalfPlane& h) { return {-h.normal, -h.offset}; }

// Area of the disc around the origin within the triangle (0, a, b), signed by the turn from a to b.
double discTriangle(dvec2 a, dvec2 b, double r) {
    const auto sector = [r](dvec2 p, dvec2 q) { return 0.5 * r * r * std::atan2(cross(p, q), glm::dot(p, q)); };
    const dvec2 d = b - a;
    const double dd = glm::dot(d, d), half = glm::dot(a, d), root2 = half * half - dd * (glm::dot(a, a) - r * r);
    if (dd == 0) return 0;
    if (root2 <= 0) return sector(a, b);  // the line misses the disc
    const double root = std::sqrt(root2), t0 = (-half - root) / dd, t1 = (-half + root) / dd;
    if (t1 <= 0 || t0 >= 1) return sector(a, b);  // the segment does
    const dvec2 enter = t0 > 0 ? a + t0 * d : a, leave = t1 < 1 ? a + t1 * d : b;
    return (t0 > 0 ? sector(a, enter) : 0.0) + 0.5 * cross(enter, leave) + (t1 < 1 ? sector(leave, b) : 0.0);
}

// The part of the segment a..b within the disc, as an interval of its parameter; empty: first > second.
std::pair<double, double> withinDisc(dvec2 a, dvec2 b, const Disc& disc) {
    const dvec2 d = b - a, from = a - disc.centre;
    const double dd = glm::dot(d, d), half = glm::dot(from, d);
    const double root2 = half * half - dd * (glm::dot(from, from) - disc.radius * disc.radius);
    if (dd == 0 || root2 <= 0) return {1, 0};
    const double root = std::sqrt(root2);
    return {std::max(0.0, (-half - root) / dd), std::min(1.0, (-half + root) / dd)};
}

// Area of (polygon within the union of the discs) by Green's theorem: the integral of (x dy - y dx) / 2 along its
// boundary, which consists of the pieces of the polygon's edges within some disc and of the arcs of each circle within
// the polygon and outside of all other discs. Positions are taken from `origin`, against cancellation.
class DiscUnion {
  public:
    DiscUnion(const Polygon& polygon, std::span<const Disc> discs) : polygon_(polygon), origin_(polygon[0]) {
        if (orientation(polygon) < 0) std::reverse(polygon_.begin(), polygon_.end());
        for (const Disc& d : discs)  // of equal discs one: their circles would count twice
            if (d.radius > 0 && std::none_of(discs_.begin(), discs_.end(), [&](const Disc& o) {
                    return o.centre == d.centre && o.radius == d.radius;
                }))
                discs_.push_back(d);
    }
    double area() const {
        double sum = 0;
        for (size_t i = 0; i < polygon_.size(); i++) sum += alongEdge(polygon_[i], polygon_[(i + 1) % polygon_.size()]);
        for (size_t i = 0; i < discs_.size(); i++) sum += alongCircle(i);
        return std::max(sum, 0.0);
    }

  private:
    double alongEdge(dvec2 a, dvec2 b) const {
        std::vector<std::pair<double, double>> inside;
        for (const Disc& d : discs_)
            if (const auto part = withinDisc(a, b, d); part.first < part.second) inside.push_back(part);
        std::sort(inside.begin(), inside.end());
        double covered = 0, end = 0;  // of the parameter
        for (const auto& [first, last] : inside) {
            covered += std::max(0.0, last - std::max(first, end));
            end = std::max(end, last);
        }
        return 0.5 * cross(a - origin_, b - a) * covered;
    }
    double alongCircle(size_t i) const {
        const Disc& disc = discs_[i];
        std::vector<double> angles = {-std::numbers::pi, std::numbers::pi};
        const auto add = [&](double angle) { angles.push_back(std::remainder(angle, 2 * std::numbers::pi)); };
        for (size_t k = 0; k < polygon_.size(); k++) {  // where the lines of the polygon's edges cut the circle
            const dvec2 a = polygon_[k] - disc.centre, d = polygon_[(k + 1) % polygon_.size()] - polygon_[k];
            const double length = glm::length(d), distance = length > 0 ? cross(a, d) / length : INFINITY;
            if (!(std::abs(distance) < disc.radius)) continue;
            const double towards = std::atan2(-d.x, d.y), half = std::acos(distance / disc.radius);
            add(towards - half), add(towards + half);
        }
        for (size_t k = 0; k < discs_.size(); k++) {  // where the other circles do
            const dvec2 to = discs_[k].centre - disc.centre;
            const double distance = glm::length(to), r = disc.radius, s = discs_[k].radius;
            if (k == i || distance >= r + s || distance <= std::abs(r - s)) continue;
            const double towards = std::atan2(to.y, to.x);
            const double half =
                std::acos(std::clamp((distance * distance + r * r - s * s) / (2 * distance * r), -1.0, 1.0));
            add(towards - half), add(towards + half);
        }
        std::sort(angles.begin(), angles.end());
        const dvec2 centre = disc.centre - origin_;
        double sum = 0;
        for (size_t k = 0; k + 1 < angles.size(); k++) {
            const double from = angles[k], to = angles[k + 1], middle = (from + to) / 2;
            if (!(to > from) || !isBoundary(disc.centre + disc.radius * dvec2(std::cos(middle), std::sin(middle)), i))
                continue;
            sum += 0.5 * disc.radius *
                   (disc.radius * (to - from) + centre.x * (std::sin(to) - std::sin(from)) -
                    centre.y * (std::cos(to) - std::cos(from)));
        }
        return sum;
    }
    // Whether a point of circle `own` lies on the boundary of the area.
    bool isBoundary(dvec2 p, size_t own) const {
        for (size_t i = 0; i < polygon_.size(); i++)
            if (cross(polygon_[(i + 1) % polygon_.size()] - polygon_[i], p - polygon_[i]) < 0) return false;
        for (size_t k = 0; k < discs_.size(); k++)
            if (k != own && contains(discs_[k], p)) return false;
        return true;
    }
    Polygon polygon_;
    std::vector<Disc> discs_;
    dvec2 origin_;
};

// A convex polygon without some discs: what is left of the pixel.
struct Piece {
    Polygon polygon;
    std::vector<Disc> without;
    double removed = 0;  // area of the polygon that the discs cover
    double area() const { return aa::area(polygon) - removed; }
};
Piece makePiece(Polygon polygon, const std::vector<Disc>& without) {
    const double removed = aa::area(polygon, without);
    return {std::move(polygon), without, removed};
}

// piece = piece within `polygon`, which is returned, + the convex remainders, cut off edge by edge.
Piece split(const Piece& piece, const Polygon& polygon, std::vector<Piece>& outside) {
    Polygon inside = piece.polygon;
    const double orient = orientation(polygon);
    for (size_t i = 0; i < polygon.size() && !inside.empty(); i++) {
        if (polygon[i] == polygon[(i + 1) % polygon.size()]) continue;  // no side at all
        const HalfPlane inner = innerSide(polygon, i, orient);
        Polygon cut = clip(inside, opposite(inner));
        if (!cut.empty()) outside.push_back(makePiece(std::move(cut), piece.without));
        inside = clip(inside, inner);
    }
    return makePiece(std::move(inside), piece.without);
}
}  // namespace

Polygon rectangle(double x0, double y0, double x1, double y1) { return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}; }

Polygon clip(const Polygon& polygon, const HalfPlane& side) {
    Polygon r;
    r.reserve(polygon.size() + 1);
    for (size_t i = 0; i < polygon.size(); i++) {
        const dvec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        const double da = glm::dot(side.normal, a) - side.offset, db = glm::dot(side.normal, b) - side.offset;
        if (da <= 0) r.push_back(a);
        if ((da < 0 && db > 0) || (da > 0 && db < 0)) r.push_back(a + (b - a) * (da / (da - db)));
    }
    if (r.size() < 3) r.clear();
    return r;
}

double area(const Polygon& p) {
    if (p.size() < 3) return 0;
    double twice = 0;
    for (size_t i = 1; i + 1 < p.size(); i++)
        twice += cross(p[i] - p[0], p[i + 1] - p[0]);  // about a corner: no cancellation
    return std::abs(twice) / 2;
}

double area(const Polygon& p, const Disc& disc) {
    double sum = 0;
    for (size_t i = 0; i < p.size(); i++)
        sum += discTriangle(p[i] - disc.centre, p[(i + 1) % p.size()] - disc.centre, disc.radius);
    return std::abs(sum);
}

double area(const Polygon& p, std::span<const Disc> discs) {
    if (p.size() < 3 || discs.empty()) return 0;
    return discs.size() == 1 ? area(p, discs[0]) : DiscUnion(p, discs).area();
}

bool contains(const Region& region, dvec2 p) {
    if (const auto* disc = std::get_if<Disc>(&region)) {
        const dvec2 d = p - disc->centre;
        return glm::dot(d, d) <= disc->radius * disc->radius;
    }
    const Polygon& polygon = std::get<Polygon>(region);
    bool left = true, right = true;
    for (size_t i = 0; i < polygon.size(); i++) {
        const dvec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        const double side = cross(b - a, p - a);
        left = left && side >= 0;
        right = right && side <= 0;
    }
    return left || right;
}

Bounds bounds(const Region& region) {
    if (const auto* disc = std::get_if<Disc>(&region))
        return {disc->centre - disc->radius, disc->centre + disc->radius};
    Bounds b{dvec2(INFINITY), dvec2(-INFINITY)};
    for (const dvec2& p : std::get<Polygon>(region)) b = {glm::min(b.min, p), glm::max(b.max, p)};
    return b;
}

std::vector<double> visibleAreas(const Polygon& pixel, std::span<const Region* const> frontToBack) {
    std::vector<double> areas;
    std::vector<Piece> left = {makePiece(pixel, {})};
    for (const Region* region : frontToBack) {
        double covered = 0;
        std::vector<Piece> rest;
        for (Piece& piece : left) {
            if (const auto* polygon = std::get_if<Polygon>(region)) {
                covered += split(piece, *polygon, rest).area();
                continue;
            }
            const Disc& disc = std::get<Disc>(*region);
            if (area(piece.polygon, disc) > 0) {
                const double before = piece.removed;
                piece.without.push_back(disc);
                piece.removed = area(piece.polygon, piece.without);
                covered += std::max(piece.removed - before, 0.0);
            }
            rest.push_back(std::move(piece));
        }
        areas.push_back(covered);
        left = std::move(rest);
    }
    double uncovered = 0;
    for (const Piece& piece : left) uncovered += piece.area();
    areas.push_back(uncovered);
    return areas;
}

}  // namespace aa
