#include "shot/synth/sampler.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "shot/frame.h"

namespace aa {
using glm::dvec2;
using glm::dvec3;

dvec2 nearestEdgePx(const Placed& placed, dvec2 p) {
    const auto& polygon = std::get<Polygon>(placed.region);
    double nearest = INFINITY;
    dvec2 r(0.5);
    for (size_t i = 0; i < polygon.size(); i++) {
        const dvec2 a = polygon[i], d = polygon[(i + 1) % polygon.size()] - a;
        if (d == dvec2(0.0) || isSeam(*placed.shape, i)) continue;
        const dvec2 n(-d.y, d.x);
        const bool alongX = std::abs(n.x) > std::abs(n.y);
        const double s = glm::dot(a - p, n) / (alongX ? n.x : n.y);
        if (!(std::abs(s) < nearest)) continue;
        nearest = std::abs(s);
        r = alongX ? dvec2(s, 0.5) : dvec2(0.5, s);
    }
    return r;
}

Sampler::Sampler(const SynthSceneContents& scene, int width, int height, double time, dvec3 shiftView)
    : scene_(scene),
      shiftView_(shiftView),
      width_(width),
      height_(height),
      time_(time),
      isPerspective_(scene.camera.kind == "perspective"),
      toWorld_(glm::transpose(glm::dmat3(scene.camera.view))) {}

dvec3 Sampler::color(const Placed* hit, dvec2 p) const {
    if (scene_.zonePlate) return dvec3(zonePlateValue(p, width_, height_));
    return hit ? hit->shape->color : scene_.backgroundColor;
}

float Sampler::depth(const Placed* hit, dvec2 p) const {
    if (!hit) return kBackgroundDepth;
    const SynthShape& s = *hit->shape;
    const glm::dmat4& m = scene_.camera.projection;
    const dvec2 ndc(2 * p.x / width_ - 1, 1 - 2 * p.y / height_);
    const dvec2 ray(ndc.x / m[0][0], ndc.y / m[1][1]);  // both cameras are centred
    const dvec3 n = s.normalView;
    const double distance = s.distance + glm::dot(n, shiftView_);
    return float(isPerspective_ ? distance / (n.x * ray.x + n.y * ray.y - n.z)
                                : (n.x * ray.x + n.y * ray.y - distance) / n.z);
}

dvec2 Sampler::motionPx(const Placed* hit, dvec2 p) const {
    if (!hit || hit->shape->motion.rests()) return dvec2(0.0);
    const RigidMotion& m = hit->shape->motion;
    return p - m.apply(m.invert(p, time_), time_ - 1);
}

}  // namespace aa
