// mlaa, second pass: what each edge takes from the pixels on its sides, from spatial/mlaa_edges.comp's bits.
//
//  1. the line of edges on which the pixel's edge lies, and the edges that cross its ends: L, Z and U shapes
//  2. the silhouette, from half the height of the crossing edge at one end to the other end (Z) or to the middle of the
//     line (L, U); HEIGHTS_COLOUR: from where the blended lumas of both sides of the crossing edge agree
//  3. the area that it cuts off the pixel, and off the one across the line
//
// Source: [Reshetov 2009] (docs/sources.md). A line is measured in one scan whatever its length.
// Bindings 0 to 2 and push constants: common/mlaa.glsl.
//
//   binding                  format           holds
//   3  weightsImage  image   RGBA 16F / 32F   top edge: share that the pixel takes of the one above, and the one above
//                                             of the pixel; left edge: the same with the left neighbour; 0: no edge
//
//   constant               default   means
//   10 HEIGHTS_COLOUR      0         where the silhouette meets a crossing edge
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/area.glsl"
#include "../common/luma.glsl"
#include "../common/mlaa.glsl"

layout(binding = 3) uniform writeonly image2D weightsImage;
layout(constant_id = 10) const bool HEIGHTS_COLOUR = false;

// A separation line: a maximal run of edges. Its silhouette leaves from the edges that cross its ends, at this height
// (up or left positive); 0 where none does.
struct Line {
    int first, last;
    float left, right;
};
ivec2 pixelOf(int axis, int line, int at) { return axis == ROWS ? ivec2(at, line) : ivec2(line, at); }
float lumaAt(ivec2 p) { return lumaOf(colourAt(p), LUMA_REC601); }
// As a share of the crossing edge's length: where the line's last pixel (`own`) and the one beyond the crossing edge,
// if that has a line of its own one row farther, get one luma.
float meetingHeight(ivec2 own, ivec2 beyond, ivec2 across) {
    const float gained = lumaAt(beyond + across) - lumaAt(own), lost = lumaAt(own - across) - lumaAt(beyond);
    const float sum = gained + lost;
    if (!(abs(sum) >= 2.5 / 255.0)) return 0.5;  // within two codes: rounding to 8 bits would decide
    return clamp(gained / sum, 1e-3, 1.0);       // not 0: the crossing edges alone make the shape
}
float chosenHeight(int axis, int line, float end, int own, int beyond) {
    if (end == 0.0 || !bitAt(axis, end > 0.0 ? line - 1 : line + 1, beyond)) return end;
    const int row = end > 0.0 ? line - 1 : line, farther = end > 0.0 ? -1 : 1;
    const ivec2 across = axis == ROWS ? ivec2(0, farther) : ivec2(farther, 0);
    const float share = meetingHeight(pixelOf(axis, row, own), pixelOf(axis, row, beyond), across);
    return end > 0.0 ? share : -share;
}
// Of the edges that cross a line before its pixel `at`: +1/2 up, -1/2 down, 2 both.
float crossingHeight(int axis, int line, int at) {
    const bool up = bitAt(1 - axis, at, line - 1), down = bitAt(1 - axis, at, line);
    return up && down ? 2.0 : up ? 0.5 : down ? -0.5 : 0.0;
}
Line lineThrough(int axis, int line, int at) {
    const int first = firstOfRun(axis, line, at), last = lastOfRun(axis, line, at);
    float left = crossingHeight(axis, line, first), right = crossingHeight(axis, line, last + 1);
    if (left == 2.0) left = right == 2.0 ? 0.0 : -right;  // make a Z with the other end where there is one
    if (right == 2.0) right = -left;
    if (HEIGHTS_COLOUR) {
        left = chosenHeight(axis, line, left, first, first - 1);
        right = chosenHeight(axis, line, right, last, last + 1);
    }
    return Line(first, last, left, right);
}
vec2 mlaaArea(float left, float right, int leftPx, int rightPx) {
    const float l = float(leftPx), d = float(leftPx + rightPx + 1);
    if (left * right < 0.0) return segmentArea(0.0, left, d, right, l);
    vec2 sum = vec2(0.0);
    if (left != 0.0) sum = firstHalf(left, d, l);
    if (right != 0.0) sum = sum + secondHalf(right, d, l);
    return sum;
}
vec2 weights(int axis, int line, int at) {
    if (!bitAt(axis, line, at)) return vec2(0.0);
    const Line run = lineThrough(axis, line, at);
    return mlaaArea(run.left, run.right, at - run.first, run.last - at);
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    imageStore(weightsImage, p, vec4(weights(ROWS, p.y, p.x), weights(COLUMNS, p.x, p.y)));
}
