// What CMAA2's passes know of a pixel, in one word: its edges, and the line that steps there from one side of the pixel
// to the other ([Strugar 2018]).
#ifndef AA_CMAA2
#define AA_CMAA2

// Its borders with an edge. Around the picture there are none.
const uint RIGHT = 1u, BOTTOM = 2u, LEFT = 4u, TOP = 8u, EDGES = 15u;

// A Z-shaped line whose step is the pixel's right border (horizontal) or its upper one (vertical).
struct ZShape {
    bool found, horizontal, inverted;
    int quality;      // 0 best to 3
    int left, right;  // lengths of the arms, px
};
uint packed(uint edges, ZShape z) {
    if (!z.found) return edges;
    return edges | 16u | (z.horizontal ? 32u : 0u) | (z.inverted ? 64u : 0u) | uint(z.quality) << 7 |
           uint(z.left) << 9 | uint(z.right) << 18;
}
ZShape shapeOf(uint word) {
    return ZShape((word & 16u) != 0u, (word & 32u) != 0u, (word & 64u) != 0u, int(word >> 7 & 3u),
                  int(word >> 9 & 511u), int(word >> 18 & 511u));
}
// Pixels 1 - (left + 1) / 2 to (right + 1) / 2 from the step are blended, to the right or up.
int firstBlended(ZShape z) { return 1 - (z.left + 1) / 2; }
int lastBlended(ZShape z) { return (z.right + 1) / 2; }
// The way to the right along the line.
ivec2 alongLine(bool horizontal) { return horizontal ? ivec2(1, 0) : ivec2(0, -1); }

// Two edges that meet: the pixel is a candidate.
bool hasCorner(uint edges) { return (edges & (edges << 1 | edges >> 3)) != 0u; }

#endif
