// What a sample at one position of one frame of a synthetic scene sees.
#pragma once
#include <glm/mat3x3.hpp>
#include <map>

#include "image/plane.h"
#include "shot/synth/placed.h"
#include "shot/synth/scenes.h"

namespace aa {

// Bit i of SynthShape::seams.
inline bool isSeam(const SynthShape& shape, size_t edge) { return edge < 32 && (shape.seams >> edge & 1); }
// Signed distance along its major axis from p to the line of the shape's nearest edge (conventions 3).
glm::dvec2 nearestEdgePx(const Placed& placed, glm::dvec2 p);

inline void put(Rgb& to, int x, int y, glm::dvec3 v) {
    for (int c = 0; c < 3; c++) to.c[size_t(c)].at(x, y) = float(v[c]);
}

class Sampler {
  public:
    // All shapes moved by `shiftView` in view space.
    Sampler(const SynthSceneContents& scene, int width, int height, double time,
            glm::dvec3 shiftView = glm::dvec3(0.0));

    glm::dvec3 color(const Placed* hit, glm::dvec2 p) const;
    float depth(const Placed* hit, glm::dvec2 p) const;
    glm::dvec3 normal(const Placed* hit) const { return hit ? toWorld_ * hit->shape->normalView : glm::dvec3(0.0); }
    static uint32_t object(const Placed* hit) { return hit ? hit->shape->object : 0; }
    glm::dvec2 motionPx(const Placed* hit, glm::dvec2 p) const;

  private:
    const SynthSceneContents& scene_;
    glm::dvec3 shiftView_;
    int width_, height_;
    double time_;
    bool isPerspective_;
    glm::dmat3 toWorld_;
};

}  // namespace aa
