#include "methods/geometry/gpaa.h"

#include "kernels/lanes.h"
#include "kernels/resample.h"

namespace AA_ARCH {
using namespace aa;

// A segment seen from the centre of pixel (0, y) of a row: scalar, T is float or double.
template <class T>
struct GpaaLine {
    T x0, y0, dx, dy, length2, z0, z1;
    bool horizontal;

    AA_INLINE GpaaLine(const GpaaArgs& a, const EdgeSegment& s, int y)
        : x0(T(s.x0) - T(a.jitterXPx) - T(0.5)),
          y0(T(s.y0) - T(a.jitterYPx) - (T(y) + T(0.5))),
          dx(T(s.x1) - T(s.x0)),
          dy(T(s.y1) - T(s.y0)),
          length2(dx * dx + dy * dy),
          z0(T(s.z0)),
          z1(T(s.z1)),
          horizontal(abs(dx) > abs(dy)) {}
    // Distance along the minor axis from the centre of pixel x to the line.
    AA_INLINE T distance(int x) const { return horizontal ? y0 + (T(x) - x0) * (dy / dx) : x0 - T(x) - y0 * (dx / dy); }
    // Where the centre projects: 0 and 1 are the ends.
    AA_INLINE T along(int x) const { return ((T(x) - x0) * dx - y0 * dy) / length2; }
    AA_INLINE bool reaches(T t) const {
        const T over = T(0.5) / sqrt(length2);
        return t >= -over && t <= T(1) + over;  // false for NaN
    }
    AA_INLINE T depthAt(T t, bool perspective) const {
        const T one(1), u = clamp(t, T(0), one);
        return perspective ? one / ((one - u) / z0 + u / z1) : (one - u) * z0 + u * z1;
    }
};

template <class R>
struct Gpaa {
    using T = Elem<R>;
    const GpaaArgs& a;

    AA_INLINE bool hidden(const GpaaLine<T>& line, T t, bool onAfterSide, long o) const {
        if (!a.depthView) return false;
        const long step = line.horizontal ? a.stride : 1;
        T shown = T(a.depthView[o]);
        if (a.farther) shown = max(shown, T(a.depthView[onAfterSide ? o + step : o - step]));
        return !(line.depthAt(t, a.perspective) <= shown * T(a.depthLimit));
    }
    AA_INLINE void touch(const GpaaLine<T>& line, int x, int y) const {
        const T s = line.distance(x), covered = T(0.5) - abs(s), t = line.along(x);
        if (!(covered > T(0)) || !line.reaches(t)) return;
        const long o = long(y) * a.stride + x;
        const bool after = s >= T(0);  // to the right of or below the centre, or on it
        if (hidden(line, t, after, o)) return;
        // What stands there comes from an earlier segment: its shift is the larger, the nearer it passes.
        if (a.keepNearest && !(covered > max(abs(T(a.shiftXPx[o])), abs(T(a.shiftYPx[o]))))) return;
        const float shift = float(after ? covered : -covered);
        a.shiftXPx[o] = line.horizontal ? 0.0f : shift;
        a.shiftYPx[o] = line.horizontal ? shift : 0.0f;
    }
    AA_INLINE void draw(const EdgeSegment& segment, int y) const {
        const GpaaLine<T> line(a, segment, y);
        // The columns that it can touch; NaN of a line parallel to the row leaves its ends.
        T from = min(line.x0, line.x0 + line.dx) - T(1), to = max(line.x0, line.x0 + line.dx) + T(1);
        const T crossing = line.x0 - line.y0 * (line.dx / line.dy), half = T(1) + T(0.5) * abs(line.dx / line.dy);
        from = max(max(from, crossing - half), T(0)), to = min(min(to, crossing + half), T(a.width - 1));
        if (!(from <= to)) return;
        for (int x = int(from); x <= int(to); x++) touch(line, x, y);
    }
    AA_INLINE void clear(int y) const {
        const R zero(T(0));
        for (int x = 0; x < a.width; x += N<R>) {
            store(zero, a.shiftXPx + long(y) * a.stride + x);
            store(zero, a.shiftYPx + long(y) * a.stride + x);
        }
    }
    AA_INLINE void fetch(int y) const {
        const R zero(T(0));
        for (int x = 0; x < a.width; x += N<R>) {
            const long o = long(y) * a.stride + x;
            for (int c = 0; c < 3; c++) store(load<R>(a.color.c[c] + o), a.out.c[c] + o);
            const R dx = load<R>(a.shiftXPx + o), dy = load<R>(a.shiftYPx + o);
            unsigned moved = ~maskBits<R>(both(dx == zero, dy == zero)) & ((1u << N<R>)-1u);
            for (int i = 0; moved >> i; i++) {
                if (!(moved >> i & 1u) || x + i >= a.width) continue;
                const vec3<T> c = resample<T>(a.color, a.stride, x + i, y, T(a.shiftXPx[o + i]), T(a.shiftYPx[o + i]));
                a.out.c[0][o + i] = float(c.x), a.out.c[1][o + i] = float(c.y), a.out.c[2][o + i] = float(c.z);
            }
        }
    }
    AA_INLINE void rows(int y0, int y1) const {
        for (int y = y0; y < y1; y++) {
            clear(y);
            for (uint32_t i = a.firstOfRow[y]; i < a.firstOfRow[y + 1]; i++) draw(a.segments[a.ofRow[i]], y);
            fetch(y);
        }
    }
};

template <class R>
__attribute__((flatten)) void gpaaRows(const GpaaArgs& a, int y0, int y1) {
    Gpaa<R>{a}.rows(y0, y1);
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::GpaaKernels, gpaaKernels) = {AA_ROWS(gpaaRows)};
