#include "shot/import/blender_motion.h"

#include <algorithm>
#include <glm/matrix.hpp>
#include <vector>

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
// Middle distance of the vectors from those of a scene that rests, if the previous position was seen through
// `previousLens`. Of objects that move, most move less than a lens shifts the whole picture; else the median errs.
double distanceFromRest(const PlaneF& x, const PlaneF& y, const PlaneF& depthView, dvec2 jitterPx, const Camera& now,
                        const Camera& before, dvec2 previousLens) {
    const dvec2 size(x.width(), x.height());
    const glm::dmat4 toBefore = before.view * glm::inverse(now.view);
    std::vector<double> distances;
    for (int j = 0; j < x.height(); j++)
        for (int i = 0; i < x.width(); i++) {
            const double z = depthView.at(i, j);
            if (!(z < 1e9)) continue;
            const dvec2 p = dvec2(i + 0.5, j + 0.5) + jitterPx;
            const dvec2 ray = (dvec2(2 * p.x / size.x - 1, 1 - 2 * p.y / size.y) + centreOf(now).offset) / scaleOf(now);
            const dvec3 point = dvec3(toBefore * glm::dvec4(ray * z, -z, 1.0));
            if (!(-point.z > 1e-9)) continue;
            const dvec2 ndc = dvec2(point) / -point.z * previousLens - centreOf(now).offset;
            const dvec2 rests = dvec2((ndc.x + 1) * 0.5 * size.x, (1 - ndc.y) * 0.5 * size.y) - p;
            distances.push_back(glm::length(dvec2(x.at(i, j), -y.at(i, j)) - rests));
        }
    if (distances.empty()) return 0;
    const auto middle = distances.begin() + std::ptrdiff_t(distances.size() / 2);
    std::ranges::nth_element(distances, middle);
    return *middle;
}

// The lens that the vectors' previous position was seen through.
dvec2 lensOfVectors(const PlaneF& x, const PlaneF& y, const PlaneF& depthView, dvec2 jitterPx, const Camera& now,
                    const Camera& before) {
    const dvec2 present = scaleOf(now), previous = scaleOf(before);
    if (!perspective(now) || present == previous || depthView.empty()) return present;
    const auto distance = [&](dvec2 lens) { return distanceFromRest(x, y, depthView, jitterPx, now, before, lens); };
    return distance(previous) < distance(present) ? previous : present;
}
}  // namespace

void motionFromVector(PlaneF& x, PlaneF& y, const PlaneF& depthView, dvec2 jitterPx, const std::optional<Camera>& now,
                      const std::optional<Camera>& before) {
    const dvec2 size(x.width(), x.height());
    const bool matrices = now && before && now->kind != "panorama" && before->kind == now->kind;
    const bool zooms = matrices && now->projection != before->projection;
    const dvec2 lens = zooms ? lensOfVectors(x, y, depthView, jitterPx, *now, *before) : dvec2(1.0);
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
                const dvec2 direction = (ndc + a.sign * a.offset) / lens;
                const dvec2 previous = direction * scaleOf(*before) - b.sign * b.offset;
                motion = p - dvec2((previous.x + 1) * 0.5 * size.x, (1 - previous.y) * 0.5 * size.y);
            }
            x.at(i, j) = float(motion.x) + 0.0f;  // no negative zeros
            y.at(i, j) = float(motion.y) + 0.0f;
        }
}

}  // namespace aa
