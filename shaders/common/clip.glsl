// What holds a history in the box of the current colours.
#ifndef AA_CLIP
#define AA_CLIP
#include "image.glsl"
#include "neighbourhood.glsl"

// The smallest of three ratios n_k / d_k >= 0, with one division. n > 0 over 0 is infinite; 0 over 0 is the caller's to
// avoid.
float leastRatio(vec3 n, vec3 d) {
    const bool xy = n.x * d.y <= n.y * d.x;
    const float nxy = xy ? n.x : n.y, dxy = xy ? d.x : d.y;
    const bool xyz = nxy * d.z <= n.z * dxy;
    return (xyz ? nxy : n.z) / (xyz ? dxy : d.z);
}
// On the line to the box's centre until it meets the box [Pedersen 2016].
vec3 clipToCentre(Box box, vec3 h) {
    // A scaled floor: a flat bright box would divide rounding noise by almost nothing.
    const float floorExtent = max(1e-8, maxComponent(abs(box.high)) * 1e-6);
    const vec3 centre = (box.low + box.high) * 0.5, extent = (box.high - box.low) * 0.5 + vec3(floorExtent);
    const vec3 offset = h - centre;
    if (offset == vec3(0.0)) return h;
    const float t = leastRatio(extent, abs(offset));
    return t < 1.0 ? centre + offset * t : h;
}
// Exactly on the line toward a point r of the box.
vec3 clipToward(Box box, vec3 r, vec3 h) {
    r = clamp(r, box.low, box.high);
    const vec3 way = h - r, room = clamp(h, box.low, box.high) - r;
    const vec3 allowed = mix(abs(room), vec3(1.0), equal(way, vec3(0.0)));
    if (way == vec3(0.0)) return h;
    const float t = leastRatio(allowed, abs(way));
    return t < 1.0 ? r + way * t : h;
}
// By number: toward the box's centre, the mean, the current colour; per channel.
const int CLIP_AABB_CENTRE = 0, CLIP_MEAN = 1, CLIP_CURRENT = 2, CLIP_CLAMP = 3;
vec3 constrain(Box box, int kind, vec3 mean, vec3 current, vec3 h) {
    if (kind == CLIP_MEAN) return clipToward(box, mean, h);
    if (kind == CLIP_CURRENT) return clipToward(box, current, h);
    if (kind == CLIP_CLAMP) return clamp(h, box.low, box.high);
    return clipToCentre(box, h);
}

#endif
