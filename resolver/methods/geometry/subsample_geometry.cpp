#include "methods/geometry/subsample_geometry.h"

#include <glm/matrix.hpp>

#include "image/error.h"

namespace aa {
namespace {
Vec3d array(glm::dvec3 v) { return {v.x, v.y, v.z}; }
}  // namespace

CameraRays cameraRays(const Frame& frame, std::string_view reader) {
    const std::string where = std::string(reader) + ": frame " + std::to_string(frame.number);
    if (!frame.camera)
        throw InputError(where + " has no camera in the manifest; expected its view and projection matrices");
    const Camera& c = *frame.camera;
    if (c.kind != "perspective" && c.kind != "orthographic")
        throw InputError(where + ": the camera is '" + c.kind + "'; expected perspective or orthographic");
    // clip = P (X, Y, -z, 1) with w = a z + b, so NDC n gives P_row (X, Y, -z, 1) = n (a z + b): for x and y a pair of
    // linear equations in X and Y whose right-hand side is linear in z and n.
    const glm::dmat4& p = c.projection;  // p[column][row]
    const glm::dmat2 solve = glm::inverse(glm::dmat2(p[0][0], p[0][1], p[1][0], p[1][1]));
    const double a = -p[2][3], b = p[3][3];
    // NDC of pixel position (x, y): (2x / W - 1, 1 - 2y / H).
    const glm::dvec2 ndc0(-1, 1), ndcX(2.0 / frame.width, 0), ndcY(0, -2.0 / frame.height);
    const auto perDepth = [&](glm::dvec2 n, double constant) {
        const glm::dvec2 xy = solve * (n * a + constant * glm::dvec2(p[2][0], p[2][1]));
        return glm::dvec3(xy, -constant);
    };
    const auto free = [&](glm::dvec2 n, double constant) {
        return glm::dvec3(solve * (n * b - constant * glm::dvec2(p[3][0], p[3][1])), 0.0);
    };
    const glm::dmat3 toWorld = glm::inverse(glm::dmat3(c.view));
    CameraRays r;
    r.ray = array(toWorld * perDepth(ndc0, 1)), r.rayX = array(toWorld * perDepth(ndcX, 0));
    r.rayY = array(toWorld * perDepth(ndcY, 0));
    r.origin = array(toWorld * free(ndc0, 1)), r.originX = array(toWorld * free(ndcX, 0));
    r.originY = array(toWorld * free(ndcY, 0));
    return r;
}

PassSet GeometryNeeds::passes() const {
    PassSet all;
    if (depth) all |= Pass::depth | Pass::subsampleDepth;
    if (normals) all |= Pass::normal | Pass::subsampleNormal;
    if (ids) all |= Pass::object | Pass::subsampleObject;
    if (colors) all |= Pass::subsampleColor;
    return all;
}

GeometryViews::GeometryViews(const Frame& frame, GeometryNeeds needs, std::string_view reader) {
    args_.stride = paddedStride(frame.width), args_.width = frame.width, args_.height = frame.height;
    if (needs.depth) args_.depthView = frame.depthView.row(0);
    if (needs.normals) args_.normalWorld = view(frame.normalWorld);
    if (needs.ids) args_.objectId = frame.objectId.row(0);
    if (needs.camera) {
        const CameraRays rays = cameraRays(frame, reader);
        const glm::dvec2 first = frame.jitterPx + 0.5;  // centre sample of pixel (0, 0)
        for (size_t i = 0; i < 3; i++) {
            args_.ray[i] = float(rays.ray[i] + first.x * rays.rayX[i] + first.y * rays.rayY[i]);
            args_.rayX[i] = float(rays.rayX[i]), args_.rayY[i] = float(rays.rayY[i]);
            args_.originX[i] = float(rays.originX[i]), args_.originY[i] = float(rays.originY[i]);
        }
    }
    for (size_t k = 0; k < frame.subSamples.size(); k++) {
        const SubSample& s = frame.subSamples[k];
        const glm::dvec2 offsetPx = frame.subSamplePositionsPx[k];
        samples_.push_back({needs.depth ? s.depthView.row(0) : nullptr,
                            needs.normals ? view(s.normalWorld) : RgbIn{},
                            needs.ids ? s.objectId.row(0) : nullptr,
                            needs.colors ? view(s.colorLinear) : RgbIn{},
                            {float(offsetPx.x), float(offsetPx.y)}});
    }
    args_.sample = samples_.data(), args_.samples = int(samples_.size());
}

void requireSubSamples(const std::vector<glm::dvec2>& positionsPx, std::string_view method, size_t most) {
    const std::string name(method);
    if (positionsPx.empty())
        throw InputError(name + ": reads sub-samples, and the shot's manifest lists no sub-sample positions; export " +
                         "the shot for " + name);
    if (positionsPx.size() > most)
        throw InputError(name + ": expected at most " + std::to_string(most) + " sub-samples per pixel, found " +
                         std::to_string(positionsPx.size()) + "; export the shot with a smaller pattern");
}

}  // namespace aa
