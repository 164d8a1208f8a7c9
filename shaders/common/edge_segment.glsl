// The edges of gpaa: projected segments of the scene's geometry, and where one touches a pixel.
//
// precise: passes that meet at a pixel must find the same bits there, whatever products a driver fuses into sums.
#ifndef AA_EDGE_SEGMENT
#define AA_EDGE_SEGMENT
#include "image.glsl"

struct EdgeSegment {
    float x0, y0, z0, x1, y1, z1;  // ends: px in the un-jittered picture, y down; planar view z > 0
};
// Seen from the centre of pixel (0, y) of a row.
struct Line {
    float x0, y0, dx, dy, length2;
    bool horizontal;  // mostly; otherwise mostly vertical
};
// A jittered frame shows everything displaced by -jitter, and so does the list then.
Line lineOf(EdgeSegment s, vec2 jitter, int y) {
    precise float x0 = s.x0 - jitter.x - 0.5;
    precise float y0 = s.y0 - jitter.y - (float(y) + 0.5);
    precise float dx = s.x1 - s.x0;
    precise float dy = s.y1 - s.y0;
    precise float length2 = dx * dx + dy * dy;
    return Line(x0, y0, dx, dy, length2, abs(dx) > abs(dy));
}
// Distance along the minor axis from the centre of pixel x to the line.
float minorDistance(Line l, int x) {
    precise float s =
        l.horizontal ? l.y0 + (float(x) - l.x0) * (l.dy / l.dx) : l.x0 - float(x) - l.y0 * (l.dx / l.dy);
    return s;
}
// Where the centre of pixel x projects: 0 and 1 are the ends.
float along(Line l, int x) {
    precise float t = ((float(x) - l.x0) * l.dx - l.y0 * l.dy) / l.length2;
    return t;
}
// Or half a pixel beyond them.
bool reaches(Line l, float t) {
    const float over = 0.5 / sqrt(l.length2);
    return t >= -over && t <= 1.0 + over;  // false for NaN
}
// How much of the pixel lies beyond a line at minor distance s.
float covered(float s) {
    precise float c = 0.5 - abs(s);
    return c;
}
// s = 0 blends toward +: to the right or down.
bool afterSide(float s) { return s >= 0.0; }

#endif
