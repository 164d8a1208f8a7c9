// The scenes of synth: which shapes lie where. Rendering is synth.cpp's.
#pragma once
#include "shot/synth/synth.h"

namespace aa {

struct SynthSceneContents {
    std::vector<SynthShape> shapes;  // front to back
    std::map<uint32_t, std::string> objects;
    glm::dvec3 backgroundColor{0.0};
    Camera camera;
    bool isStatic = true;
    bool zonePlate = false;
};
// Throws UsageError for an unknown scene.
SynthSceneContents makeScene(const SynthOptions& options);

// The picture maps to the plane of an orthographic camera at this scale, and the camera looks from z = 0.
inline constexpr double kUnitsPerPixel = 0.02;
// Radial frequency of the zone plate: the phase pi r^2 / (W or H) reaches the Nyquist limit at the nearer border.
double zonePlateValue(glm::dvec2 positionPx, int width, int height);

}  // namespace aa
