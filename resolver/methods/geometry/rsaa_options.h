// What rsaa's parameters say, and its tables.
#pragma once
#include <glm/vec2.hpp>
#include <vector>

#include "methods/geometry/rsaa.h"
#include "methods/geometry/rsaa_learn.h"
#include "methods/geometry/subsample_geometry.h"

namespace aa {
class Params;

struct RsaaOptions {
    Dissimilarity measure;
    float floor;
    bool adaptive, tuning, tuneAdaptive, quadrant, ids;
    bool maskPass;  // the masks are read, not computed
    RsaaTraining training;

    explicit RsaaOptions(const Params& params);
    bool readsGeometry() const { return !maskPass || tuning; }
    GeometryNeeds needs() const {
        if (!readsGeometry()) return {.depth = false};
        return {.normals = measure != Dissimilarity::depth, .ids = ids, .camera = measure == Dissimilarity::sadp};
    }
};
// u, v in px for each of the 2^samples masks: shipped or learned now.
std::vector<float> rsaaOffsets(const std::vector<glm::dvec2>& positionsPx, RsaaTraining training);
// The pixels that are asked for the surface of a sub-sample that lies there. quadrant: all three on its side, which are
// those that a fetch toward it blends. Otherwise the nearest of the eight; on a tie one across an edge rather than one
// across a corner.
RsaaNeighbours rsaaNeighbours(glm::vec2 offsetPx, bool quadrant);

}  // namespace aa
