// The search of fxaa311 and fxaacs by a list of distances.
//
//   constant             default (preset 12)   means
//   10 STEPS             5                     distances in use
//   11 DISTANCE_0 ...    2 5 9 17 41           cumulative, in half pixels; the last is a jump whose end is not
//   22 DISTANCE_11       0                     sampled
#ifndef AA_FXAA_SEARCH
#define AA_FXAA_SEARCH
#include "fxaa.glsl"

layout(constant_id = 10) const int STEPS = 5;
layout(constant_id = 11) const int DISTANCE_0 = 2;
layout(constant_id = 12) const int DISTANCE_1 = 5;
layout(constant_id = 13) const int DISTANCE_2 = 9;
layout(constant_id = 14) const int DISTANCE_3 = 17;
layout(constant_id = 15) const int DISTANCE_4 = 41;
layout(constant_id = 16) const int DISTANCE_5 = 0;
layout(constant_id = 17) const int DISTANCE_6 = 0;
layout(constant_id = 18) const int DISTANCE_7 = 0;
layout(constant_id = 19) const int DISTANCE_8 = 0;
layout(constant_id = 20) const int DISTANCE_9 = 0;
layout(constant_id = 21) const int DISTANCE_10 = 0;
layout(constant_id = 22) const int DISTANCE_11 = 0;

// One way along the line, `step` = -1 or 1. Where nothing ends it, the last distance and what was read last.
void search(EdgeLine line, int step, out int endHalfPx, out bool below) {
    int distancesHalfPx[12] = int[](DISTANCE_0, DISTANCE_1, DISTANCE_2, DISTANCE_3, DISTANCE_4, DISTANCE_5, DISTANCE_6,
                                    DISTANCE_7, DISTANCE_8, DISTANCE_9, DISTANCE_10, DISTANCE_11);
    for (int k = 0; k + 1 < STEPS; k++) {
        endHalfPx = distancesHalfPx[k];
        const int at = step * (endHalfPx / 2);
        const float near = pairDifference(line, at);
        // Fourfold change of the pair's mean; between two pixels the mean of both.
        const float change = near + ((endHalfPx & 1) != 0 ? pairDifference(line, at + step) : near);
        below = change < 0.0;
        if (endsLine(line, change * 0.25)) return;
    }
    endHalfPx = distancesHalfPx[STEPS - 1];
}
LineEnds findEnds(EdgeLine line) {
    LineEnds ends;
    search(line, -1, ends.negativeHalfPx, ends.negativeBelow);
    search(line, 1, ends.positiveHalfPx, ends.positiveBelow);
    return ends;
}

#endif
