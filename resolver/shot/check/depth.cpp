#include "shot/check/depth.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace aa {
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

namespace {
constexpr size_t kFewest = 100;  // samples that a median needs
constexpr size_t kSamplesPerFrame = 20000;
constexpr double kRangeSlack = 1e-4;  // relative; float32 and the renderer's own rounding
constexpr double kScaleTolerance = 5e-3;
constexpr double kLeastOffAxis = 0.08;  // tangent of the view angle: nearer to the axis ray length and z are the same
constexpr float kBackground = 1e9f;

// Maps samples to view space: P = z * ray for a perspective camera, (ray.xy, -z) for an orthographic one.
class Unprojection {
  public:
    Unprojection(const Camera& c, const Frame& f)
        : m_(c.projection),
          width_(f.width),
          height_(f.height),
          perspective_(c.kind == "perspective"),
          jitter_(f.jitterPx) {}
    bool perspective() const { return perspective_; }
    dvec2 ray(double x, double y) const {
        const dvec2 ndc(2 * (x + 0.5 + jitter_.x) / width_ - 1, 1 - 2 * (y + 0.5 + jitter_.y) / height_);
        const double sign = perspective_ ? 1 : -1;
        const int column = perspective_ ? 2 : 3;
        return {(ndc.x + sign * m_[column][0]) / m_[0][0], (ndc.y + sign * m_[column][1]) / m_[1][1]};
    }
    dvec3 point(dvec2 ray, double z) const { return perspective_ ? dvec3(ray * z, -z) : dvec3(ray, -z); }

  private:
    glm::dmat4 m_;
    int width_, height_;
    bool perspective_;
    dvec2 jitter_;
};

double median(std::vector<float> v) {
    const auto middle = v.begin() + ptrdiff_t(v.size() / 2);
    std::nth_element(v.begin(), middle, v.end());
    return *middle;
}
// Half of the values lie this close around the median.
double spread(const std::vector<float>& v, double centre) {
    std::vector<float> d;
    for (const float x : v) d.push_back(float(std::abs(x - centre)));
    return median(d);
}
int strideFor(const Frame& f) {
    return std::max(1, int(std::sqrt(double(f.width) * f.height / double(kSamplesPerFrame))));
}
dvec3 normalAt(const Frame& f, int x, int y) {
    return {f.normalWorld.c[0].at(x, y), f.normalWorld.c[1].at(x, y), f.normalWorld.c[2].at(x, y)};
}
std::string number(double v) {
    char text[32];
    std::snprintf(text, sizeof text, "%.5g", v);
    return text;
}
}  // namespace

void DepthCheck::add(const Frame& frame, const FrameEntry& entry, CheckReport& report) {
    addRange(frame, entry, report);
    addBounds(frame, entry, report);
    if (frame.camera && frame.camera->kind != "panorama" && !frame.normalWorld.empty()) addPlanarity(frame);
    if (!frame.subSamples.empty() && !frame.subSamples[0].depthView.empty()) addSubSamples(frame);
}

void DepthCheck::addRange(const Frame& f, const FrameEntry& entry, CheckReport& report) {
    if (rangeFound_) return;
    const bool known = f.camera && f.camera->kind != "panorama";
    const double lo = known ? f.camera->nearClip * (1 - kRangeSlack) : 0,
                 hi = known ? f.camera->farClip * (1 + kRangeSlack) : 1e9;
    uint64_t outside = 0, disagree = 0;
    glm::ivec2 firstOutside, firstDisagree;
    for (int y = 0; y < f.height; y++)
        for (int x = 0; x < f.width; x++) {
            const float z = f.depthView.at(x, y);
            if (!std::isfinite(z)) continue;  // counted with the numbers
            if (!(z > 0) || (z < kBackground && !(z >= lo && z <= hi)))
                if (outside++ == 0) firstOutside = {x, y};
            if (!f.objectId.empty() && (f.objectId.at(x, y) == 0) != (z >= kBackground))
                if (disagree++ == 0) firstDisagree = {x, y};
        }
    if (outside) {
        report.findings.push_back({"depth", entry.frame, "Z", firstOutside,
                                   known ? "view-space z within near..far of the camera, " +
                                               number(f.camera->nearClip) + ".." + number(f.camera->farClip)
                                         : "z > 0",
                                   number(f.depthView.at(firstOutside.x, firstOutside.y)),
                                   "write planar view-space z in the camera's unit; background 1e10", outside});
        rangeFound_ = true;
    }
    if (disagree) {
        report.findings.push_back({"object", entry.frame, "id", firstDisagree,
                                   "id 0 exactly where depth is background (1e10)",
                                   "id " + std::to_string(f.objectId.at(firstDisagree.x, firstDisagree.y)) +
                                       " at depth " + number(f.depthView.at(firstDisagree.x, firstDisagree.y)),
                                   "give every object an id > 0 and leave 0 to the background", disagree});
        rangeFound_ = true;
    }
}

// "depth_bounds": {"ID": [nearest, farthest]} of the frame's entry: planar z of each object's geometry.
void DepthCheck::addBounds(const Frame& f, const FrameEntry& entry, CheckReport& report) {
    if (boundsFound_ || entry.extra.empty() || f.objectId.empty()) return;
    const nlohmann::json extra = nlohmann::json::parse(entry.extra);
    const auto bounds = extra.find("depth_bounds");
    if (bounds == extra.end() || !bounds->is_object()) return;
    std::map<uint32_t, std::pair<double, double>> range;
    for (const auto& [name, value] : bounds->items())
        if (const auto id = objectIdIn(name);
            id && value.is_array() && value.size() == 2 && value[0].is_number() && value[1].is_number())
            range[*id] = {value[0].get<double>(), value[1].get<double>()};
    boundsSeen_ = boundsSeen_ || !range.empty();
    uint64_t outside = 0;
    glm::ivec2 first;
    for (int y = 0; y < f.height; y++)
        for (int x = 0; x < f.width; x++) {
            const float z = f.depthView.at(x, y);
            const auto it = range.find(f.objectId.at(x, y));
            if (it == range.end() || !(z < kBackground)) continue;
            if (!(z >= it->second.first * (1 - kRangeSlack) && z <= it->second.second * (1 + kRangeSlack)) &&
                outside++ == 0)
                first = {x, y};
        }
    if (!outside) return;
    const auto [lo, hi] = range[f.objectId.at(first.x, first.y)];
    report.findings.push_back({"depth", entry.frame, "Z", first,
                               "z of object " + std::to_string(f.objectId.at(first.x, first.y)) + " within " +
                                   number(lo) + ".." + number(hi) + " (depth_bounds)",
                               number(f.depthView.at(first.x, first.y)),
                               "write planar view-space z in the camera's unit", outside});
    boundsFound_ = true;
}

void DepthCheck::addPlanarity(const Frame& f) {
    const Unprojection camera(*f.camera, f);
    const glm::dmat3 toView(f.camera->view);
    const int stride = strideFor(f);
    for (int y = 0; y + 1 < f.height; y += stride)
        for (int x = 0; x + 1 < f.width; x += stride)
            for (const glm::ivec2 step : {glm::ivec2(1, 0), glm::ivec2(0, 1)}) {
                const int x1 = x + step.x, y1 = y + step.y;
                const float z0 = f.depthView.at(x, y), z1 = f.depthView.at(x1, y1);
                if (!(z0 > 0 && z0 < kBackground && z1 > 0 && z1 < kBackground)) continue;
                if (!f.objectId.empty() && f.objectId.at(x, y) != f.objectId.at(x1, y1)) continue;
                const dvec3 n = normalAt(f, x, y);
                if (!(std::abs(glm::length(n) - 1) < 2e-3) || !(glm::length(n - normalAt(f, x1, y1)) < 1e-5)) continue;
                const dvec2 r0 = camera.ray(x, y), r1 = camera.ray(x1, y1);
                if (camera.perspective() && glm::length(r0) < kLeastOffAxis) continue;
                const auto slope = [&](dvec3 normal, double a, double b) {
                    const dvec3 d = camera.point(r1, b) - camera.point(r0, a);
                    return float(std::abs(glm::dot(normal, d)) / glm::length(d));
                };
                const dvec3 view = toView * n;
                if (std::abs(view.z) < 0.1) continue;  // grazing: float32 depth has no digits left for the slope
                const auto planar = [](double length, dvec2 r) { return length / std::sqrt(1 + glm::dot(r, r)); };
                slopes_.stated.push_back(slope(view, z0, z1));
                slopes_.viewNormals.push_back(slope(n, z0, z1));
                if (camera.perspective()) {
                    slopes_.rayLength.push_back(slope(view, planar(z0, r0), planar(z1, r1)));
                } else {
                    const double across = glm::dot(dvec2(view), r1 - r0), rise = view.z * (double(z1) - double(z0));
                    if (std::abs(across) > 0.05 * glm::length(r1 - r0))
                        orthographicScale_.push_back(float(rise / across));
                }
            }
}

void DepthCheck::addSubSamples(const Frame& f) {
    if (f.objectId.empty()) return;
    const int stride = strideFor(f);
    for (int y = 0; y < f.height; y += stride)
        for (int x = 0; x < f.width; x += stride) {
            double sum = 0;
            bool same = f.depthView.at(x, y) < kBackground;
            for (const auto& s : f.subSamples) {
                same = same && s.objectId.at(x, y) == f.objectId.at(x, y) && s.depthView.at(x, y) < kBackground;
                sum += s.depthView.at(x, y);
            }
            if (same) subSampleScale_.push_back(float(f.depthView.at(x, y) / (sum / double(f.subSamples.size()))));
        }
}

// A resting surface seen by a moving camera: the depth that makes its motion what it is, in closed form.
void DepthCheck::addMotion(const Frame& f) {
    if (!f.camera || !f.previousCamera || f.camera->kind != "perspective" || f.previousCamera->kind != "perspective")
        return;
    if (f.camera->view == f.previousCamera->view) return;
    const Unprojection camera(*f.camera, f);
    const glm::dmat4 toPrevious = f.previousCamera->projection * f.previousCamera->view * glm::inverse(f.camera->view);
    const int stride = strideFor(f);
    for (int y = 0; y < f.height; y += stride)
        for (int x = 0; x < f.width; x += stride) {
            const float z = f.depthView.at(x, y);
            if (!(z > 0 && z < kBackground)) continue;
            const dvec2 p = dvec2(x + 0.5, y + 0.5) + f.jitterPx,
                        q = p - dvec2(f.motionXPx.at(x, y), f.motionYPx.at(x, y));
            const dvec2 ndc(2 * q.x / f.width - 1, 1 - 2 * q.y / f.height);
            if (!(std::abs(ndc.x) < 1 && std::abs(ndc.y) < 1)) continue;
            // clip = z a + b with b from the camera's own movement; ndc = clip.xy / clip.w, solved for z.
            const dvec4 a = toPrevious * dvec4(camera.ray(x, y), -1, 0), b = toPrevious[3];
            const dvec2 slope(a.x - ndc.x * a.w, a.y - ndc.y * a.w), offset(ndc.x * b.w - b.x, ndc.y * b.w - b.y);
            const dvec2 parallaxPx = dvec2(f.width, f.height) * 0.5 * (dvec2(a) / a.w - ndc);
            if (!(glm::length(parallaxPx) > 1)) continue;
            const double explained = glm::dot(slope, offset) / glm::dot(slope, slope);
            // Off the epipolar line: the object moves by itself.
            if (!(explained > 0) || glm::length(slope * explained - offset) > 0.02 * glm::length(offset)) continue;
            parallaxScale_.push_back(float(z / explained));
        }
}

void DepthCheck::judge(CheckReport& report) const {
    const auto finding = [&](const char* check, const char* channel, const std::string& expected,
                             const std::string& found, const std::string& advice) {
        report.findings.push_back({check, std::nullopt, channel, std::nullopt, expected, found, advice, 0});
    };
    if (slopes_.stated.size() >= kFewest) {
        const double stated = median(slopes_.stated), view = median(slopes_.viewNormals);
        const double ray = slopes_.rayLength.size() >= kFewest ? median(slopes_.rayLength) : INFINITY;
        report.measured.push_back({"depth.slopeAgainstNormal", stated});
        if (ray < 0.3 * stated && stated > 1e-3)
            finding("depth", "Z", "planar z: flat surfaces stay flat",
                    "the distance along the ray (slope against the normals " + number(stated) + "; as ray length " +
                        number(ray) + ")",
                    "multiply by the cosine of the view angle: write z along the view axis");
        else if (view < 0.3 * stated && stated > 1e-3)
            finding("normal", "N.X N.Y N.Z", "world-space normals",
                    "normals of view space (slope against the surface " + number(stated) + "; as view space " +
                        number(view) + ")",
                    "rotate them to world space by the transpose of the view matrix");
        else if (stated > 0.02 && orthographicScale_.size() < kFewest)
            finding("depth", "Z", "surfaces perpendicular to their normals (slope about 0)", "slope " + number(stated),
                    "check depth, normals and the camera's matrices");
    } else
        report.notChecked.push_back("planarity of depth: fewer than 100 flat pixel pairs with normals and a camera");
    const auto scale = [&](const std::vector<float>& ratios, const char* evidence) {
        if (ratios.size() < kFewest) return false;
        const double s = median(ratios), width = spread(ratios, s);
        report.measured.push_back({std::string("depth.scale.") + evidence, s});
        if (std::abs(s - 1) <= kScaleTolerance + 3 * width / std::sqrt(double(ratios.size())) ||
            width > 0.3 * std::abs(s))
            return true;
        finding("depth", "Z", "depth in the unit of the camera", number(s) + " times as deep (by the " + evidence + ")",
                "divide depth by that factor");
        return true;
    };
    // A scaled depth shows once; the first evidence is enough.
    const size_t before = report.findings.size();
    bool known = scale(orthographicScale_, "slopes");
    if (report.findings.size() == before) known = scale(subSampleScale_, "subsamples") || known;
    if (report.findings.size() == before) known = scale(parallaxScale_, "parallax") || known;
    if (!known)
        report.notChecked.emplace_back(
            boundsSeen_
                ? "scale of depth beyond near..far and depth_bounds: through a resting perspective camera a scaled "
                  "depth looks the same"
                : "scale of depth beyond near..far: through a resting perspective camera a scaled depth looks the "
                  "same; a moving camera, sub-samples, depth_bounds in shot.json, or slanted surfaces seen "
                  "orthographically would show it");
}

}  // namespace aa
