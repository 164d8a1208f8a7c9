// Tests by geometry that reject a history. Include after temporal.glsl.
#ifndef AA_REJECTION
#define AA_REJECTION
#include "temporal.glsl"

// Bilinear depth of the previous frame from its four texels a b / c d. Bilinear over a silhouette invents depths: where
// they differ more than tenfold (background), the nearest counts. Texels of weight 0 do not.
float depthBetween(float a, float b, float c, float d, vec2 part) {
    if (part.x == 0.0) b = a, d = c;
    if (part.y == 0.0) c = a, d = b;
    const float nearest = min(min(a, b), min(c, d)), farthest = max(max(a, b), max(c, d));
    const float top = a + (b - a) * part.x, bottom = c + (d - c) * part.x;
    return farthest > nearest * 10.0 ? nearest : top + (bottom - top) * part.y;
}
float fetchDepth(sampler2D depths, ivec2 p, Reprojection q) {
    const ivec2 o = p + q.whole;
    return depthBetween(texel(depths, o).r, texel(depths, o + ivec2(1, 0)).r, texel(depths, o + ivec2(0, 1)).r,
                        texel(depths, o + ivec2(1, 1)).r, q.part);
}
// The surface was hidden: it should have been at `expected`, something nearer by more than `tolerance` times that was
// there; with `bothSides` or farther. NaN is hidden.
bool disoccluded(float expected, float found, float tolerance, bool bothSides) {
    const float difference = expected - found, limit = expected * tolerance;
    return !((bothSides ? abs(difference) : difference) <= limit);
}
// Change of the motion to the next pixel along x and along y; in the last column and row, beyond which the motion is
// repeated, from the pixel before.
struct MotionSlope {
    vec2 alongX, alongY;
};
MotionSlope motionSlope(ivec2 p) {
    const ivec2 next = p + 1, ahead = ivec2(next.x < frame.size.x ? 1 : 0, next.y < frame.size.y ? 1 : 0);
    return MotionSlope(motionAt(p + ivec2(ahead.x, 0)) - motionAt(p + ivec2(ahead.x - 1, 0)),
                       motionAt(p + ivec2(0, ahead.y)) - motionAt(p + ivec2(0, ahead.y - 1)));
}
// Pixels that one pixel covered `age` frames ago, the longer way along each axis.
vec2 footprint(MotionSlope slope, float age) {
    const vec2 alongX = slope.alongX * age, alongY = slope.alongY * age;
    return vec2(max(abs(1.0 - alongX.x), abs(alongY.x)), max(abs(alongX.y), abs(1.0 - alongY.y)));
}
// A pixel covers less than a previous pixel and q is far from that pixel's centre: reading would enlarge one sample
// [Stejmar n.d., 3.6.2]. `scale`: share of the footprint within which the centre must lie.
bool magnified(Reprojection q, vec2 covered, float scale) {
    return !all(lessThanEqual(min(q.part, 1.0 - q.part), covered * scale));
}
// The id is nowhere in the previous 3x3 around the texel `nearest`.
bool idLost(usampler2D previousIds, uint id, ivec2 nearest) {
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++)
            if (texel(previousIds, nearest + ivec2(i, j)) == id) return false;
    return true;
}

#endif
