#include "shot/coverage.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

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

// A convex polygon, within a disc when there is one, that counts `weight` times.
struct Piece {
    Polygon polygon;
    const Disc* disc = nullptr;
    double weight = 1;
    double area() const { return weight * (disc ? aa::area(polygon, *disc) : aa::area(polygon)); }
};

// piece = piece within `polygon` + the convex remainders, cut off edge by edge.
Polygon split(const Piece& piece, const Polygon& polygon, std::vector<Piece>& outside) {
    Polygon inside = piece.polygon;
    const double orient = orientation(polygon);
    for (size_t i = 0; i < polygon.size() && !inside.empty(); i++) {
        if (polygon[i] == polygon[(i + 1) % polygon.size()]) continue;  // no side at all
        const HalfPlane inner = innerSide(polygon, i, orient);
        Polygon cut = clip(inside, opposite(inner));
        if (!cut.empty()) outside.push_back({std::move(cut), piece.disc, piece.weight});
        inside = clip(inside, inner);
    }
    return inside;
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
    std::vector<Piece> left = {{pixel}};
    for (const Region* region : frontToBack) {
        double covered = 0;
        std::vector<Piece> rest;
        for (const Piece& piece : left) {
            if (const auto* polygon = std::get_if<Polygon>(region)) {
                const Piece inside{split(piece, *polygon, rest), piece.disc, piece.weight};
                covered += inside.area();
                continue;
            }
            // P \ D = P - (P within D): the second piece counts negatively from here on.
            const Disc& disc = std::get<Disc>(*region);
            const double inside = aa::area(piece.polygon, disc);
            rest.push_back(piece);
            if (inside == 0) continue;
            assert(!piece.disc || aa::area(piece.polygon, *piece.disc) == 0);
            if (piece.disc) continue;
            covered += piece.weight * inside;
            rest.push_back({piece.polygon, &disc, -piece.weight});
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
