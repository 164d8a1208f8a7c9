// Exact area coverage of convex polygons and discs in a pixel: what ground truth is made of where it can be computed.
//
// Positions in px, y down. Areas are exact up to rounding in double (about 1e-13 px^2).
#pragma once
#include <glm/vec2.hpp>
#include <span>
#include <variant>
#include <vector>

namespace aa {

using Polygon = std::vector<glm::dvec2>;  // convex, either orientation
struct Disc {
    glm::dvec2 centre{0.0};
    double radius = 0;
};
using Region = std::variant<Polygon, Disc>;

// Where dot(normal, p) <= offset.
struct HalfPlane {
    glm::dvec2 normal{1.0, 0.0};
    double offset = 0;
};

Polygon rectangle(double x0, double y0, double x1, double y1);
Polygon clip(const Polygon& polygon, const HalfPlane& side);  // Sutherland-Hodgman; fewer than 3 points: empty
double area(const Polygon& polygon);
double area(const Polygon& polygon, const Disc& disc);  // of the intersection
// Of what several discs, which may overlap each other, cover of the polygon together.
double area(const Polygon& polygon, std::span<const Disc> discs);
bool contains(const Region& region, glm::dvec2 p);  // boundary included
struct Bounds {
    glm::dvec2 min, max;
};
Bounds bounds(const Region& region);

// Visible area in `pixel` of each region, the first being in front, and last what none covers. The areas sum to the
// area of `pixel`.
std::vector<double> visibleAreas(const Polygon& pixel, std::span<const Region* const> frontToBack);

}  // namespace aa
