// Motion from Blender's Vector pass.
//
// Vector.X, .Y = position in the previous frame - position now, px, y UP; 0 on the background (Blender 5.2 writes some
// motion there); not affected by jitter (the shift of the camera). Both positions are seen through the CURRENT
// projection, but in Blender 4.3 and 5.2 the previous one through the previous LENS; nothing in the file of 4.3 tells
// which, so the vectors are asked: what rests in the scene moves as its depth and the matrices say. Motion is current -
// previous, y down. With the matrices of both frames two gaps close: a change of lens, orthographic scale or shift that
// the pass leaves out (the previous position is taken back to a direction and projected with the previous camera), and
// the background, a direction at infinity that only the rotation moves. The same arithmetic as the exporter's
// (passes/motion.py), which keeps its cameras from the difference.
#pragma once
#include "shot/frame.h"

namespace aa {

// Turns vectors (as read) in place to motion. `depthView` may be empty: then no pixel is background, and a lens that
// changes is taken to be left out.
void motionFromVector(PlaneF& x, PlaneF& y, const PlaneF& depthView, glm::dvec2 jitterPx,
                      const std::optional<Camera>& now, const std::optional<Camera>& before);

}  // namespace aa
