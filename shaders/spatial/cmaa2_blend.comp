// CMAA2, pass 3 of 3: the weighted mean of everything that falls on a pixel (version 2.3 [Strugar 2018]).
//
//  1. candidates (two adjacent edges) are blurred a little toward their edges
//  2. pixels along half of each arm of a line are blended across it, by a linear ramp
//  3. mean: a blur counts 0.8, each line 1.8
// Published as lists of results that threads append; here each pixel looks along its edges for the lines that reach it,
// so that nothing depends on the order of threads and no memory is shared.
//
// Colours: any space; linear BT.709 by default. Outside the picture lies its edge, repeated.
//
//   binding                       format           holds
//   0  colourImage      texture   RGBA 16F / 32F
//   1  shapesImage      texture   R 32UI           pass 2 (common/cmaa2.glsl)
//   2  resultImage      image     RGBA 16F / 32F
//
//   constant                 default  sharp  means
//   10 LONGEST               86              px, of an arm
//   11 SIMPLE_BLUR           0.10     0.07   strength of step 1
//   12 FADE_FROM             1.30     1.15   minus FADE_PER_EDGE for each edge around: factor on that strength, [0, 1]
//   13 FADE_PER_EDGE         0.1      0.125
//   14 SYMMETRY_CORRECTION   0.22            px, shortening of the ramp on arms of odd length
//   15 DAMPENING             0.15     0.11   per px of a line's length: factor on step 2, [0, 1]
//
//   push constants           unit
//   size                     px
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/cmaa2.glsl"
#include "../common/image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D colourImage;
layout(binding = 1) uniform usampler2D shapesImage;
layout(binding = 2) uniform writeonly image2D resultImage;
layout(constant_id = 10) const int LONGEST = 86;
layout(constant_id = 11) const float SIMPLE_BLUR = 0.10;
layout(constant_id = 12) const float FADE_FROM = 1.30;
layout(constant_id = 13) const float FADE_PER_EDGE = 0.10;
layout(constant_id = 14) const float SYMMETRY_CORRECTION = 0.22;
layout(constant_id = 15) const float DAMPENING = 0.15;
layout(push_constant) uniform Frame {
    ivec2 size;
} frame;

const float BLUR_WEIGHT = 0.8, LINE_WEIGHT = 1.8;

vec3 colourAt(ivec2 p) { return texel(colourImage, p).rgb; }
uint wordAt(ivec2 p) {
    if (any(lessThan(p, ivec2(0))) || any(greaterThanEqual(p, frame.size))) return 0u;
    return texelFetch(shapesImage, p, 0).r;
}
struct EdgesOf {
    float right, bottom, left, top;
};
EdgesOf edgesOf(uint e) {
    return EdgesOf(float(e & 1u), float(e >> 1 & 1u), float(e >> 2 & 1u), float(e >> 3 & 1u));
}

struct Results {
    vec3 sum;  // weighted
    bool blurred;
    int lines;
};
vec3 blurCandidate(ivec2 p, uint word) {
    const EdgesOf own = edgesOf(word), l = edgesOf(wordAt(p - ivec2(1, 0))), r = edgesOf(wordAt(p + ivec2(1, 0))),
                  t = edgesOf(wordAt(p - ivec2(0, 1))), b = edgesOf(wordAt(p + ivec2(0, 1)));
    float right = own.right, below = own.bottom, left = own.left, above = own.top, strength = SIMPLE_BLUR;
    if (own.right + own.bottom + own.left + own.top == 2.0) {  // an L: its arms pull
        strength = strength * 0.75;
        right = right + 0.9 * (own.bottom * t.right * (1.0 - l.bottom) + own.top * b.right * (1.0 - l.top));
        below = below + 0.9 * (own.left * r.bottom * (1.0 - t.left) + own.right * l.bottom * (1.0 - t.right));
        left = left + 0.9 * (own.top * b.left * (1.0 - r.top) + own.bottom * t.left * (1.0 - r.bottom));
        above = above + 0.9 * (own.right * l.top * (1.0 - b.right) + own.left * r.top * (1.0 - b.left));
    }
    // Where edges crowd there is text or texture to be kept.
    const float around = (l.bottom + l.left + l.top) + (r.right + r.bottom + r.top) + (t.top + t.right + t.left) +
                         (b.right + b.bottom + b.left);
    strength = strength * clamp(FADE_FROM - around * FADE_PER_EDGE, 0.0, 1.0);
    const float wr = right * strength, wb = below * strength, wl = left * strength, wt = above * strength;
    const vec3 centre = colourAt(p);
    return centre +
           (wr * (colourAt(p + ivec2(1, 0)) - centre) + wl * (colourAt(p - ivec2(1, 0)) - centre)) +
           (wb * (colourAt(p + ivec2(0, 1)) - centre) + wt * (colourAt(p - ivec2(0, 1)) - centre));
}
// The colour of p as the pixel i of a line.
vec3 blendLine(ivec2 p, int i, ZShape z) {
    const ivec2 across = (z.horizontal ? ivec2(0, -1) : ivec2(-1, 0)) * (z.inverted ? -1 : 1);
    const int from = firstBlended(z), to = lastBlended(z);
    const float leftOdd = SYMMETRY_CORRECTION * float(z.left & 1), rightOdd = SYMMETRY_CORRECTION * float(z.right & 1);
    const float step = 1.0 / (float(to - from + 1) - leftOdd - rightOdd), start = (0.5 - leftOdd - float(from)) * step;
    const float damping = clamp(float(z.left + z.right - z.quality) * DAMPENING, 0.0, 1.0);
    const float ramp = step * float(i) + start, share = (i > 0 ? 1.0 - ramp : ramp) * damping;
    const vec3 own = colourAt(p);
    return own + (colourAt(i > 0 ? p - across : p + across) - own) * share;
}
// Adds p as the pixel i of the line whose step the word holds.
void addLine(inout Results results, ivec2 p, uint word, int i, bool horizontal) {
    const ZShape z = shapeOf(word);
    if (!z.found || z.horizontal != horizontal || i < firstBlended(z) || i > lastBlended(z)) return;
    results.sum += LINE_WEIGHT * blendLine(p, i, z);
    results.lines++;
}
// Lines of one direction that reach p: as long as one of its edges goes on, their steps may lie to either side.
void addLines(inout Results results, ivec2 p, uint word, bool horizontal) {
    const ivec2 along = alongLine(horizontal);
    const uint sides = word & (horizontal ? TOP | BOTTOM : LEFT | RIGHT);
    const int most = (LONGEST + 1) / 2;
    uint goesOn = sides;
    for (int i = 1; i <= most && goesOn != 0u; i++) {  // on the right arm, i from the step
        const uint w = wordAt(p - along * i);
        addLine(results, p, w, i, horizontal);
        goesOn &= w;
    }
    goesOn = sides;
    for (int i = 0; i < most && goesOn != 0u; i++) {  // on the left arm
        const uint w = wordAt(p + along * i);
        addLine(results, p, w, -i, horizontal);
        goesOn &= w;
    }
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    const uint word = wordAt(p);
    Results results = Results(vec3(0.0), false, 0);
    if (hasCorner(word & EDGES)) {
        results.sum = BLUR_WEIGHT * blurCandidate(p, word);
        results.blurred = true;
    }
    addLines(results, p, word, true);
    addLines(results, p, word, false);
    const float weight = (results.blurred ? BLUR_WEIGHT : 0.0) + LINE_WEIGHT * float(results.lines);
    imageStore(resultImage, p, vec4(weight > 0.0 ? results.sum / weight : colourAt(p), 1.0));
}
