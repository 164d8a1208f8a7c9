#include "shot/import/blender_motion.h"

#include <glm/matrix.hpp>

namespace aa {
using glm::dvec2;
using glm::dvec3;

namespace {
bool perspective(const Camera& c) { return c.kind == "perspective"; }
// x of the projection's centre and its sign: a perspective camera shifts with z, an orthographic one by a constant.
struct Centre {
    dvec2 offset;
    double sign;
};
Centre centreOf(const Camera& c) {
    const int column = perspective(c) ? 2 : 3;
    return {{c.projection[column][0], c.projection[column][1]}, perspective(c) ? 1.0 : -1.0};
}
dvec2 scaleOf(const Camera& c) { return {c.projection[0][0], c.projection[1][1]}; }

// Motion of what lies infinitely far away in the direction of position p.
dvec2 backgroundMotion(dvec2 p, dvec2 size, const Camera& now, const Camera& before) {
    if (!perspective(now) || !perspective(before) || (now.view == before.view && now.projection == before.projection))
        return dvec2(0.0);
    const dvec2 ndc(2 * p.x / size.x - 1, 1 - 2 * p.y / size.y);
    const dvec2 ray = (ndc + centreOf(now).offset) / scaleOf(now);
    const dvec3 turned = glm::dmat3(before.view) * glm::transpose(glm::dmat3(now.view)) * dvec3(ray, -1.0);
    if (!(-turned.z > 1e-9)) return dvec2(kInvalidMotionPx);  // behind the previous camera
    const dvec2 previous = dvec2(turned) / -turned.z * scaleOf(before) - centreOf(before).offset;
    return p - dvec2((previous.x + 1) * 0.5 * size.x, (1 - previous.y) * 0.5 * size.y);
}
}  // namespace

void motionFromVector(PlaneF& x, PlaneF& y, const PlaneF& depthView, dvec2 jitterPx, const std::optional<Camera>& now,
                      const std::optional<Camera>& before) {
    const dvec2 size(x.width(), x.height());
    const bool matrices = now && before && now->kind != "panorama" && before->kind == now->kind;
    const bool zooms = matrices && now->projection != before->projection;
    for (int j = 0; j < x.height(); j++)
        for (int i = 0; i < x.width(); i++) {
            const dvec2 p = dvec2(i + 0.5, j + 0.5) + jitterPx, vector(x.at(i, j), y.at(i, j));
            dvec2 motion(-vector.x, vector.y);
            if (matrices && !depthView.empty() && depthView.at(i, j) >= 1e9f) {
                motion = backgroundMotion(p, size, *now, *before);
            } else if (zooms) {
                const dvec2 seen(p.x + vector.x, p.y - vector.y);
                const dvec2 ndc(2 * seen.x / size.x - 1, 1 - 2 * seen.y / size.y);
                const Centre a = centreOf(*now), b = centreOf(*before);
                const dvec2 direction = (ndc + a.sign * a.offset) / scaleOf(*now);
                const dvec2 previous = direction * scaleOf(*before) - b.sign * b.offset;
                motion = p - dvec2((previous.x + 1) * 0.5 * size.x, (1 - previous.y) * 0.5 * size.y);
            }
            x.at(i, j) = float(motion.x) + 0.0f;  // no negative zeros
            y.at(i, j) = float(motion.y) + 0.0f;
        }
}

}  // namespace aa
