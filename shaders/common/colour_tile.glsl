// The current colours of a workgroup's pixels and of one more on each side, as colourAt() gives them, in shared
// memory: a 3 x 3 window un-jittered from textures would read 36 texels per pixel, this reads 2.
//
// Every invocation, those beyond the picture too, calls loadColourTile(), or the two functions of which it consists;
// then tileColour() and tileWindow() are its pixel's neighbours.
#ifndef AA_COLOUR_TILE
#define AA_COLOUR_TILE
#include "temporal.glsl"

const int COLOUR_SIDE = AA_GROUP + 2, TEXEL_SIDE = COLOUR_SIDE + 1;  // and one more, for bilinear filtering
shared vec3 texelTile[TEXEL_SIDE * TEXEL_SIDE];
shared vec3 colourTile[COLOUR_SIDE * COLOUR_SIDE];

void fetchTexelTile() {
    const ivec2 first = ivec2(gl_WorkGroupID.xy) * AA_GROUP - 1 + ivec2(floor(frame.readOffset));
    for (int k = int(gl_LocalInvocationIndex); k < TEXEL_SIDE * TEXEL_SIDE; k += AA_GROUP * AA_GROUP)
        texelTile[k] = texel(currentImage, first + ivec2(k % TEXEL_SIDE, k / TEXEL_SIDE)).rgb;
}
// After a barrier; before the next one.
void unjitterColourTile() {
    const vec2 f = fract(frame.readOffset);
    for (int k = int(gl_LocalInvocationIndex); k < COLOUR_SIDE * COLOUR_SIDE; k += AA_GROUP * AA_GROUP) {
        const int a = k / COLOUR_SIDE * TEXEL_SIDE + k % COLOUR_SIDE, b = a + TEXEL_SIDE;
        const vec3 top = lerpExact(texelTile[a], texelTile[a + 1], f.x);
        const vec3 bottom = lerpExact(texelTile[b], texelTile[b + 1], f.x);
        colourTile[k] = lerpExact(top, bottom, f.y);
    }
}
void loadColourTile() {
    fetchTexelTile();
    barrier();
    unjitterColourTile();
    barrier();
}
// Of the invocation's pixel (x, y): the colour of (x + i, y + j), -1 <= i, j <= 1.
vec3 tileColour(int i, int j) {
    return colourTile[(int(gl_LocalInvocationID.y) + 1 + j) * COLOUR_SIDE + int(gl_LocalInvocationID.x) + 1 + i];
}
void tileWindow(out vec3 window[9]) {
    for (int k = 0; k < 9; k++) window[k] = tileColour(k % 3 - 1, k / 3 - 1);
}

#endif
