// Motion from Blender's Vector pass.
//
// Vector.X, .Y = position in the previous frame - position now, px, y UP, both seen through the CURRENT projection; 0
// on the background; not affected by jitter (the shift of the camera). Motion is current - previous, y down. With the
// matrices of both frames two gaps close: a change of lens, orthographic scale or shift, which the pass leaves out
// (the previous position is taken back to a direction and projected with the previous camera), and the background,
// a direction at infinity that only the rotation moves. The same arithmetic as the exporter's (camera.py).
#pragma once
#include "shot/frame.h"

namespace aa {

// Turns vectors (as read) in place to motion. `depthView` may be empty: then no pixel is background.
void motionFromVector(PlaneF& x, PlaneF& y, const PlaneF& depthView, glm::dvec2 jitterPx,
                      const std::optional<Camera>& now, const std::optional<Camera>& before);

}  // namespace aa
