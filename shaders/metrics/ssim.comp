// SSIM: 11 x 11 Gaussian window, sigma 1.5, edge repeated, variances about the local mean; a map and sums of it.
//
// Works on the sum s = T + R and the difference d = T - R of the two pictures:
//   2 mu_T mu_R = (mu_s^2 - mu_d^2) / 2      mu_T^2 + mu_R^2       = (mu_s^2 + mu_d^2) / 2
//   2 sigma_TR  = (var_s - var_d) / 2        sigma_T^2 + sigma_R^2 = (var_s + var_d) / 2
// so that two variances are enough and equal pictures (d = 0) give exactly 1. For each channel:
//
//  1. s and d of the workgroup's pixels and of 5 more on each side, in shared memory
//  2. mean and variance along x, of each row about its own mean
//  3. along y, about the mean of those means: var = sum_j w_j (var_j + (mean_j - mean)^2), whose terms are >= 0, so
//     that none cancels
// then
//  4. `volume` only: the same across the channels, as MATLAB filters an array of M x N x 3
//  5. SSIM = (2 mu_T mu_R + C1) (2 sigma_TR + C2) / ((mu_T^2 + mu_R^2 + C1) (sigma_T^2 + sigma_R^2 + C2)), mean over
//     the channels
//
// Sources: [Wang 2004] (docs/sources.md), conventions 13.2. Colours: display-encoded, in [0, 1].
// Workgroups of 16 x 16; 13 KB of shared memory.
//
//   binding                 format     holds
//   0  testImage       tex  RGBA 32F   T
//   1  referenceImage  tex  RGBA 32F   R
//   2  mapImage        img  R32F       SSIM of each pixel
//   3  Sums            buf  float      of each workgroup, row by row: sum of the map. The host adds them in double, in
//                                      order, and divides by width height
//
//   constant           default
//   10 SIGNAL          0       0 BT.601 luma, 1 each channel, 2 the channels as a volume
//   push constants: size, px
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/group_sum.glsl"
#include "../common/image.glsl"
#include "../common/luma.glsl"

const int SIGNAL_LUMA = 0, SIGNAL_CHANNELS = 1, SIGNAL_VOLUME = 2;

const int GROUP = 16;
layout(local_size_x = GROUP, local_size_y = GROUP) in;
layout(binding = 0) uniform sampler2D testImage;
layout(binding = 1) uniform sampler2D referenceImage;
layout(binding = 2) uniform writeonly image2D mapImage;
layout(binding = 3, std430) writeonly buffer Sums { float sums[]; };
layout(constant_id = 10) const int SIGNAL = SIGNAL_LUMA;
layout(push_constant) uniform Frame { ivec2 size; } frame;

const int REACH = 5;
// exp(-i^2 / (2 1.5^2)) / sum over -5..5, i = 0..5
const float GAUSS[REACH + 1] = float[](0.2660117248617943, 0.21300553771125366, 0.1093606895097, 0.03600077212843082,
                                       0.007598758135239184, 0.0010283800844791099);
const float C1 = 0.01 * 0.01, C2 = 0.03 * 0.03;  // (K1 L)^2, (K2 L)^2, L = 1

// Of s in x, of d in y.
struct Moments {
    vec2 mean, variance;
};

const int SIDE = GROUP + 2 * REACH;
shared vec2 signalTile[SIDE][SIDE];   // row, column: s, d
shared vec4 momentTile[SIDE][GROUP];  // mean, variance along x

// `precise` luma: equal pictures have d = 0 whatever the compiler fuses.
float signalOf(vec3 colour, int channel) {
    return SIGNAL == SIGNAL_LUMA ? lumaOf(colour, LUMA_REC601) : colour[channel];
}
void fetchSignal(int channel) {
    const ivec2 first = ivec2(gl_WorkGroupID.xy) * GROUP - REACH;
    for (int k = int(gl_LocalInvocationIndex); k < SIDE * SIDE; k += GROUP * GROUP) {
        const ivec2 q = ivec2(k % SIDE, k / SIDE);
        const float t = signalOf(texel(testImage, first + q).rgb, channel),
                    r = signalOf(texel(referenceImage, first + q).rgb, channel);
        signalTile[q.y][q.x] = vec2(t + r, t - r);
    }
}
Moments momentsAlongX(int row, int column) {
    const vec2 centre = signalTile[row][column];
    vec2 mean = centre * GAUSS[0];
    for (int i = 1; i <= REACH; i++)
        mean = mean + (signalTile[row][column - i] + signalTile[row][column + i]) * GAUSS[i];
    vec2 variance = (centre - mean) * (centre - mean) * GAUSS[0];
    for (int i = 1; i <= REACH; i++) {
        const vec2 a = signalTile[row][column - i] - mean, b = signalTile[row][column + i] - mean;
        variance = variance + (a * a + b * b) * GAUSS[i];
    }
    return Moments(mean, variance);
}
void gatherAlongX() {
    for (int k = int(gl_LocalInvocationIndex); k < SIDE * GROUP; k += GROUP * GROUP) {
        const Moments m = momentsAlongX(k / GROUP, k % GROUP + REACH);
        momentTile[k / GROUP][k % GROUP] = vec4(m.mean, m.variance);
    }
}
vec2 variancePart(vec4 row, vec2 mean) { return row.zw + (row.xy - mean) * (row.xy - mean); }
Moments momentsAlongY(int row, int column) {
    vec2 mean = momentTile[row][column].xy * GAUSS[0];
    for (int j = 1; j <= REACH; j++)
        mean = mean + (momentTile[row - j][column].xy + momentTile[row + j][column].xy) * GAUSS[j];
    vec2 variance = variancePart(momentTile[row][column], mean) * GAUSS[0];
    for (int j = 1; j <= REACH; j++)
        variance = variance + (variancePart(momentTile[row - j][column], mean) +
                               variancePart(momentTile[row + j][column], mean)) * GAUSS[j];
    return Moments(mean, variance);
}
// The third axis of a volume of three channels: tap o of channel c falls on channel clamp(c + o, 0, 2).
Moments momentsAcrossChannels(Moments m[3], int channel) {
    vec3 weight = vec3(0.0);
    for (int o = -REACH; o <= REACH; o++) weight[clamp(channel + o, 0, 2)] += GAUSS[abs(o)];
    const vec2 mean = m[0].mean * weight.x + m[1].mean * weight.y + m[2].mean * weight.z;
    vec2 variance = vec2(0.0);
    for (int k = 0; k < 3; k++) {
        const vec2 e = m[k].mean - mean;
        variance = variance + (m[k].variance + e * e) * weight[k];
    }
    return Moments(mean, variance);
}
float ssimOf(Moments m) {
    const vec2 mean2 = m.mean * m.mean;
    const float above = ((mean2.x - mean2.y) * 0.5 + C1) * ((m.variance.x - m.variance.y) * 0.5 + C2);
    const float below = ((mean2.x + mean2.y) * 0.5 + C1) * ((m.variance.x + m.variance.y) * 0.5 + C2);
    return above == below ? 1.0 : above / below;  // x / x need not be 1 on a device
}

void main() {
    const int channels = SIGNAL == SIGNAL_LUMA ? 1 : 3;
    Moments m[3];
    for (int channel = 0; channel < channels; channel++) {
        fetchSignal(channel);
        barrier();
        gatherAlongX();
        barrier();
        m[channel] = momentsAlongY(int(gl_LocalInvocationID.y) + REACH, int(gl_LocalInvocationID.x));
    }
    float ssim = 0.0;
    for (int channel = 0; channel < channels; channel++)
        ssim = ssim + ssimOf(SIGNAL == SIGNAL_VOLUME ? momentsAcrossChannels(m, channel) : m[channel]);
    if (SIGNAL != SIGNAL_LUMA) ssim = ssim == 3.0 ? 1.0 : ssim / 3.0;

    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    const bool inside = all(lessThan(p, frame.size));
    if (inside) imageStore(mapImage, p, vec4(ssim));
    const float sum = groupSum(inside ? ssim : 0.0);
    if (gl_LocalInvocationIndex == 0u) sums[groupNumber(frame.size.x, GROUP)] = sum;
}
