// Areas under a revectorised edge, shared by the morphological methods ([Reshetov 2009], [Jimenez 2012]).
#pragma once
#include "kernels/lanes.h"

namespace AA_ARCH {

template <class T>
struct Pair {
    T own, opposite;  // weight of the pixel for its neighbour's colour, and the other way round
};
template <class T>
AA_INLINE Pair<T> operator+(Pair<T> a, Pair<T> b) {
    return {a.own + b.own, a.opposite + b.opposite};
}

// Area between the base line and the segment (x1, y1)-(x2, y2) over the pixel [l, l + 1]: below it to `own`, above to
// `opposite`.
template <class T>
AA_INLINE Pair<T> segmentArea(T x1, T y1, T x2, T y2, T l) {
    const T from = max(x1, l), to = min(x2, l + T(1)), length = to - from;
    if (!(length > T(0))) return {T(0), T(0)};
    const T slope = (y2 - y1) / (x2 - x1), ya = y1 + slope * (from - x1), yb = y1 + slope * (to - x1);
    if (ya * yb >= T(0)) {
        const T area = (ya + yb) * T(0.5) * length;
        return {max(T(0), -area), max(T(0), area)};
    }
    const T crossing = ya / (ya - yb);
    const T first = abs(ya) * crossing * length * T(0.5), second = abs(yb) * (T(1) - crossing) * length * T(0.5);
    return ya < T(0) ? Pair<T>{first, second} : Pair<T>{second, first};
}
template <class T>
AA_INLINE Pair<T> firstHalf(T h, T d, T l) {
    return segmentArea(T(0), h, d * T(0.5), T(0), l);
}
template <class T>
AA_INLINE Pair<T> secondHalf(T h, T d, T l) {
    return segmentArea(d * T(0.5), T(0), d, h, l);
}

}  // namespace AA_ARCH
