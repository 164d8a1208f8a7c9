#include "methods/temporal/smaa_temporal_kernels.h"
#include "methods/temporal/temporal_reprojection.kernel.h"

namespace AA_ARCH {

template <class R>
struct Velocity {
    R x, y;
};
// Difference of two speeds by that of the velocities' squares: nothing is lost where they are nearly equal, which its
// root would show.
template <class R>
AA_INLINE R speedDifference(const SmaaTemporalArgs& a, Velocity<R> v, Velocity<R> w) {
    using T = Elem<R>;
    const R sx(T(a.scaleX)), sy(T(a.scaleY)), zero(T(0));
    const auto speed = [&](Velocity<R> u) __attribute__((always_inline)) {
        const R x = u.x * sx, y = u.y * sy;
        return sqrt(x * x + y * y);
    };
    const R squares = (v.x - w.x) * (v.x + w.x) * (sx * sx) + (v.y - w.y) * (v.y + w.y) * (sy * sy);
    const R sum = speed(v) + speed(w);
    return select(sum == zero, zero, abs(squares) / sum);
}
// Two frames count half each; less where the surface at the reprojected pixel moved at another speed, which means that
// it is another surface. Outside the previous frame, or with a motion that is no number, nothing is taken from it.
template <class R>
__attribute__((flatten)) void resolveRows(const SmaaTemporalArgs& a, int y0, int y1) {
    using T = Elem<R>;
    const R zero(T(0)), half(T(0.5)), one(T(1));
    TemporalIn in;
    in.stride = a.stride, in.width = a.width, in.height = a.height;
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += N<R>) {
            const long o = long(y) * a.stride + x;
            R weight = half;
            Reprojection<R> q{zero, zero, zero, zero, zero == zero};
            if (a.reproject) q = reproject(in, Motion<R>{load<R>(a.motionX + o), load<R>(a.motionY + o)}, x, y);
            const Offsets<R> at = nearestOffsetsWithin(in, q, x, y);
            if (a.reproject) {
                const R difference = speedDifference<R>(
                    a, {load<R>(a.velocityX + o), load<R>(a.velocityY + o)},
                    {gather<R>(a.previousVelocityX + o, at), gather<R>(a.previousVelocityY + o, at)});
                weight = select(q.inside, half * max(zero, one - R(T(a.rejection)) * sqrt(difference)), zero);
            }
            vec3<R> previous{gather<R>(a.previous.c[0] + o, at), gather<R>(a.previous.c[1] + o, at),
                             gather<R>(a.previous.c[2] + o, at)};
            // What is no number must not outlive its frame.
            weight = select(finite(previous), weight, zero);
            const vec3<R> own = load3<R>(a.current.c, o);
            const auto taken = weight > zero;
            store3(select(taken, own + (previous - own) * weight, own), a.out.c, o);
            if (a.weight) store(weight, a.weight + o);
        }
}

}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::SmaaTemporalKernels, smaaTemporalKernels) = {AA_WIDE_ROWS(resolveRows)};
