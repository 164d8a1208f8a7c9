// What mlaa's first passes share: the edges of the picture, one bit each, so that a search looks at 32 pixels at once.
// The edges above pixels lie row by row, those to the left of pixels column by column: lines of both follow words.
// Outside the picture there are none.
//
//   binding                    format           holds
//   0  colourImage   texture   RGBA 16F / 32F   the picture, encoded
//   1  topBits       buffer                     a pixel and the one above differ: (width + 31) / 32 words per row
//   2  leftBits      buffer                     a pixel and its left neighbour differ: (height + 31) / 32 per column
//
//   push constants             unit
//   size                       px
#ifndef AA_MLAA
#define AA_MLAA
#include "image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D colourImage;
layout(std430, binding = 1) buffer TopBits {
    uint topBits[];
};
layout(std430, binding = 2) buffer LeftBits {
    uint leftBits[];
};
layout(push_constant) uniform Frame {
    ivec2 size;
} frame;

vec3 colourAt(ivec2 p) { return texel(colourImage, p).rgb; }

// Lines along rows follow topBits and are crossed by leftBits; lines along columns the other way round. A position on
// either is `line`, the row or column, and `at`, the pixel in it.
const int ROWS = 0, COLUMNS = 1;
int wordsOf(int axis) { return ((axis == ROWS ? frame.size.x : frame.size.y) + 31) / 32; }
int linesOf(int axis) { return axis == ROWS ? frame.size.y : frame.size.x; }
uint wordAt(int axis, int line, int word) {
    if (line < 0 || line >= linesOf(axis) || word < 0 || word >= wordsOf(axis)) return 0u;
    const int i = line * wordsOf(axis) + word;
    return axis == ROWS ? topBits[i] : leftBits[i];
}
bool bitAt(int axis, int line, int at) { return (wordAt(axis, line, at >> 5) >> (at & 31) & 1u) != 0u; }
// Of the run of set bits that holds `at`.
int lastOfRun(int axis, int line, int at) {
    int word = at >> 5;
    uint gaps = ~wordAt(axis, line, word) & (~0u << (at & 31));
    while (gaps == 0u) gaps = ~wordAt(axis, line, ++word);
    return word * 32 + findLSB(gaps) - 1;
}
int firstOfRun(int axis, int line, int at) {
    int word = at >> 5;
    uint gaps = ~wordAt(axis, line, word) & (~0u >> (31 - (at & 31)));
    while (gaps == 0u) gaps = ~wordAt(axis, line, --word);
    return word * 32 + findMSB(gaps) + 1;
}

#endif
