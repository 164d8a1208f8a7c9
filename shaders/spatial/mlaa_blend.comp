// mlaa, last pass: each pixel is blended with those across its edges, by spatial/mlaa_weights.comp's weights.
//
//  1. across horizontal lines
//  2. across vertical lines, the pixels that step 1 left; SIMULTANEOUS: the original ones, and a pixel that both move
//     goes halfway with each
//
// Source: [Reshetov 2009] (docs/sources.md).
// Colours: encoded. Bindings 0 and 1 and push constants: common/spatial.glsl.
//
//   binding                   format           holds
//   2  weightsImage  texture  RGBA 16F / 32F   see spatial/mlaa_weights.comp
//
//   constant          default   means
//   10 SIMULTANEOUS   0
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/spatial.glsl"

layout(binding = 2) uniform sampler2D weightsImage;
layout(constant_id = 10) const bool SIMULTANEOUS = false;

vec4 weightsAt(ivec2 p) { return insidePicture(p) ? texelFetch(weightsImage, p, 0) : vec4(0.0); }
// Shares of the neighbours above and below, to the left and to the right.
vec2 verticalShares(ivec2 p) { return vec2(weightsAt(p).x, weightsAt(p + ivec2(0, 1)).y); }
vec2 horizontalShares(ivec2 p) { return vec2(weightsAt(p).z, weightsAt(p + ivec2(1, 0)).w); }
// Heights by colour can take more than all of a pixel between two lines.
vec2 sharedOut(vec2 shares) {
    const float sum = shares.x + shares.y;
    return sum > 1.0 ? shares / sum : shares;
}
vec3 blended(vec3 own, vec2 shares, vec3 first, vec3 second) {
    shares = sharedOut(shares);
    return greater(own + shares.x * (first - own) + shares.y * (second - own), vec3(0.0));
}
vec3 acrossHorizontalLines(ivec2 p) {
    const vec2 shares = verticalShares(p);
    const vec3 own = colourAt(p);
    if (shares == vec2(0.0)) return own;
    return blended(own, shares, colourAt(p + ivec2(0, -1)), colourAt(p + ivec2(0, 1)));
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (!insidePicture(p)) return;

    // 1. horizontal lines
    vec3 c = acrossHorizontalLines(p);

    // 2. vertical lines
    vec2 shares = horizontalShares(p);
    if (shares != vec2(0.0)) {
        if (SIMULTANEOUS) {
            shares = sharedOut(shares);
            const vec3 own = colourAt(p);
            const vec3 left = colourAt(p + ivec2(-1, 0)), right = colourAt(p + ivec2(1, 0));
            const vec3 sum = c - own + (shares.x * (left - own) + shares.y * (right - own));
            c = greater(own + (verticalShares(p) != vec2(0.0) ? sum * 0.5 : sum), vec3(0.0));
        } else
            c = blended(c, shares, acrossHorizontalLines(p + ivec2(-1, 0)), acrossHorizontalLines(p + ivec2(1, 0)));
    }
    storeResult(p, c);
}
