// msaa, csaa: multisampling and coverage sampling, emulated from sub-sample geometry. Every surface in a pixel is
// shaded once: the centre sample's surface has the pixel's colour, any other the colour of its sub-sample nearest to
// the pixel centre.
//
//  1. a pixel of one surface keeps its colour
//  2. group the slots (the sub-samples that hold a colour) into surfaces, by distance from the pixel centre
//  3. csaa: every other sub-sample counts for the stored surface that it lies on, or for that of the nearest slot
//  4. result = sum of coverage x colour, without colours that are not finite
//     FILTERED: every sub-sample gets its surface's colour instead, and reference/resolve.comp follows
//
// Samples share a surface when they share the object, their normals agree and they lie in one tangent plane
// (common/dissimilarity.glsl, sameSurface), or with BY_GEOMETRY off whole objects are surfaces.
//
// Sources: [Akeley 1993], [Young 2006] (docs/sources.md).
// Colours: linear BT.709, >= 0, in; out linear, or displayed values (ENCODED).
// Bindings 0 to 9, push constants and SAMPLES (at most 32): common/subsamples.glsl.
//
//   binding                             format           holds
//   10 keptImage            texture     RGBA 16F / 32F   what a pixel of one surface keeps: the colours, or displayed
//                                                        values (ENCODED)
//   11 Slots                buffer      {int byDistance, nearest}   byDistance: the i-th slot from the pixel centre, in
//                                                        entry i; nearest: the slot nearest to sub-sample i
//   12 surfaceColourImage   image       RGBA 16F / 32F   FILTERED: the result, one layer per sub-sample; otherwise any
//                                                        image of several layers
//
//   constant             default   csaa       means
//   10 SLOTS             8         4          sub-samples that hold a colour
//   11 SLOT_MASK         0xff      0x0f       which: bit k is sub-sample k
//   12 BY_GEOMETRY       true      true       surfaces are objects split by geometry, not whole objects
//   13 CENTROID          false     false      shade a partly covered surface at a covered sub-sample even if it covers
//                                             the centre
//   14 ENCODED           false     false      average displayed values
//   15 INVERSE_LUMINANCE false     false      weigh colours by 1 / (1 + luminance)
//   16 FILTERED          false     false      no mean: surfaceColourImage
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/subsamples.glsl"
#include "../common/colour.glsl"

layout(binding = 10) uniform sampler2D keptImage;
struct Slot {
    int byDistance, nearest;
};
layout(std430, binding = 11) readonly buffer Slots { Slot slots[]; };
layout(binding = 12) uniform writeonly image2DArray surfaceColourImage;
layout(constant_id = 10) const int SLOTS = 8;
layout(constant_id = 11) const uint SLOT_MASK = 0xffu;
layout(constant_id = 12) const bool BY_GEOMETRY = true;
layout(constant_id = 13) const bool CENTROID = false;
layout(constant_id = 14) const bool ENCODED = false;
layout(constant_id = 15) const bool INVERSE_LUMINANCE = false;
layout(constant_id = 16) const bool FILTERED = false;

bool isSlot(int k) { return (SLOT_MASK >> k & 1u) != 0u; }
bool same(ivec2 p, int a, int b) {
    return sameObject(p, a, b) &&
           (!BY_GEOMETRY || sameGeometry(p, a, b, SAME_SURFACE_COSINE, SAME_SURFACE_DISTANCE));
}

// The surfaces of the pixel, in the order in which they were found.
int seeds[SLOTS + 1];      // the sample that stands for it: CENTRE, else its slot nearest to the pixel centre
uint members[SLOTS + 1];  // bit k: sub-sample k lies on it
int count = 0;

void addSurface(int seed, uint samples) {
    seeds[count] = seed;
    members[count] = samples;
    count++;
}
// `likeCentre`: the sub-samples on the centre sample's surface.
void groupSlots(ivec2 p, uint likeCentre) {
    uint taken = likeCentre & SLOT_MASK;
    if (taken != 0u) addSurface(CENTRE, taken);
    for (int i = 0; i < SLOTS; i++) {
        const int seed = slots[i].byDistance;
        if ((taken >> seed & 1u) != 0u) continue;
        uint samples = 1u << seed;
        for (int k = 0; k < SAMPLES; k++)
            if (isSlot(k) && k != seed && (taken >> k & 1u) == 0u && same(p, seed, k)) samples |= 1u << k;
        addSurface(seed, samples);
        taken |= samples;
    }
}
// A coverage-only sample counts for a stored surface that it lies on, else for that of the nearest slot.
void cover(ivec2 p, int k, uint likeCentre) {
    int on = -1;
    for (int i = 0; i < count && on < 0; i++)
        if (seeds[i] == CENTRE ? (likeCentre >> k & 1u) != 0u : same(p, seeds[i], k)) on = i;
    for (int i = 0; i < count && on < 0; i++)
        if ((members[i] >> slots[k].nearest & 1u) != 0u) on = i;
    members[on] |= 1u << k;
}
vec3 shade(ivec2 p, int i) {
    int at = seeds[i];
    if (CENTROID && at == CENTRE && (members[i] & SLOT_MASK) != SLOT_MASK)
        for (int j = 0; j < SLOTS; j++) {
            at = slots[j].byDistance;
            if ((members[i] >> at & 1u) != 0u) break;
        }
    const vec3 c = colourOf(p, at);
    return ENCODED && isFinite(c) ? display(c, frame.displayScale, frame.toneMap, frame.srgb != 0u) : c;
}
// Coverage-weighted mean about the first surface's colour, which keeps constants exact.
vec3 resolve(ivec2 p) {
    vec3 sum = vec3(0.0), origin = vec3(0.0);
    float weights = 0.0;
    if (INVERSE_LUMINANCE) {  // about the least: a bright colour of next to no weight would take all digits
        origin = vec3(3e38);
        for (int i = 0; i < count; i++) {
            const vec3 c = shade(p, i);
            if (isFinite(c)) origin = min(origin, c);
        }
    }
    for (int i = 0; i < count; i++) {
        const vec3 c = shade(p, i);
        if (!isFinite(c)) continue;
        float w = float(bitCount(members[i]));
        if (INVERSE_LUMINANCE) w = w / (1.0 + max(0.0, luma709(c)));
        if (!INVERSE_LUMINANCE && !(weights > 0.0)) origin = c;
        weights = weights + w;
        sum = sum + (c - origin) * w;
    }
    return weights > 0.0 ? origin + sum / weights : vec3(0.0);
}
void storeSamples(ivec2 p, uint samples, vec3 c) {
    for (int k = 0; k < SAMPLES; k++)
        if ((samples >> k & 1u) != 0u) imageStore(surfaceColourImage, ivec3(p, k), vec4(c, 1.0));
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    const uint all = 0xffffffffu >> (32 - SAMPLES);
    uint likeCentre = 0u;
    for (int k = 0; k < SAMPLES; k++)
        if (same(p, CENTRE, k)) likeCentre |= 1u << k;
    vec3 result = texel(keptImage, p).rgb;
    if (likeCentre != all) {
        groupSlots(p, likeCentre);
        for (int k = 0; SLOTS < SAMPLES && k < SAMPLES; k++)
            if (!isSlot(k)) cover(p, k, likeCentre);
        result = resolve(p);
    }
    if (!FILTERED) {
        imageStore(resultImage, p, vec4(result, 1.0));
        return;
    }
    if (likeCentre == all) storeSamples(p, all, result);
    for (int i = 0; i < count; i++) {
        const vec3 own = shade(p, i);
        storeSamples(p, members[i], isFinite(own) ? own : result);
    }
}
