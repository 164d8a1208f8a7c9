// Boxes of the colours around a pixel. window[(j + 1) * 3 + i + 1] is the colour of the neighbour (x + i, y + j).
#ifndef AA_NEIGHBOURHOOD
#define AA_NEIGHBOURHOOD

struct Box {
    vec3 low, high;
};
struct Neighbours {  // of the 3 x 3 window and of its plus-shaped part
    Box square, plus;
    vec3 meanSquare, meanPlus;
};
Neighbours neighbours(vec3 window[9]) {
    const vec3 c = window[4], w = window[3], e = window[5], n = window[1], s = window[7];
    Neighbours b;
    b.plus = Box(min(min(min(c, w), min(e, n)), s), max(max(max(c, w), max(e, n)), s));
    // Means as deviations from the centre: a constant window has exactly its value.
    const vec3 around = (w - c) + (e - c) + ((n - c) + (s - c));
    const vec3 nw = window[0], ne = window[2], sw = window[6], se = window[8];
    b.square = Box(min(b.plus.low, min(min(nw, ne), min(sw, se))), max(b.plus.high, max(max(nw, ne), max(sw, se))));
    b.meanPlus = c + around * (1.0 / 5.0);
    b.meanSquare = c + (around + ((nw - c) + (ne - c) + ((sw - c) + (se - c)))) * (1.0 / 9.0);
    return b;
}
// By number: "rounded", the mean of both windows' bounds [Pedersen 2016]; 3 x 3; plus.
const int NEIGHBOURHOOD_ROUNDED = 0, NEIGHBOURHOOD_3X3 = 1, NEIGHBOURHOOD_PLUS = 2;
Box boxOf(Neighbours b, int kind) {
    if (kind == NEIGHBOURHOOD_3X3) return b.square;
    if (kind == NEIGHBOURHOOD_PLUS) return b.plus;
    return Box((b.square.low + b.plus.low) * 0.5, (b.square.high + b.plus.high) * 0.5);
}
vec3 meanOf(Neighbours b, int kind) {
    if (kind == NEIGHBOURHOOD_3X3) return b.meanSquare;
    if (kind == NEIGHBOURHOOD_PLUS) return b.meanPlus;
    return (b.meanSquare + b.meanPlus) * 0.5;
}

struct Moments {
    vec3 mean, sigma;
};
// About the centre colour: E[x^2] - mean^2 loses all digits of bright windows.
Moments moments(vec3 window[9]) {
    const vec3 c = window[4];
    vec3 m1 = vec3(0.0), m2 = vec3(0.0);
    for (int k = 0; k < 9; k++) {
        if (k == 4) continue;
        const vec3 d = window[k] - c;
        m1 = m1 + d;
        m2 = m2 + d * d;
    }
    const vec3 shift = m1 * (1.0 / 9.0);
    return Moments(c + shift, sqrt(max(m2 * (1.0 / 9.0) - shift * shift, vec3(0.0))));
}
Box varianceBox(Moments m, float gamma) { return Box(m.mean - m.sigma * gamma, m.mean + m.sigma * gamma); }

#endif
