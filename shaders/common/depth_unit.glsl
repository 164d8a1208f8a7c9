// Depth in the unit of a method's thresholds, background taken as the far plane.
#ifndef AA_DEPTH_UNIT
#define AA_DEPTH_UNIT
#include "image.glsl"

// By number: 2 z / (z + far); z / far; z, scene units. `depth` is planar view z > 0.
const int DEPTH_NORMALISED = 0, DEPTH_ZFAR = 1, DEPTH_WORLD = 2;
float inDepthUnit(float depth, float farDepth, int unit) {
    const float z = lesser(farDepth, depth);
    if (unit == DEPTH_WORLD) return z;
    return unit == DEPTH_ZFAR ? z * (1.0 / farDepth) : (z + z) / (z + farDepth);
}

#endif
