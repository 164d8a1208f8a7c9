// A history's colours as a narrower store would hold them, measured in 32 bits: binary16 or codes of 1/255, rounded to
// nearest or, with DITHER, up or down by chance so that the mean is kept ([Pedersen 2016]). An engine needs no such
// pass: its formats do this.
//
//   binding 0  history  image RGBA 32F, read and written; alpha stays as it is
//   constant 10 BYTE: 8 bits instead of 16;  11 DITHER
//   push constants: size, px; frameNumber of the frame that wrote it
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/noise.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba32f) uniform image2D history;
layout(constant_id = 10) const bool BYTE = false;
layout(constant_id = 11) const bool DITHER = false;
layout(push_constant) uniform Frame {
    ivec2 size;
    uint frameNumber;
} frame;

float asHalf(float x, float chance) {
    const float held = clamp(x, -65504.0, 65504.0);
    if (abs(held) < 1.0 / 16384.0) {  // subnormal: multiples of 2^-24
        const float units = held * 16777216.0;
        return (DITHER ? floor(units + chance) : roundEven(units)) * (1.0 / 16777216.0);
    }
    uint bits = floatBitsToUint(held);
    bits += DITHER ? uint(chance * 8192.0) : 0xfffu + ((bits >> 13) & 1u);
    return clamp(uintBitsToFloat(bits & ~0x1fffu), -65504.0, 65504.0);
}
float asByte(float x, float chance) {
    return min(floor(clamp(x, 0.0, 1.0) * 255.0 + (DITHER ? chance : 0.5)), 255.0) / 255.0;
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    const uint seed = noiseSeed(NOISE_HISTORY_DITHER, frame.frameNumber, uint(p.y));
    vec4 c = imageLoad(history, p);
    for (int i = 0; i < 3; i++) {
        const float chance = DITHER ? noise(seed, uint(4 * p.x + i)) : 0.0;
        c[i] = BYTE ? asByte(c[i], chance) : asHalf(c[i], chance);
    }
    imageStore(history, p, c);
}
