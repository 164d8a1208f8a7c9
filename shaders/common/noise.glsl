// White noise by place and time, the same on every machine: a bijection of 32-bit words whose output bits each depend on
// every input bit ([Wellons 2018], lowbias32).
#ifndef AA_NOISE
#define AA_NOISE

uint mixedBits(uint h) {
    h ^= h >> 16;
    h *= 0x7feb352du;
    h ^= h >> 15;
    h *= 0x846ca68bu;
    return h ^ (h >> 16);
}
const uint NOISE_HISTORY_DITHER = 0u, NOISE_MOTION_BLUR = 1u;
uint noiseSeed(uint stream, uint frame, uint row) { return mixedBits(mixedBits(frame * 2u + stream) + row); }
float noise(uint seed, uint i) { return float(mixedBits(seed + i) >> 8) * (1.0 / 16777216.0); }

#endif
