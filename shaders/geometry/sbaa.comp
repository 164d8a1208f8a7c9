// sbaa: surface based anti-aliasing. The sub-samples are merged into at most MOST_SURFACES surfaces, each shaded once.
//
//  1. a pixel whose sub-samples all lie on the centre sample's surface keeps its colour
//  2. cluster: one per object and tangent plane (common/dissimilarity.glsl, sameSurface)
//  3. merge clusters whose normals agree and that lie in one plane; of one object only (IDS)
//  4. reduce: while too many, merge the two of smallest SADP; the one that covers more represents both
//  5. shade each at the sub-sample nearest to its centroid; result = sum of coverage x colour
//
// Source: [Salvi 2012] (docs/sources.md). Colours: linear BT.709, in and out; those that are not finite are left out.
// Bindings 0 to 9, push constants and SAMPLES (at most 16): common/subsamples.glsl.
//
//   constant             default
//   10 MOST_SURFACES     2         kept per pixel
//   11 MERGE_NORMAL      0.95      least cosine of the normals of one surface
//   12 MERGE_DEPTH       0.01      most distance from one plane, relative to the depth
//   13 IDS               true      objects stay apart before the reduction
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/subsamples.glsl"

layout(constant_id = 10) const int MOST_SURFACES = 2;
layout(constant_id = 11) const float MERGE_NORMAL = 0.95;
layout(constant_id = 12) const float MERGE_DEPTH = 0.01;
layout(constant_id = 13) const bool IDS = true;

struct Cluster {
    int representative;  // sub-sample
    uint members;        // bit k: sub-sample k
};
Cluster clusters[SAMPLES];
int count = 0;

int coverage(int i) { return bitCount(clusters[i].members); }
bool sameGeometry(ivec2 p, int k, int l) { return sameGeometry(p, k, l, MERGE_NORMAL, MERGE_DEPTH); }
void onePerSurface(ivec2 p) {
    for (int k = 0; k < SAMPLES; k++) {
        int i = 0;
        while (i < count && !(sameObject(p, clusters[i].representative, k) &&
                              sameGeometry(p, clusters[i].representative, k)))
            i++;
        if (i == count) clusters[count++] = Cluster(k, 0u);
        clusters[i].members |= 1u << k;
    }
}
void merge(int i, int j) {  // i < j
    if (coverage(j) > coverage(i)) clusters[i].representative = clusters[j].representative;
    clusters[i].members |= clusters[j].members;
    count--;
    clusters[j] = clusters[count];
}
void mergeLike(ivec2 p) {
    for (int i = 0; i < count; i++) {
        int j = i + 1;
        while (j < count) {
            const int k = clusters[i].representative, l = clusters[j].representative;
            if ((!IDS || sameObject(p, k, l)) && sameGeometry(p, k, l)) {
                merge(i, j);
                j = i + 1;
            } else
                j++;
        }
    }
}
// The two that are least apart; of equals those that cover least.
void mergeNearest(ivec2 p) {
    int bestI = 0, bestJ = 1, least = 0;
    float best = 0.0;
    for (int i = 0; i < count; i++)
        for (int j = i + 1; j < count; j++) {
            const int k = clusters[i].representative, l = clusters[j].representative;
            const float d = dissimilarity(surfacePoint(p, k), surfacePoint(p, l), separation(p, k, l),
                                          DISSIMILARITY_SADP);
            const int covered = coverage(i) + coverage(j);
            if ((i == 0 && j == 1) || d < best || (d == best && covered < least))
                best = d, bestI = i, bestJ = j, least = covered;
        }
    merge(bestI, bestJ);
}
// Shaded once, at the member nearest to the cluster's centroid.
vec3 shade(ivec2 p, uint members) {
    vec2 sum = vec2(0.0);  // times the coverage: exact for positions on a grid of 1/16, so that equals tie
    for (int k = 0; k < SAMPLES; k++)
        if ((members >> k & 1u) != 0u) sum = sum + offsetsPx[k];
    int nearest = -1;
    float least = 0.0;
    for (int k = 0; k < SAMPLES; k++) {
        if ((members >> k & 1u) == 0u) continue;
        precise vec2 d = float(bitCount(members)) * offsetsPx[k] - sum;
        precise float d2 = d.x * d.x + d.y * d.y;
        if (nearest < 0 || d2 < least) nearest = k, least = d2;
    }
    return colourOf(p, nearest);
}
vec3 resolve(ivec2 p) {
    vec3 sum = vec3(0.0), origin = vec3(0.0);
    int covered = 0;
    for (int i = 0; i < count; i++) {
        const vec3 c = shade(p, clusters[i].members);
        if (!isFinite(c)) continue;
        if (covered == 0) origin = c;  // about the first colour: constants stay exact
        covered += coverage(i);
        sum = sum + (c - origin) * float(coverage(i));
    }
    return covered != 0 ? origin + sum / float(covered) : vec3(0.0);
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    bool edge = false;
    for (int k = 0; k < SAMPLES && !edge; k++)
        edge = !sameGeometry(p, CENTRE, k) || (IDS && !sameObject(p, CENTRE, k));
    if (!edge) {
        imageStore(resultImage, p, vec4(texel(colourImage, p).rgb, 1.0));
        return;
    }
    onePerSurface(p);
    mergeLike(p);
    while (count > MOST_SURFACES) mergeNearest(p);
    imageStore(resultImage, p, vec4(resolve(p), 1.0));
}
