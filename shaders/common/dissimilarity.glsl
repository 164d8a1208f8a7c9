// How far apart two surface points are: depth, normal, or SADP, the sum of absolute dot products [Reshetov 2012].
//
// The vector between two points is formed from the difference of their depths, which is exact for close points, and
// from their distance on the image plane, never from the difference of two far positions: float keeps its direction at
// any distance from the camera.
//
// precise: what is compared must not depend on which products a driver fuses into sums.
#ifndef AA_DISSIMILARITY
#define AA_DISSIMILARITY
#include "image.glsl"

float dotInOrder(vec3 a, vec3 b) {
    precise float d = a.x * b.x + a.y * b.y + a.z * b.z;
    return d;
}

struct SurfacePoint {
    float depth;  // planar view z
    vec3 normal;  // world
};
// !(z < 1e9) is background: 1e10 by convention, and NaN.
bool isBackground(float depth) { return !(depth < 1e9); }
// A missing normal is zero or NaN; unit ones may carry the error of half floats.
bool hasNormal(vec3 n) { return dotInOrder(n, n) >= 0.25; }
vec3 validNormal(vec3 n) { return hasNormal(n) ? n : vec3(0.0); }

// World-space vector from a point a to a point b that lies some px beside it.
struct Separation {
    vec3 rayA;        // position of a per unit of depth, relative to the camera
    vec3 stepRay;     // change of the ray from a to b
    vec3 stepOrigin;  // the same for the depth-independent part; zero for a perspective camera
};
vec3 between(Separation s, float depthA, float depthB) {
    precise vec3 v = s.rayA * (depthB - depthA) + (s.stepRay * depthB + s.stepOrigin);
    return v;
}

// By number.
const int DISSIMILARITY_SADP = 0, DISSIMILARITY_DEPTH = 1, DISSIMILARITY_NORMAL = 2;
// SADP's largest value; what a surface and the background, or two objects, get.
const float FARTHEST = 2.0;

// In [0, 2]. Two background points are 0 apart, background and surface 2.
float dissimilarity(SurfacePoint a, SurfacePoint b, Separation s, int kind) {
    const bool emptyA = isBackground(a.depth), emptyB = isBackground(b.depth);
    if (emptyA || emptyB) return emptyA && emptyB ? 0.0 : FARTHEST;
    if (kind == DISSIMILARITY_DEPTH) return lesser(FARTHEST, abs(a.depth - b.depth) / lesser(a.depth, b.depth));
    const vec3 na = validNormal(a.normal), nb = validNormal(b.normal);
    precise float turned = 1.0 - dotInOrder(na, nb);
    if (kind == DISSIMILARITY_NORMAL) return turned;
    const vec3 v = between(s, a.depth, b.depth);
    const float length2 = dotInOrder(v, v);
    precise float limit = 1e-6 * greater(1.0, a.depth);
    precise float limit2 = limit * limit;
    if (!(length2 >= limit2)) return turned;  // no direction: the normals alone decide
    precise float along = (abs(dotInOrder(na, v)) + abs(dotInOrder(nb, v))) / sqrt(length2);
    return along + (hasNormal(na) && hasNormal(nb) ? 0.0 : 1.0);
}

// False only where dissimilarity() < limit, up to rounding, without its root and divisions: what most pixels of a
// picture need to know.
bool surfacesMayDiffer(SurfacePoint a, SurfacePoint b, Separation s, float limit, int kind) {
    const bool emptyA = isBackground(a.depth), emptyB = isBackground(b.depth);
    if (emptyA || emptyB) return !(emptyA && emptyB);
    if (kind == DISSIMILARITY_DEPTH) {
        precise float least = limit * lesser(a.depth, b.depth);
        return !(abs(a.depth - b.depth) < least);
    }
    if (kind == DISSIMILARITY_NORMAL) {
        precise float turned = 1.0 - dotInOrder(a.normal, b.normal);
        return !(turned < limit);
    }
    const vec3 v = between(s, a.depth, b.depth);
    const float length2 = dotInOrder(v, v);
    precise float along = abs(dotInOrder(a.normal, v)) + abs(dotInOrder(b.normal, v));
    precise float along2 = along * along;
    precise float most2 = limit * limit * length2;
    precise float coincident = 1e-6 * greater(1.0, a.depth);
    precise float coincident2 = coincident * coincident;
    return !(along2 < most2 && length2 >= coincident2 && hasNormal(a.normal) && hasNormal(b.normal));
}

// Whether two points belong to one surface [Salvi 2012]: their normals agree and one lies near the other's tangent
// plane. Two backgrounds are one surface. Without normals on both sides only the depths are compared.
const float SAME_SURFACE_COSINE = 0.95, SAME_SURFACE_DISTANCE = 0.01;  // the latter relative to the depth
bool sameSurface(SurfacePoint a, SurfacePoint b, Separation s, float leastCosine, float mostDistance) {
    const bool emptyA = isBackground(a.depth), emptyB = isBackground(b.depth);
    if (emptyA || emptyB) return emptyA && emptyB;
    precise float tolerance = mostDistance * a.depth;
    if (dotInOrder(a.normal, b.normal) >= leastCosine &&
        abs(dotInOrder(a.normal, between(s, a.depth, b.depth))) <= tolerance)
        return true;
    return !(hasNormal(a.normal) || hasNormal(b.normal)) && abs(a.depth - b.depth) <= tolerance;
}

#endif
