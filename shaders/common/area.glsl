// Areas under a revectorised edge, shared by the morphological methods ([Reshetov 2009], [Jimenez 2012]). x is the
// weight of a pixel for its neighbour's colour, y that of the neighbour for the pixel's.
#ifndef AA_AREA
#define AA_AREA

// Area between the base line and the segment (x1, y1)-(x2, y2) over the pixel [l, l + 1]: below it in x, above it in y.
// `precise`: a weight that is rounded to 8 bits falls on the same side of a half everywhere.
vec2 segmentArea(float x1, float y1, float x2, float y2, float l) {
    const float from = max(x1, l), to = min(x2, l + 1.0), length = to - from;
    if (!(length > 0.0)) return vec2(0.0);
    precise const float slope = (y2 - y1) / (x2 - x1), ya = y1 + slope * (from - x1), yb = y1 + slope * (to - x1);
    if (ya * yb >= 0.0) {
        precise const float area = (ya + yb) * 0.5 * length;
        return vec2(max(0.0, -area), max(0.0, area));
    }
    precise const float crossing = ya / (ya - yb);
    precise const float first = abs(ya) * crossing * length * 0.5, second = abs(yb) * (1.0 - crossing) * length * 0.5;
    return ya < 0.0 ? vec2(first, second) : vec2(second, first);
}
// Of a segment from height h at the one end of a line of d px to its middle, or from its middle to the other end.
vec2 firstHalf(float h, float d, float l) { return segmentArea(0.0, h, d * 0.5, 0.0, l); }
vec2 secondHalf(float h, float d, float l) { return segmentArea(d * 0.5, 0.0, d, h, l); }

#endif
