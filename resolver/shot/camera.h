// The camera of a frame: what turns world coordinates into pixels. Matrices are column-major with column vectors.
#pragma once
#include <glm/mat4x4.hpp>
#include <string>

namespace aa {

struct Camera {
    std::string kind = "perspective";  // or "orthographic", "panorama"
    glm::dmat4 view{1.0};              // world -> view, camera looks along -z, column vectors
    glm::dmat4 projection{1.0};        // view -> clip, y up, WITHOUT jitter
    double nearClip = 0.1, farClip = 100.0;
};

}  // namespace aa
