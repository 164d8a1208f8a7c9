// gbaa, d2e: blending by the exact distance to a geometric edge.
//
//  1. distances to the nearest edge: the pixel's own, and those of its four neighbours that reach into it
//  2. shift: half a pixel beyond the edge, where one cuts this pixel
//     gbaa  the pixel's own edge; otherwise the last neighbour's in the order left, right, up, down
//     d2e   the nearest edge on each axis, from both sides: a corner blends with two neighbours
//  3. result = colour at the centre + shift: as much of the neighbour as lies beyond the edge
//
// Sources: gbaa [Persson 2011], as in [Stejmar n.d., 3.3, listing 3.1]; d2e [Malan 2010] (docs/sources.md).
// Colours: linear BT.709, in and out. NaN and far distances cut nothing.
//
//   binding                      format           holds
//   0  colourImage     texture   RGBA 16F / 32F   centre samples
//   1  edgeImage       texture   RG 32F           signed distance along x or along y, px, positive to the right or
//                                                 down, from the pixel centre to the nearest edge of the triangle
//                                                 seen there; 0.5 or more: the edge does not cut this pixel
//   2  resultImage     image     RGBA 16F / 32F   the blend
//
//   constant                default   gbaa   d2e
//   10 PER_AXIS             false     0      1
//   11 SEARCH_NEIGHBOURS    true      1      1     a pixel without an edge of its own asks its neighbours
//
//   push constants: size, px
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D colourImage;
layout(binding = 1) uniform sampler2D edgeImage;
layout(binding = 2) uniform writeonly image2D resultImage;
layout(constant_id = 10) const bool PER_AXIS = false;
layout(constant_id = 11) const bool SEARCH_NEIGHBOURS = true;
layout(push_constant) uniform Frame {
    ivec2 size;
} frame;

struct EdgeDistances {
    vec2 own;
    float leftX, rightX, upY, downY;  // of the neighbours that may point at the pixel
};
EdgeDistances edgeDistances(ivec2 p) {
    return EdgeDistances(texel(edgeImage, p).rg, texel(edgeImage, p - ivec2(1, 0)).r,
                         texel(edgeImage, p + ivec2(1, 0)).r, texel(edgeImage, p - ivec2(0, 1)).g,
                         texel(edgeImage, p + ivec2(0, 1)).g);
}
// An edge between a neighbour's border and this pixel's centre, seen from that neighbour.
bool ahead(float d) { return d > 0.5 && d < 1.0; }
bool behind(float d) { return d > -1.0 && d < -0.5; }

const float NONE = 0.5;
// Half a pixel beyond an edge at signed distance d: the fetch then blends as much of the neighbour as lies beyond it.
float beyond(float d) { return !(abs(d) < 0.5) ? 0.0 : (d >= 0.0 ? 0.5 : -0.5) - d; }

// The pixel's own edge, else the last neighbour's in the order left, right, up, down.
vec2 gbaaShift(EdgeDistances e) {
    vec2 d = e.own;
    if (!(abs(d.x) < 0.5 || abs(d.y) < 0.5)) {
        d = vec2(NONE);
        if (SEARCH_NEIGHBOURS) {
            if (ahead(e.leftX)) d = vec2(e.leftX - 1.0, NONE);
            if (behind(e.rightX)) d = vec2(e.rightX + 1.0, NONE);
            if (ahead(e.upY)) d = vec2(NONE, e.upY - 1.0);
            if (behind(e.downY)) d = vec2(NONE, e.downY + 1.0);
        }
    }
    return vec2(beyond(d.x), beyond(d.y));
}
// The nearest edge on an axis, from both sides of the pixel's borders.
float nearest(float own, float before, float after) {
    float best = abs(own) < 0.5 ? own : NONE;
    if (ahead(before) && abs(before - 1.0) < abs(best)) best = before - 1.0;
    if (behind(after) && abs(after + 1.0) < abs(best)) best = after + 1.0;
    return best;
}
vec2 d2eShift(EdgeDistances e) {
    return vec2(beyond(nearest(e.own.x, e.leftX, e.rightX)), beyond(nearest(e.own.y, e.upY, e.downY)));
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    const EdgeDistances e = edgeDistances(p);
    const vec2 shift = PER_AXIS ? d2eShift(e) : gbaaShift(e);
    imageStore(resultImage, p, vec4(texelAt(colourImage, p, shift).rgb, 1.0));
}
