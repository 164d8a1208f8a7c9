// What the FXAA variants share: the edge that a pixel lies on, the ends of that edge, and the shift across it.
//
//   binding                format   holds
//   2  lumaImage  texture  R 32F    a luma per pixel (spatial/luma.comp)
//
// Every luma enters as its difference from the pixel's own or its neighbour's: floats that are near each other subtract
// without rounding, so that the comparisons that are exact ties on clean edges are ties here too.
#ifndef AA_FXAA
#define AA_FXAA
#include "spatial.glsl"

layout(binding = 2) uniform sampler2D lumaImage;

float lumaAt(ivec2 p) { return texel(lumaImage, p).r; }

struct Neighbourhood {  // of lumas
    float m, n, s, w, e, nw, ne, sw, se;
};
Neighbourhood crossOf(ivec2 p) {  // without the diagonals
    Neighbourhood l;
    l.m = lumaAt(p);
    l.n = lumaAt(p + ivec2(0, -1));
    l.s = lumaAt(p + ivec2(0, 1));
    l.w = lumaAt(p + ivec2(-1, 0));
    l.e = lumaAt(p + ivec2(1, 0));
    return l;
}
void addDiagonals(ivec2 p, inout Neighbourhood l) {
    l.nw = lumaAt(p + ivec2(-1, -1));
    l.ne = lumaAt(p + ivec2(1, -1));
    l.sw = lumaAt(p + ivec2(-1, 1));
    l.se = lumaAt(p + ivec2(1, 1));
}
float highestOf(Neighbourhood l) { return max(max(max(l.n, l.s), max(l.w, l.e)), l.m); }
float lowestOf(Neighbourhood l) { return min(min(min(l.n, l.s), min(l.w, l.e)), l.m); }
float rangeOf(Neighbourhood l) { return highestOf(l) - lowestOf(l); }
bool isEdge(Neighbourhood l, float edgeThreshold, float edgeThresholdMin) {
    precise const float relative = highestOf(l) * edgeThreshold;
    const float range = rangeOf(l);
    return range >= max(edgeThresholdMin, relative) && range > 0.0;
}
float secondDifference(float before, float centre, float behind) { return (before - centre) + (behind - centre); }
// Second differences across rows against those across columns. Where the middle one bends against the outer ones both
// sums are the same by algebra: within rounding they count as equal, and the edge as horizontal.
const float ORIENTATION_TOLERANCE = 1e-6;
bool runsHorizontally(Neighbourhood l) {
    const float acrossRows = abs(secondDifference(l.nw, l.w, l.sw)) + 2.0 * abs(secondDifference(l.n, l.m, l.s)) +
                             abs(secondDifference(l.ne, l.e, l.se));
    const float acrossColumns = abs(secondDifference(l.nw, l.n, l.ne)) + 2.0 * abs(secondDifference(l.w, l.m, l.e)) +
                                abs(secondDifference(l.sw, l.s, l.se));
    return acrossColumns - acrossRows <= acrossColumns * ORIENTATION_TOLERANCE;
}
// How far the pixel stands out of the mean of its neighbours in units of the local range (0..1).
float contrastOf(Neighbourhood l) {
    const float around = 2.0 * ((l.n - l.m) + (l.s - l.m) + (l.w - l.m) + (l.e - l.m)) + (l.nw - l.m) + (l.ne - l.m) +
                         (l.sw - l.m) + (l.se - l.m);
    return clamp(abs(around * (1.0 / 12.0)) / rangeOf(l), 0.0, 1.0);
}
float smoothed(float t) { return t * t * (3.0 - 2.0 * t); }

// The line between a pixel and its neighbour across the edge, as two rows of lumas.
struct EdgeLine {
    ivec2 p, along, across;  // to the next pixel along the line (right or down), and over it
    float own, side;         // lumas of the pair
};
EdgeLine lineBeside(ivec2 p, Neighbourhood l, bool horizontal, bool positiveSide) {
    EdgeLine line;
    line.p = p;
    line.along = horizontal ? ivec2(1, 0) : ivec2(0, 1);
    line.across = (horizontal ? ivec2(0, 1) : ivec2(1, 0)) * (positiveSide ? 1 : -1);
    line.own = l.m;
    line.side = horizontal ? (positiveSide ? l.s : l.n) : (positiveSide ? l.e : l.w);
    return line;
}
// By how much the sum of the pair `at` px along the line exceeds that of the pair at the pixel.
float pairDifference(EdgeLine line, int at) {
    const ivec2 q = line.p + line.along * at;
    return (lumaAt(q) - line.own) + (lumaAt(q + line.across) - line.side);
}
// The line ends where the mean luma of its pair has changed by a quarter of the gradient. Half a pixel short of a clean
// end the change is exactly that: it counts. Floats as near as these subtract without rounding; a product with
// 1 - END_TOLERANCE would be rounded by a tenth of the tolerance.
const float END_TOLERANCE = 1e-6;
bool endsLine(EdgeLine line, float change) {
    const float quarter = abs(line.side - line.own) * 0.25;
    return quarter - abs(change) <= quarter * END_TOLERANCE;
}

struct LineEnds {
    int negativeHalfPx, positiveHalfPx;
    bool negativeBelow, positiveBelow;  // is the luma below the pair's mean where each search stopped?
};
// Shift that makes the pixel pair follow the line: nothing unless the nearer end bends toward this pixel.
float edgeShift(LineEnds ends, bool pixelBelowMiddle) {
    const bool nearNegative = ends.negativeHalfPx < ends.positiveHalfPx;
    if ((nearNegative ? ends.negativeBelow : ends.positiveBelow) == pixelBelowMiddle) return 0.0;
    const int nearest = min(ends.negativeHalfPx, ends.positiveHalfPx);
    return 0.5 - float(nearest) / float(ends.negativeHalfPx + ends.positiveHalfPx);
}
vec3 shiftedColour(ivec2 p, ivec2 across, float shiftPx) {
    const vec3 own = colourAt(p);
    return shiftPx > 0.0 ? own + (colourAt(p + across) - own) * shiftPx : own;
}

#endif
