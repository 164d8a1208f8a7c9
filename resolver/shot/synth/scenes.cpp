#include "shot/synth/scenes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "image/error.h"
#include "shot/synth/drawn_frames.h"

namespace aa {
using glm::dvec2;
using glm::dvec3;

namespace {
constexpr double kPi = std::numbers::pi;
constexpr double kGolden = 0.6180339887498949;  // spreads sub-pixel offsets evenly over any number of tiles

dvec2 direction(double angle) { return {std::cos(angle), std::sin(angle)}; }
double frac(double v) { return v - std::floor(v); }

// Repeatable numbers in [0,1) by index: Wang's integer hash.
double hashed(uint32_t seed, uint32_t index) {
    uint32_t h = seed * 0x9E3779B9u + index;
    h = (h ^ 61u) ^ (h >> 16);
    h *= 9u;
    h ^= h >> 4;
    h *= 0x27d4eb2du;
    h ^= h >> 15;
    return h / 4294967296.0;
}
class Palette {
  public:
    explicit Palette(uint32_t seed) : seed_(seed) {}
    dvec3 light() { return next(0.7, 1.0); }
    dvec3 dark() { return next(0.0, 0.12); }
    dvec3 middle() { return next(0.15, 0.6); }

  private:
    dvec3 next(double lo, double hi) {
        dvec3 c;
        for (int i = 0; i < 3; i++) c[i] = lo + (hi - lo) * hashed(seed_, index_++);
        return c;
    }
    uint32_t seed_, index_ = 0;
};

Camera perspectiveCamera(int w, int h, double fieldOfViewX) {
    Camera c;
    c.kind = "perspective";
    c.nearClip = 0.1;
    c.farClip = 100;
    const double focal = 1 / std::tan(fieldOfViewX / 2);
    c.projection = glm::dmat4(0.0);
    c.projection[0][0] = focal;
    c.projection[1][1] = focal * w / h;
    c.projection[2][2] = -(c.farClip + c.nearClip) / (c.farClip - c.nearClip);
    c.projection[3][2] = -2 * c.farClip * c.nearClip / (c.farClip - c.nearClip);
    c.projection[2][3] = -1;
    // Turned and moved, so that world and view space cannot be taken for each other.
    const double yaw = 0.7, pitch = -0.4;
    const glm::dmat3 about_y(std::cos(yaw), 0, -std::sin(yaw), 0, 1, 0, std::sin(yaw), 0, std::cos(yaw));
    const glm::dmat3 about_x(1, 0, 0, 0, std::cos(pitch), std::sin(pitch), 0, -std::sin(pitch), std::cos(pitch));
    const glm::dmat3 turn = about_x * about_y;
    c.view = glm::dmat4(turn);
    c.view[3] = glm::dvec4(turn * dvec3(-3, 1, 2), 1);
    return c;
}

// Cells of an integer grid over the picture: their borders are pixel borders, so they add no partial coverage.
struct Tile {
    double x0, y0, x1, y1;
    size_t index;
    dvec2 centre() const { return {(x0 + x1) / 2, (y0 + y1) / 2}; }
    double side() const { return std::min(x1 - x0, y1 - y0); }
};
std::vector<Tile> tiles(int w, int h, int columns, int rows) {
    std::vector<Tile> r;
    for (int j = 0; j < rows; j++)
        for (int i = 0; i < columns; i++)
            r.push_back({double(w * i / columns), double(h * j / rows), double(w * (i + 1) / columns),
                         double(h * (j + 1) / rows), r.size()});
    return r;
}
// Columns x rows >= count with cells as square as can be.
std::pair<int, int> gridFor(int count, int w, int h) {
    const int rows = std::max(1, int(std::floor(std::sqrt(double(count) * h / w))));
    return {(count + rows - 1) / rows, rows};
}

SynthShape flat(Region region, uint32_t object, dvec3 color, double depth) {
    SynthShape s;
    s.region = std::move(region);
    s.object = object;
    s.color = color;
    s.distance = -depth;
    return s;
}
Polygon inTile(const Tile& t, const HalfPlane& side) { return clip(rectangle(t.x0, t.y0, t.x1, t.y1), side); }
// A line of a width through a point, as long as `half` to both sides.
Polygon bar(dvec2 centre, double angle, double half, double width) {
    const dvec2 d = direction(angle) * half, n = dvec2(-std::sin(angle), std::cos(angle)) * (width / 2);
    return {centre - d - n, centre + d - n, centre + d + n, centre - d + n};
}

// Dark before light, with one edge; both reach far beyond the picture, so that it has no other.
SynthSceneContents halfPlane(int w, int h, double angleDegrees, double offsetPx) {
    SynthSceneContents s;
    const dvec2 n = direction(angleDegrees * kPi / 180);
    const double offset = glm::dot(n, dvec2(w / 2.0, h / 2.0)) + offsetPx;
    const Polygon everything = rectangle(-w, -h, 2.0 * w, 2.0 * h);
    s.shapes = {flat(clip(everything, {n, offset}), 1, dvec3(0.04), 8),
                flat(clip(everything, {-n, -offset}), 2, dvec3(0.8), 12)};
    s.objects = {{1, "dark side"}, {2, "light side"}};
    return s;
}

// At least 64 tiles, each one edge at an angle and sub-pixel offset of its own.
SynthSceneContents halfPlanes(int w, int h, uint32_t seed) {
    SynthSceneContents s;
    Palette palette(seed);
    const auto [columns, rows] = gridFor(64, w, h);
    const auto grid = tiles(w, h, columns, rows);
    for (const Tile& t : grid) {
        if (t.x1 <= t.x0 || t.y1 <= t.y0) continue;
        const dvec2 n = direction(2 * kPi * (double(t.index) + 0.5) / double(grid.size()));
        const double offset = glm::dot(n, t.centre()) + frac(double(t.index + 1) * kGolden) - 0.5;
        const auto id = uint32_t(2 * t.index + 1);
        const Polygon dark = inTile(t, {n, offset}), light = inTile(t, {-n, -offset});
        if (!dark.empty()) s.shapes.push_back(flat(dark, id, palette.dark(), 8));
        if (!light.empty()) s.shapes.push_back(flat(light, id + 1, palette.light(), 12));
        s.objects[id] = "dark side " + std::to_string(t.index);
        s.objects[id + 1] = "light side " + std::to_string(t.index);
    }
    return s;
}

// Discs of 0.3 px to a third of their tile in radius.
SynthSceneContents circles(int w, int h, uint32_t seed) {
    SynthSceneContents s;
    Palette palette(seed);
    const auto [columns, rows] = gridFor(48, w, h);
    const auto grid = tiles(w, h, columns, rows);
    for (const Tile& t : grid) {
        const double share = double(t.index) / double(grid.size() - 1), largest = std::max(0.3, t.side() * 0.4);
        const double radius = 0.3 * std::pow(largest / 0.3, share);
        const dvec2 centre =
            t.centre() + dvec2(frac(double(t.index) * kGolden), frac(double(t.index) * kGolden * kGolden)) - 0.5;
        const auto id = uint32_t(t.index + 2);
        s.shapes.push_back(flat(Disc{centre, radius}, id, t.index % 2 ? palette.light() : palette.dark(), 8));
        s.objects[id] = "disc of radius " + std::to_string(radius).substr(0, 5) + " px";
    }
    s.shapes.push_back(flat(rectangle(-1, -1, w + 1, h + 1), 1, palette.middle(), 12));
    s.objects[1] = "wall";
    return s;
}

// Columns: widths 0.2 to 2 px. Rows: angles.
SynthSceneContents thinLines(int w, int h, uint32_t seed) {
    SynthSceneContents s;
    Palette palette(seed);
    const auto [columns, rows] = gridFor(64, w, h);
    const dvec3 wall = palette.middle();
    for (const Tile& t : tiles(w, h, columns, rows)) {
        const size_t column = t.index % size_t(columns), row = t.index / size_t(columns);
        const double width = 0.2 * std::pow(10.0, columns > 1 ? double(column) / (columns - 1) : 0.5);
        const double angle = kPi * (double(row) + frac(double(column) * kGolden)) / rows;
        const dvec2 centre = t.centre() + frac(double(t.index) * kGolden) - 0.5;
        const auto id = uint32_t(t.index + 2);
        s.shapes.push_back(
            flat(bar(centre, angle, t.side() * 0.42, width), id, row % 2 ? palette.light() : palette.dark(), 8));
        s.objects[id] = "line of width " + std::to_string(width).substr(0, 4) + " px";
    }
    s.shapes.push_back(flat(rectangle(-1, -1, w + 1, h + 1), 1, wall, 12));
    s.objects[1] = "wall";
    return s;
}

SynthSceneContents zonePlate(int w, int h, uint32_t) {
    SynthSceneContents s;
    s.shapes = {flat(rectangle(-1, -1, w + 1, h + 1), 1, dvec3(0.5), 10)};
    s.objects = {{1, "zone plate"}};
    s.zonePlate = true;
    return s;
}

// Contiguous slanted stripes over the whole picture, all of one object.
void addStripes(SynthSceneContents& s, int w, int h, double angle, double width, double depth, dvec3 one, dvec3 other) {
    const dvec2 n = direction(angle), middle(w / 2.0, h / 2.0);
    const double reach = std::hypot(w, h) / 2 + 2;
    const Polygon picture = rectangle(-1, -1, w + 1, h + 1);
    const int count = int(std::ceil(reach / width));
    for (int i = -count; i < count; i++) {
        const double lo = glm::dot(n, middle) + i * width, hi = lo + width;
        const Polygon stripe = clip(clip(picture, {n, hi}), {-n, -lo});
        if (!stripe.empty()) s.shapes.push_back(flat(stripe, 1, i % 2 ? one : other, depth));
    }
    s.objects[1] = "striped wall";
}

// Shapes that translate and turn by fractions of a pixel before a striped wall and cover each other.
SynthSceneContents moving(int w, int h, uint32_t seed) {
    SynthSceneContents s;
    s.isStatic = false;
    Palette palette(seed);
    const double u = h;
    const auto add = [&](Region r, uint32_t id, const char* name, dvec3 color, double depth, dvec2 velocity,
                         double turn, dvec2 pivot) {
        SynthShape shape = flat(std::move(r), id, color, depth);
        shape.motion = {velocity, turn, pivot};
        s.shapes.push_back(std::move(shape));
        s.objects[id] = name;
    };
    // Front to back. The bar moves by whole pixels: a resampling method must carry it exactly.
    add(bar({w * 0.5, u * 0.2}, 0.05, w * 0.3, 1.3), 5, "bar", palette.dark(), 6, {0, 1}, 0, {});
    add(Disc{{w * 0.75, u * 0.4}, 0.12 * u}, 3, "disc", palette.light(), 8, {-2.25, 0.75}, 0, {});
    const dvec2 pivot(w * 0.3, u * 0.45);
    const double side = 0.13 * u;
    add(rectangle(pivot.x - side, pivot.y - side, pivot.x + side, pivot.y + side), 2, "square", palette.dark(), 10,
        {1.3, 0.4}, kPi / 60, pivot);
    add(Polygon{{w * 0.55, u * 0.95}, {w * 0.7, u * 0.9}, {w * 0.6, u * 0.6}}, 4, "triangle", palette.light(), 12,
        {0.5, -1.75}, 0, {});
    const dvec3 one = palette.middle(), other = palette.middle();
    addStripes(s, w, h, 0.3, 0.051 * u, 20, one, other);
    return s;
}

// Triangles and wires all over the picture, so dense that 10 to 15 % of the pixels lie on an edge at any resolution.
SynthSceneContents clutter(int w, int h, uint32_t seed) {
    SynthSceneContents s;
    Palette palette(seed);
    constexpr double kTile = 32;
    const int columns = std::max(1, int(w / kTile)), rows = std::max(1, int(h / kTile));
    uint32_t id = 2, index = 0;
    const auto next = [&](double lo, double hi) { return lo + (hi - lo) * hashed(seed ^ 0x51EDu, index++); };
    for (const Tile& t : tiles(w, h, columns, rows)) {
        // One draw per statement: the order of arguments is each compiler's own.
        const double y = next(t.y0, t.y1), x = next(t.x0, t.x1), angle = next(0, 2 * kPi);
        const dvec2 at(x, y);
        const dvec3 color = t.index % 3 == 0 ? palette.dark() : t.index % 3 == 1 ? palette.light() : palette.middle();
        Polygon shape;
        if (t.index % 4 == 3) {
            const double width = next(0.6, 2.5), length = next(50, 120);
            shape = bar(at, angle, length, width);
        } else {
            for (int k = 0; k < 3; k++) shape.push_back(at + direction(angle + 2.1 * k) * next(18, 46));
        }
        s.shapes.push_back(flat(shape, id, color, 5 + 1e-3 * id));
        s.objects[id] = "shape " + std::to_string(id);
        id++;
    }
    s.shapes.push_back(flat(rectangle(-1, -1, w + 1, h + 1), 1, palette.middle(), 60));
    s.objects[1] = "wall";
    return s;
}

// A curved line of a width: a chain of quadrilaterals that share their ends, so that it is covered once. `turn` is the
// angle between its two ends, spread evenly over its length.
constexpr double kLargestBend = 0.15;  // radians between two parts: no corner to see at these widths
void addStrand(SynthSceneContents& s, dvec2 at, double angle, double length, double turn, const SynthShape& like,
               double width) {
    const int parts = std::max(1, int(std::ceil(std::abs(turn) / kLargestBend)));
    const double bend = turn / parts, half = width / 2;
    // Across the strand at the end of a part: between its two directions, and longer, so that the width stays.
    const auto across = [&](int i) {
        const bool tip = i == 0 || i == parts;
        const double normal = angle + bend * (i == parts ? i - 1 : tip ? 0 : i - 0.5) + kPi / 2;
        return direction(normal) * (half / (tip ? 1 : std::cos(bend / 2)));
    };
    for (int i = 0; i < parts; i++) {
        const dvec2 from = at, n0 = across(i), n1 = across(i + 1);
        at += direction(angle + bend * i) * (length / parts);
        SynthShape part = like;
        part.region = Polygon{from - n0, at - n1, at + n1, from + n0};  // its edges 1 and 3 are the ends
        part.seams = (i + 1 < parts ? 1u << 1 : 0u) | (i > 0 ? 1u << 3 : 0u);
        s.shapes.push_back(part);
    }
}

// Strands of 0.3 to 2 px in width, thrown over each other before a wall, half of them straight and half of them grey:
// every random number is a hash of the strand's index. As many per area at every size, so that about a third of a large
// picture is hair. Their values fill [0,1], as the picture that the thesis judges does [Oliveros 2018].
SynthSceneContents hairs(int w, int h, uint32_t seed) {
    constexpr double kAreaPerHair = 160, kShortest = 40, kLongest = 140, kThinnest = 0.3, kThickest = 2;  // px
    constexpr int kTufts = 16, kFewest = 24;
    SynthSceneContents s;
    Palette palette(seed);
    const auto count = std::max(kFewest, int(double(w) * h / kAreaPerHair));
    for (int i = 0; i < count; i++) {
        uint32_t index = 16 * uint32_t(i);
        const auto next = [&](double lo, double hi) { return lo + (hi - lo) * hashed(seed ^ 0xA1Bu, index++); };
        const double width = kThinnest * std::pow(kThickest / kThinnest, next(0, 1)),
                     length = next(kShortest, kLongest);
        const double angle = next(0, 2 * kPi), turn = i % 2 ? next(-2, 2) : 0.0;
        const dvec2 middle{next(0, w), next(0, h)};  // braces: in this order with every compiler
        dvec3 color{next(0, 1), next(0, 1), next(0, 1)};
        if (i % 4 < 2) color = dvec3(color.x);
        SynthShape like;
        like.object = uint32_t(2 + i % kTufts);
        like.color = color;
        like.distance = -(5 + 20.0 * i / count);  // front to back, each at a depth of its own
        addStrand(s, middle - direction(angle + turn / 2) * (length / 2), angle, length, turn, like, width);
        s.objects[like.object] = "tuft " + std::to_string(i % kTufts);
    }
    s.shapes.push_back(flat(rectangle(-1, -1, w + 1, h + 1), 1, palette.middle(), 60));
    s.objects[1] = "wall";
    return s;
}

// Wires and poles before an empty sky and a field.
SynthSceneContents thinMotion(int w, int h, uint32_t seed) {
    SynthSceneContents s;
    s.isStatic = false;
    Palette palette(seed);
    s.backgroundColor = palette.light();
    constexpr int kWires = 8;
    for (int i = 0; i < kWires; i++) {
        const double width = 0.3 + 1.3 * i / (kWires - 1);
        SynthShape wire = flat(bar({w / 2.0, h * (0.06 + 0.09 * i)}, -0.12 + 0.04 * i, w, width), uint32_t(2 + i),
                               palette.dark(), 5 + 0.25 * i);
        wire.motion.velocityPx = {0, 0.3 + 0.23 * i};
        s.shapes.push_back(wire);
        s.objects[wire.object] = "wire of width " + std::to_string(width).substr(0, 4) + " px";
    }
    SynthShape spoke = flat(bar({w * 0.5, h * 0.5}, 0.4, h * 0.4, 0.8), 20, palette.dark(), 8);
    spoke.motion = {{0.35, 0}, kPi / 90, {w * 0.5, h * 0.5}};
    s.shapes.push_back(spoke);
    s.objects[20] = "turning wire";
    for (int i = 0; i < 4; i++) {
        const double x = w * (0.13 + 0.25 * i) + 0.3 * i;
        s.shapes.push_back(flat(Polygon{{x, -1}, {x + 2.4, -1}, {x + 3.6, h + 1.0}, {x - 1.2, h + 1.0}},
                                uint32_t(30 + i), palette.middle(), 9));
        s.objects[uint32_t(30 + i)] = "pole " + std::to_string(i);
    }
    s.shapes.push_back(
        flat(Polygon{{-1, h * 0.8}, {w + 1.0, h * 0.86}, {w + 1.0, h + 1.0}, {-1, h + 1.0}}, 1, palette.middle(), 30));
    s.objects[1] = "field";
    return s;
}

// Two planes that meet at a crease, a third far behind them, and sky: seen in perspective, constant colours.
SynthSceneContents twoPlanes(int w, int h, uint32_t seed) {
    SynthSceneContents s;
    Palette palette(seed);
    s.camera = perspectiveCamera(w, h, 0.7);
    s.backgroundColor = dvec3(0.35, 0.55, 0.9);
    const auto add = [&](dvec3 corner, dvec3 along, dvec3 across, uint32_t id, const char* name, dvec3 color) {
        Polygon picture;
        for (const dvec3& p : {corner, corner + along, corner + along + across, corner + across}) {
            const glm::dvec4 clip = s.camera.projection * glm::dvec4(p, 1);
            picture.emplace_back((clip.x / clip.w + 1) / 2 * w, (1 - clip.y / clip.w) / 2 * h);
        }
        SynthShape shape;
        shape.region = picture;
        shape.object = id;
        shape.color = color;
        shape.normalView = glm::normalize(glm::cross(along, across));
        shape.distance = glm::dot(shape.normalView, corner);
        if (shape.distance > 0) {  // towards the camera, which sits in the origin
            shape.normalView = -shape.normalView;
            shape.distance = -shape.distance;
        }
        s.shapes.push_back(shape);
        s.objects[id] = name;
    };
    const dvec3 foot(-0.12, -0.62, -5), crease(0.21, 1.1, -0.15);
    add(foot, crease, dvec3(-1.0, 0.06, -1.2), 1, "left of the crease", palette.light());
    add(foot, crease, dvec3(0.75, -0.04, -1.5), 2, "right of the crease", palette.middle());
    add(dvec3(-2.2, -1.9, -8), dvec3(0.15, 2.6, -1.5), dvec3(5.2, 0.3, -0.8), 3, "behind", palette.dark());
    return s;
}
}  // namespace

const std::vector<SynthScene>& synthScenes() {
    static const std::vector<SynthScene> table = {
        {"half_plane", "one edge through the middle, at a chosen angle and offset"},
        {"half_planes", "one edge per tile, at 64 or more angles"},
        {"circles", "discs from 0.3 px in radius to a large part of a tile"},
        {"thin_lines", "lines of 0.2 to 2 px at many angles"},
        {"zone_plate", "rings up to the Nyquist limit and beyond"},
        {"moving", "shapes that translate and turn by fractions of a pixel over a striped wall"},
        {"two_planes", "a crease, a plane behind, sky; perspective, for the methods that read geometry"},
        {"clutter", "triangles and wires everywhere: one pixel in eight lies on an edge, for timing"},
        {"hairs", "strands of 0.3 to 2 px over each other, straight and curved, of any colour"},
        {"thin_motion", "wires that move before sky, field and poles"},
    };
    return table;
}

double zonePlateValue(dvec2 p, int w, int h) {
    const double r2 = (p.x - w / 2.0) * (p.x - w / 2.0) + (p.y - h / 2.0) * (p.y - h / 2.0);
    return 0.5 + 0.5 * std::cos(kPi * r2 / std::min(w, h));
}

SynthSceneContents makeScene(const SynthOptions& o) {
    const std::string& name = o.scene;
    const int w = o.width, h = o.height;
    const uint32_t seed = o.seed;
    const auto with = [&](SynthSceneContents s) {
        if (s.camera.projection == glm::dmat4(1.0)) s.camera = orthographicCamera(w, h, kUnitsPerPixel);
        return s;
    };
    if (name == "half_plane") return with(halfPlane(w, h, o.angleDegrees, o.offsetPx));
    if (name == "half_planes") return with(halfPlanes(w, h, seed));
    if (name == "circles") return with(circles(w, h, seed));
    if (name == "thin_lines") return with(thinLines(w, h, seed));
    if (name == "zone_plate") return with(zonePlate(w, h, seed));
    if (name == "moving") return with(moving(w, h, seed));
    if (name == "two_planes") return with(twoPlanes(w, h, seed));
    if (name == "clutter") return with(clutter(w, h, seed));
    if (name == "hairs") return with(hairs(w, h, seed));
    if (name == "thin_motion") return with(thinMotion(w, h, seed));
    std::string known;
    for (const auto& s : synthScenes()) known += (known.empty() ? "" : ", ") + std::string(s.name);
    throw UsageError("synth scene '" + name + "': expected one of " + known);
}

}  // namespace aa
