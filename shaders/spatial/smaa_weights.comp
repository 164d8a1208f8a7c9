// SMAA, pass 2 of 3: blending weights of every edge ([Jimenez 2012], reference shader v2.8).
//
//  1. a top edge on a diagonal takes the diagonal's areas, and its pixel then has no other weights
//  2. otherwise the distances to the ends of the edge's line and the edges that cross there
//  3. areas under the line that is revectorised through half the height of those crossing edges
//  4. sharp corners keep part of their shape
// Left edges are top edges of the transposed picture.
//
//   binding                    format   holds
//   0  edgesImage    texture   R 32UI   pass 1: bit 0 left border, bit 1 top border
//   1  Areas         buffer    vec2     x: weight of the pixel for its neighbour's colour (own), y: of the neighbour
//                                       for the pixel's (opposite). With TABLE first those of top lines, then of left
//                                       lines: 5 x 5 crossing codes x 16 x 16 roots of the distances. Then those of
//                                       rising, then of falling diagonals: 4 x 4 codes x 21 x 21 distances (none where
//                                       DIAGONAL_STEPS is 0)
//   2  weightsImage  image     RGBA 8 / 16F / 32F   top edge own, opposite, left edge own, opposite
//
//   constant             LOW  MEDIUM  HIGH  ULTRA   unit
//   10 SEARCH_STEPS      4    8       16    32      2 px, to either side
//   11 DIAGONAL_STEPS    0    0       8     16      px, 0: no diagonals
//   12 CORNER_ROUNDING   -1   -1      0.25  0.25    share, negative: off
//   13 TABLE             false: areas as they are, for any offset; true: looked up in the published 8-bit texture
//   14 UNORM8            false; true: weights rounded to 8 bits
//
//   push constants       unit
//   size                 px
//   offset               px, y down   how far top and left edges are moved back: minus the y and minus the x of the
//                                     place where the picture was sampled, from the pixel centre (with TABLE the
//                                     table holds it)
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/area.glsl"
#include "../common/image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform usampler2D edgesImage;
layout(binding = 1, std430) readonly buffer Areas { vec2 areas[]; };
layout(binding = 2) uniform writeonly image2D weightsImage;
layout(constant_id = 10) const int SEARCH_STEPS = 16;
layout(constant_id = 11) const int DIAGONAL_STEPS = 8;
layout(constant_id = 12) const float CORNER_ROUNDING = 0.25;
layout(constant_id = 13) const bool TABLE = false;
layout(constant_id = 14) const bool UNORM8 = false;
layout(push_constant) uniform Frame {
    ivec2 size;
    vec2 offset;
} frame;

const uint LEFT = 1u, TOP = 2u;
const int REACH = 2 * SEARCH_STEPS;        // px
const int ORTHOGONAL_SIZE = 25 * 16 * 16;  // of one table, in pairs
const int DIAGONALS = 21;                  // distances
const int DIAGONAL_SIZE = 16 * DIAGONALS * DIAGONALS;

bool edgeAt(ivec2 p, uint side) { return (texel(edgesImage, p) & side) != 0u; }
vec2 stored(vec2 w) {
    precise const vec2 code = floor(w * 255.0 + 0.5);
    return UNORM8 ? code / 255.0 : w;
}

// ---- diagonals ------------------------------------------------------------------------------------------------------

struct DiagonalEnd {
    int steps;
    bool found;
};
// One arm: pixels at n * step as long as both bits of the staircase are set; the left bit is read `leftShift` away.
DiagonalEnd diagonalArm(ivec2 p, ivec2 step, int leftShift, bool countLast) {
    int n = 1, passed = 0;
    bool success = true;
    for (; n <= DIAGONAL_STEPS && success; n++) {
        const ivec2 q = p + n * step;
        success = edgeAt(q, TOP) && edgeAt(q + ivec2(leftShift, 0), LEFT);
        if (success) passed++;
    }
    const bool last = countLast && edgeAt(p + (n - 1) * step, TOP);
    return DiagonalEnd(min(passed, DIAGONAL_STEPS - 1) + (last ? 1 : 0), !success);
}
// h and v: the edges that cross at the end of either arm, along x and along y.
vec2 diagonalLookup(bool falling, DiagonalEnd d1, bool h1, bool v1, DiagonalEnd d2, bool h2, bool v2) {
    const int c1 = d1.found ? 2 * int(h1) + int(v1) : 0, c2 = d2.found ? 2 * int(h2) + int(v2) : 0;
    const int table = (TABLE ? 2 * ORTHOGONAL_SIZE : 0) + (falling ? DIAGONAL_SIZE : 0);
    return areas[table + ((c1 * 4 + c2) * DIAGONALS + d1.steps) * DIAGONALS + d2.steps];
}
vec2 diagonalWeights(ivec2 p) {
    vec2 sum = vec2(0.0);
    {  // from bottom left to top right
        DiagonalEnd d1 = DiagonalEnd(0, true);
        if (edgeAt(p, LEFT)) d1 = diagonalArm(p, ivec2(-1, 1), 0, true);
        const DiagonalEnd d2 = diagonalArm(p, ivec2(1, -1), 0, false);
        if (d1.steps + d2.steps > 2) {
            const ivec2 a = p + d1.steps * ivec2(-1, 1), b = p + d2.steps * ivec2(1, -1);
            sum = diagonalLookup(false, d1, edgeAt(a + ivec2(-1, 0), TOP), edgeAt(a, LEFT),  //
                                 d2, edgeAt(b + ivec2(1, 0), TOP), edgeAt(b + ivec2(1, -1), LEFT));
        }
    }
    {  // from top left to bottom right: the same shape mirrored, so that own and opposite change places
        const DiagonalEnd d1 = diagonalArm(p, ivec2(-1, -1), 1, false);
        DiagonalEnd d2 = DiagonalEnd(0, true);
        if (edgeAt(p + ivec2(1, 0), LEFT)) d2 = diagonalArm(p, ivec2(1, 1), 1, true);
        if (d1.steps + d2.steps > 2) {
            const ivec2 a = p - d1.steps, b = p + d2.steps;
            sum += diagonalLookup(true, d1, edgeAt(a + ivec2(-1, 0), TOP), edgeAt(a + ivec2(0, -1), LEFT),  //
                                  d2, edgeAt(b + ivec2(1, 0), TOP), edgeAt(b + ivec2(1, 0), LEFT)).yx;
        }
    }
    return sum;
}

// ---- lines along rows or columns ------------------------------------------------------------------------------------

struct Axis {
    ivec2 along, across;  // px; edges lie between p - across and p
    uint side, crossing;  // bits of the line's edges and of those that cross it
    float offset;         // px, across the line
    int table;            // its first area
};
// Two pixels of a row or column, p and p + along: whether each has an edge of the line, and whether the line is crossed
// before it, by an edge of that pixel or of the one across the line.
struct TwoPixels {
    bvec2 onLine, crossed;
};
TwoPixels twoPixels(Axis a, ivec2 p) {
    const uvec2 own = uvec2(texel(edgesImage, p), texel(edgesImage, p + a.along));
    const uvec2 beyond = uvec2(texel(edgesImage, p - a.across), texel(edgesImage, p + a.along - a.across));
    return TwoPixels(notEqual(own & a.side, uvec2(0u)), notEqual((own | beyond) & a.crossing, uvec2(0u)));
}
// How many more pixels the line goes on beyond p, up to `cap`.
int runUp(Axis a, ivec2 p, int cap) {
    for (int n = 0; n < cap; n += 2) {
        const TwoPixels t = twoPixels(a, p + (n + 1) * a.along);
        if (!t.onLine.x || t.crossed.x) return n;
        if (!t.onLine.y || t.crossed.y) return min(n + 1, cap);
    }
    return cap;
}
// The same toward smaller p, `cap` odd. The pixel at which the line is crossed belongs to it, as it lies before the
// crossing edge.
int runDown(Axis a, ivec2 p, int cap) {
    for (int n = 0; n < cap; n += 2) {
        const TwoPixels t = twoPixels(a, p - (n + 1) * a.along);
        if (!t.onLine.y) return n - 1;  // p is on it
        if (t.crossed.y || !t.onLine.x) return n;
        if (t.crossed.x) return min(n + 1, cap);
    }
    return cap;
}
// Edges that cross the end of a line, from its row -2 to +1: bits 1 and 2 touch it, 0 and 3 lie beyond.
uint crossingBits(Axis a, ivec2 p) {
    uint bits = 0u;
    for (int i = 0; i < 4; i++)
        if (edgeAt(p + (i - 2) * a.across, a.crossing)) bits |= 1u << i;
    return bits;
}
// 0 none, 1 above, 3 below, 4 both.
int crossingCode(uint bits) { return ((bits & 2u) != 0u ? 1 : 0) + ((bits & 4u) != 0u ? 3 : 0); }

// Short U shapes are rounded: their tips would alternate otherwise.
vec2 smoothed(vec2 area, float d) {
    const float t = min(d * (1.0 / 32.0), 1.0);
    precise const vec2 s = sqrt(area + area) * 0.5, bent = s + (area - s) * t;
    return bent;
}
// Crossing codes of the two ends, distances to them in px -> weights.
vec2 orthoArea(int left, int right, int leftPx, int rightPx, float offset) {
    const bool single1 = left == 1 || left == 3, single2 = right == 1 || right == 3;
    if (!single1 && !single2) return vec2(0.0);
    const float l = float(leftPx), d = float(leftPx + rightPx + 1), above = 0.5 + offset, below = -0.5 + offset;
    const float h1 = left == 1 ? above : below, h2 = right == 1 ? above : below;
    if (single1 && single2) {
        if (left == right) return smoothed(firstHalf(h1, d, l), d) + smoothed(secondHalf(h2, d, l), d);
        const vec2 z = segmentArea(0.0, h1, d, h2, l);
        return offset == 0.0 ? z : (z + (firstHalf(h1, d, l) + secondHalf(h2, d, l))) * 0.5;
    }
    if (single1) {
        if (right == 4) return segmentArea(0.0, h1, d, left == 1 ? below : above, l);
        return leftPx <= rightPx ? firstHalf(h1, d, l) : vec2(0.0);
    }
    if (left == 4) return segmentArea(0.0, right == 1 ? below : above, d, h2, l);
    return leftPx >= rightPx ? secondHalf(h2, d, l) : vec2(0.0);
}
// The published form: 16 x 16 entries at square distances, bilinear in the roots.
vec2 tableArea(int table, int left, int right, int leftPx, int rightPx) {
    const float u = min(sqrt(float(leftPx)), 15.0), v = min(sqrt(float(rightPx)), 15.0);
    const int i = min(int(u), 14), j = min(int(v), 14), k = table + ((left * 5 + right) * 16 + i) * 16 + j;
    const float fu = u - float(i), fv = v - float(j);
    precise const vec2 a = areas[k] + (areas[k + 16] - areas[k]) * fu;
    precise const vec2 b = areas[k + 1] + (areas[k + 17] - areas[k + 1]) * fu;
    precise const vec2 area = a + (b - a) * fv;
    return area;
}
// Crossing edges make the line turn: a sharp corner keeps part of its shape. By the edges beyond the line at its nearer
// end, or half of that by those at both.
vec2 corners(uint leftBits, uint rightBits, int leftPx, int rightPx) {
    if (CORNER_ROUNDING < 0.0) return vec2(1.0);
    const float reduction = 1.0 - CORNER_ROUNDING, share = leftPx == rightPx ? reduction * 0.5 : reduction;
    const float left = leftPx <= rightPx ? share : 0.0, right = leftPx >= rightPx ? share : 0.0;
    const vec2 atLeft = vec2((leftBits & 8u) != 0u ? left : 0.0, (leftBits & 1u) != 0u ? left : 0.0);
    const vec2 atRight = vec2((rightBits & 8u) != 0u ? right : 0.0, (rightBits & 1u) != 0u ? right : 0.0);
    return max(vec2(0.0), 1.0 - atLeft - atRight);
}
vec2 lineWeights(Axis a, ivec2 p) {
    const int leftPx = runDown(a, p, REACH - 1), rightPx = runUp(a, p, REACH);
    const uint leftBits = crossingBits(a, p - leftPx * a.along);
    const uint rightBits = crossingBits(a, p + (rightPx + 1) * a.along);
    const int left = crossingCode(leftBits), right = crossingCode(rightBits);
    const vec2 area = TABLE ? tableArea(a.table, left, right, leftPx, rightPx)
                            : orthoArea(left, right, leftPx, rightPx, a.offset);
    // Samples beyond their pixel (jitter + position) lift lines over it.
    return stored(min(area, vec2(1.0)) * corners(leftBits, rightBits, leftPx, rightPx));
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    vec2 top = vec2(0.0), left = vec2(0.0);
    bool onDiagonal = false;
    if (edgeAt(p, TOP)) {
        const vec2 w = DIAGONAL_STEPS > 0 ? min(diagonalWeights(p), vec2(1.0)) : vec2(0.0);  // two may cross
        onDiagonal = w.x + w.y > 0.0;
        top = onDiagonal ? stored(w) : lineWeights(Axis(ivec2(1, 0), ivec2(0, 1), TOP, LEFT, frame.offset.x, 0), p);
    }
    if (!onDiagonal && edgeAt(p, LEFT))
        left = lineWeights(Axis(ivec2(0, 1), ivec2(1, 0), LEFT, TOP, frame.offset.y, ORTHOGONAL_SIZE), p);
    imageStore(weightsImage, p, vec4(top, left));
}
