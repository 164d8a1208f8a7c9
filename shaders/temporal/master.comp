// master: the Sobel-improved TAA. History is held hard where nothing is aliased and loosely where something is.
//
//  S  (pass 1, master_sobel.comp) one Sobel value per texel; read at p - jitter from here on, as colours are
//  T  the Sobel value over time, a small TAA of its own: reprojected, clamped, luminance feedback
//  1. how aliased a pixel is: A = clamp(Sobel average + depth pseudo-variance, now and before + share of neighbours of
//     another object, 0, 1)
//  2. box: A mixes the plus-shaped and the 3x3 bounds and shrinks them toward the current colour; history clipped
//  3. feedback by the luminance difference, 0.925 .. 0.979; blend -> history
//  4. (pass 3, sharpen_history.comp) the blend sharpened, never fed back
//
// Workgroups are 16 x 16 and use 25 KB of shared memory: each texel is read once into it. T is done for one pixel more
// on each side, over which 1 averages.
//
// Source: [Oliveros 2018, 4.3] (docs/sources.md), by equation below.
// Colours: display-encoded, [0, 1], in and out. Alpha of the history is the Sobel value, filtered over time.
// Bindings 0 to 6, push constants and constants 0 to 4: common/temporal.glsl. frame.perDepth.w: the far depth of
// DEPTH_UNIT, scene units.
//
//   binding                       format  holds
//   7   sobelImage         tex    R 32F   the Sobel value of step S
//   8   objectImage        tex    R 32UI  object ids
//   9   previousDepthImage tex    R 32F   what keptDepthImage was a frame ago
//   10  keptDepthImage     img    R 32F   this frame's depth in DEPTH_UNIT, where colours are read
//
//   constant              default
//   10 K_MIN              0.925       weight of the history where its luminance differs most
//   11 K_MAX              0.979       and where it is the current one's
//   12 CLIP_TARGET        centre      toward what history is clipped (clip.glsl)
//   13 LUMINANCE          quarter     of the feedback (colour.glsl)
//   15 USE_SOBEL          true        terms of A, each for itself
//   16 USE_MODEL          true
//   17 USE_DEPTH          true
//   18 USE_DEPTH_TEMPORAL true
//   19 SOBEL_TEMPORAL     true        step T
//   20 DEPTH_UNIT         normalised  of all depths here (depth_unit.glsl)
//   21 DEPTH_THRESHOLD    0.002       least depth difference that is an edge, in DEPTH_UNIT
//   22 RELATIVE_THRESHOLD false       times the mean depth, if that exceeds 1
//   23 SAME_PIXEL_DEPTH   true        the past depth of this pixel; otherwise of where it was
//   24 COMPENSATE         false       less the change of depth that the camera alone makes
//   25 MIN_ALIAS          0           floor of A
#version 460
#extension GL_GOOGLE_include_directive : require
#define AA_GROUP 16
#include "../common/temporal.glsl"
#include "../common/clip.glsl"
#include "../common/depth_unit.glsl"
#include "../common/feedback.glsl"

layout(binding = 7) uniform sampler2D sobelImage;
layout(binding = 8) uniform usampler2D objectImage;
layout(binding = 9) uniform sampler2D previousDepthImage;
layout(binding = 10) uniform writeonly image2D keptDepthImage;
layout(constant_id = 10) const float K_MIN = 0.925;
layout(constant_id = 11) const float K_MAX = 0.979;
layout(constant_id = 12) const int CLIP_TARGET = CLIP_AABB_CENTRE;
layout(constant_id = 13) const int LUMINANCE = LUMINANCE_QUARTER;
layout(constant_id = 15) const bool USE_SOBEL = true;
layout(constant_id = 16) const bool USE_MODEL = true;
layout(constant_id = 17) const bool USE_DEPTH = true;
layout(constant_id = 18) const bool USE_DEPTH_TEMPORAL = true;
layout(constant_id = 19) const bool SOBEL_TEMPORAL = true;
layout(constant_id = 20) const int DEPTH_UNIT = DEPTH_NORMALISED;
layout(constant_id = 21) const float DEPTH_THRESHOLD = 0.002;
layout(constant_id = 22) const bool RELATIVE_THRESHOLD = false;
layout(constant_id = 23) const bool SAME_PIXEL_DEPTH = true;
layout(constant_id = 24) const bool COMPENSATE = false;
layout(constant_id = 25) const float MIN_ALIAS = 0.0;

float inDepthUnit(float depth) { return inDepthUnit(depth, frame.perDepth.w, DEPTH_UNIT); }
float lerp(float a, float b, float t) { return a + (b - a) * t; }
vec3 lerp(vec3 a, vec3 b, float t) { return a + (b - a) * t; }
vec4 lerp(vec4 a, vec4 b, float t) { return a + (b - a) * t; }

// ---- the workgroup's tile -------------------------------------------------------------------------------------------
// Its pixels and MARGIN more on each side: step T looks one pixel far, and step 1 one pixel far at its values. One more
// on the right and at the bottom, for bilinear reading. All tiles have the same cells.
const int GROUP = AA_GROUP, MARGIN = 2, SIDE = GROUP + 2 * MARGIN + 1, CELLS = SIDE * SIDE;
shared vec4 texelTile[CELLS];      // colour and Sobel value at the texels of the jittered frame
shared vec3 colourTile[CELLS];     // at p - jitter
shared float sobelTile[CELLS];     // likewise
shared float filteredTile[CELLS];  // the same after step T; of one pixel on each side
shared float depthTile[CELLS];     // planar view z
shared float unitTile[CELLS];      // the same in DEPTH_UNIT
shared vec2 motionTile[CELLS];
shared uint objectTile[CELLS];

int cellOf(ivec2 p) {
    const ivec2 c = p - ivec2(gl_WorkGroupID.xy) * GROUP + MARGIN;
    return c.y * SIDE + c.x;
}
void loadTile() {
    const ivec2 first = ivec2(gl_WorkGroupID.xy) * GROUP - MARGIN, whole = ivec2(floor(frame.readOffset));
    for (int k = int(gl_LocalInvocationIndex); k < CELLS; k += GROUP * GROUP) {
        const ivec2 p = first + ivec2(k % SIDE, k / SIDE);
        const ivec2 read = clampTexel(p + whole, frame.size), nearest = clampTexel(p + frame.texelOffset, frame.size);
        texelTile[k] = vec4(texelFetch(currentImage, read, 0).rgb, USE_SOBEL ? texelFetch(sobelImage, read, 0).r : 0.0);
        const float depth = texelFetch(depthImage, nearest, 0).r;
        depthTile[k] = depth, unitTile[k] = inDepthUnit(depth);
        motionTile[k] = texelFetch(motionImage, nearest, 0).rg;
        if (USE_MODEL) objectTile[k] = texelFetch(objectImage, nearest, 0).r;
    }
    barrier();
    const vec2 f = fract(frame.readOffset);
    const int right = f.x > 0.0 ? 1 : 0, below = f.y > 0.0 ? SIDE : 0;  // nothing is read with weight 0
    for (int k = int(gl_LocalInvocationIndex); k < CELLS - SIDE - 1; k += GROUP * GROUP) {
        const vec4 top = lerp(texelTile[k], texelTile[k + right], f.x);
        const vec4 bottom = lerp(texelTile[k + below], texelTile[k + below + right], f.x), c = lerp(top, bottom, f.y);
        colourTile[k] = c.rgb, sobelTile[k] = c.a;
    }
    barrier();
}

// ---- T: the past, and the Sobel value over time ---------------------------------------------------------------------
// dilatedMotion(), from the tile.
vec2 tileMotion(ivec2 p) {
    if (DILATION == DILATE_LONGEST_3X3) return dilatedMotion(p);
    const int c = cellOf(p);
    int at = c;
    if (DILATION != DILATE_NONE) {
        float nearest = depthTile[c];
        for (int j = -1; j <= 1; j++)
            for (int i = -1; i <= 1; i++) {
                if ((i == 0 && j == 0) || (DILATION == DILATE_CLOSEST_X && (i == 0 || j == 0))) continue;
                const float z = depthTile[c + j * SIDE + i];
                if (z < nearest) nearest = z, at = c + j * SIDE + i;
            }
    }
    return motionTile[at];
}
struct Past {
    Reprojection q;
    vec4 texel;  // colour and filtered Sobel value, bilinear
};
Past pastAt(ivec2 p) {
    Past past;
    past.q = reproject(p, tileMotion(p));
    past.texel = HARDWARE_FILTER ? filterBilinear(historyImage, p, past.q) : fetchBilinear(historyImage, p, past.q);
    return past;
}
float filteredSobel(ivec2 p, Past past) {
    if (!USE_SOBEL) return 0.0;
    const int c = cellOf(p);
    const float now = sobelTile[c];
    if (!SOBEL_TEMPORAL || !past.q.inside) return now;
    const float n = sobelTile[c - SIDE], s = sobelTile[c + SIDE], w = sobelTile[c - 1], e = sobelTile[c + 1],
                nw = sobelTile[c - SIDE - 1], ne = sobelTile[c - SIDE + 1], sw = sobelTile[c + SIDE - 1],
                se = sobelTile[c + SIDE + 1];
    const float plusLow = min(min(min(now, w), min(e, n)), s), plusHigh = max(max(max(now, w), max(e, n)), s);
    const float low = min(plusLow, min(min(nw, ne), min(sw, se))), high = max(plusHigh, max(max(nw, ne), max(sw, se)));
    const float held = clamp(past.texel.a, (low + plusLow) * 0.5, (high + plusHigh) * 0.5);
    const float k = min(luminanceFeedback(now, held, K_MIN, K_MAX), frame.feedbackCeiling);
    return held + (now - held) * (1.0 - k);
}
// The 4 GROUP + 4 pixels around the workgroup's own, by number.
ivec2 surroundingPixel(int k) {
    const ivec2 first = ivec2(gl_WorkGroupID.xy) * GROUP;
    if (k >= 4 * GROUP) return first + ivec2((k & 1) == 0 ? -1 : GROUP, (k & 2) == 0 ? -1 : GROUP);
    const int side = k / GROUP, along = k % GROUP, across = (side & 1) == 0 ? -1 : GROUP;
    return first + (side < 2 ? ivec2(along, across) : ivec2(across, along));
}

// ---- 1: how aliased a pixel is --------------------------------------------------------------------------------------
// Eq 4.1: share of the nine pixels that show another object.
float modelAverage(ivec2 p) {
    const int c = cellOf(p);
    float count = 0.0;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++)
            if (objectTile[c + j * SIDE + i] != objectTile[c]) count += 1.0;
    return count * (1.0 / 9.0);
}
// Eqs 4.12, 4.13: the mean of the plus-shaped window where little is aliased, of the 3x3 where much is.
float sobelAverage(ivec2 p, float model) {
    const int c = cellOf(p), n = c - SIDE, s = c + SIDE;
    const float beside = (filteredTile[c - 1] + filteredTile[c + 1]) + (filteredTile[n] + filteredTile[s]);
    const float corners = (filteredTile[n - 1] + filteredTile[n + 1]) + (filteredTile[s - 1] + filteredTile[s + 1]);
    const float plus = filteredTile[c] + beside, square = plus + corners;
    return lerp(plus * (1.0 / 5.0), square * (1.0 / 9.0), clamp(model + filteredTile[c], 0.0, 1.0));
}
struct DepthWindow {  // deviations from the centre's depth
    float mean, lowest, highest;
};
DepthWindow depthWindow(ivec2 p) {
    const int c = cellOf(p);
    DepthWindow w = DepthWindow(0.0, 0.0, 0.0);
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            if (i == 0 && j == 0) continue;
            const float d = unitTile[c + j * SIDE + i] - unitTile[c];
            w.mean = w.mean + d, w.lowest = min(w.lowest, d), w.highest = max(w.highest, d);
        }
    w.mean = w.mean * (1.0 / 9.0);
    return w;
}
// Eqs 4.4 to 4.6: x of now, y of before. `past`: depth of the past minus the centre's; the ratio is capped against
// overflow.
vec2 pseudoVariances(DepthWindow w, float past, float threshold) {
    const float D = min(abs(w.lowest - w.mean), abs(w.highest - w.mean));
    if (!(D >= threshold)) return vec2(0.0);
    const float inverse = 1.0 / D;
    const float now = min(abs(w.mean) * inverse, 1e3), before = min(abs(past - w.mean) * inverse, 1e3);
    const float before2 = before * before;
    return vec2(now * now, before2 * before2);
}
vec2 depthVariances(ivec2 p, Reprojection q) {
    const float depth = unitTile[cellOf(p)];
    const float pastDepth = texel(previousDepthImage, SAME_PIXEL_DEPTH ? p : nearestTexel(p, q)).r;
    const DepthWindow window = depthWindow(p);
    float past = pastDepth - depth;
    if (COMPENSATE) past = pastDepth - inDepthUnit(expectedPreviousDepth(depthTile[cellOf(p)], p));
    const float threshold = DEPTH_THRESHOLD * (RELATIVE_THRESHOLD ? max(depth + window.mean, 1.0) : 1.0);
    const vec2 variances = pseudoVariances(window, past, threshold);
    return vec2(USE_DEPTH ? variances.x : 0.0, !USE_DEPTH_TEMPORAL ? 0.0 : q.inside ? variances.y : 1.0);
}
// Eq 4.14.
float aliasedValue(ivec2 p, Reprojection q) {
    const float model = USE_MODEL ? modelAverage(p) : 0.0, sobel = USE_SOBEL ? sobelAverage(p, model) : 0.0;
    const vec2 variances = USE_DEPTH || USE_DEPTH_TEMPORAL ? depthVariances(p, q) : vec2(0.0);
    return max(clamp(sobel + variances.x + variances.y + model, 0.0, 1.0), MIN_ALIAS);
}

void storeResult(ivec2 p, vec3 result, float sobel) {
    storeBlend(p, result, sobel, result);
    imageStore(keptDepthImage, p, vec4(unitTile[cellOf(p)], 0.0, 0.0, 0.0));
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    const bool outside = any(greaterThanEqual(p, frame.size));
    loadTile();
    const vec3 current = colourTile[cellOf(p)];
    if (frame.firstFrame != 0u) {
        if (outside) return;
        storeResult(p, sanitised(current, current, vec3(0.0)), USE_SOBEL ? sobelTile[cellOf(p)] : 0.0);
        storeRejection(p, REJECTED_FIRST_FRAME);
        return;
    }

    // T. Beyond the picture lies its edge.
    const ivec2 own = clampTexel(p, frame.size);
    const Past past = pastAt(own);
    const float sobel = filteredSobel(own, past);
    if (USE_SOBEL) {
        filteredTile[cellOf(p)] = sobel;
        if (gl_LocalInvocationIndex < 4 * GROUP + 4) {
            const ivec2 around = surroundingPixel(int(gl_LocalInvocationIndex)), q = clampTexel(around, frame.size);
            filteredTile[cellOf(around)] = filteredSobel(q, pastAt(q));
        }
        barrier();
    }
    if (outside) return;
    const vec3 history = HISTORY_FILTER == HISTORY_BILINEAR ? past.texel.rgb : fetchHistory(p, past.q);

    // 1. and 2. The box is loose where aliased, the current colour alone where not (eqs 4.15, 4.16).
    const float aliased = aliasedValue(p, past.q);
    vec3 window[9];
    for (int k = 0; k < 9; k++) window[k] = colourTile[cellOf(p + ivec2(k % 3 - 1, k / 3 - 1))];
    const Neighbours n = neighbours(window);
    const Box box = Box(lerp(current, lerp(n.plus.low, n.square.low, aliased), aliased),
                        lerp(current, lerp(n.plus.high, n.square.high, aliased), aliased));
    const vec3 clipped = constrain(box, CLIP_TARGET, lerp(n.meanPlus, n.meanSquare, aliased), current, history);

    // 3. blend
    const float k = min(luminanceFeedback(luminance(current, LUMINANCE), luminance(clipped, LUMINANCE), K_MIN, K_MAX),
                        frame.feedbackCeiling);
    const vec3 mixed = past.q.inside ? blend(current, clipped, k) : current;
    storeResult(p, sanitised(mixed, current, history), sobel);
    storeRejection(p, past.q.inside);
}
