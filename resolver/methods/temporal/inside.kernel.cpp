#include "methods/temporal/inside.h"

#include "kernels/hash.h"
#include "methods/temporal/temporal_blocks.kernel.h"

namespace AA_ARCH {

// Four bilinear taps at (+-s, +-s): tap(-1, -1) and so on. s = 0.5 px under motion, up to 0.6666 at rest.
template <class R>
struct FourTaps {
    Box<R> box;
    vec3<R> mean;
};
template <class R, class Tap>
AA_INLINE FourTaps<R> fourTaps(const Tap& tap) {
    const vec3<R> a = tap(-1, -1), b = tap(1, -1), d = tap(-1, 1), e = tap(1, 1);
    return {{min(min(a, b), min(d, e)), max(max(a, b), max(d, e))},
            a + ((b - a) + (d - a) + (e - a)) * R(Elem<R>(0.25))};
}

// The current colours at p + (dx, dy), bilinear, held to the picture.
template <class R>
AA_INLINE vec3<R> colorAt(const TemporalIn& in, R dx, R dy, int x, int y) {
    const Reprojection<R> q = displacedWithinReach(in, dx, dy, both(dx == dx, dy == dy), x, y);
    const Offsets<R> k = texelOffsets(q, in.stride);
    const auto channel = [&](const float* p) __attribute__((always_inline)) {
        const R top = mix(gather<R>(p, k), gather<R>(p + 1, k), q.fracX),
                bottom = mix(gather<R>(p + in.stride, k), gather<R>(p + in.stride + 1, k), q.fracX);
        return mix(top, bottom, q.fracY);
    };
    const long o = long(y) * in.stride + x;
    return {channel(in.color.c[0] + o), channel(in.color.c[1] + o), channel(in.color.c[2] + o)};
}
// What the screen shows: seven taps along the motion of the current frame, offset by chance, instead of the result
// where motion is fast (2 px: none of it, 15 px: all).
template <class R>
AA_INLINE vec3<R> blurredByMotion(const InsideArgs& a, Motion<R> motion, vec3<R> result, int x, int y) {
    using T = Elem<R>;
    const R zero(T(0));
    const R speed = sqrt(motion.x * motion.x + motion.y * motion.y);
    const R share = clamp(speed - R(T(2)), zero, R(T(13))) * R(T(1) / T(13));
    const R step = R(T(a.motionBlur) * T(0.5) / T(3));
    const R chance = noise<R>(noiseSeed(NoiseStream::motionBlur, a.frame, uint32_t(y)), uint32_t(x)) - R(T(0.5));
    const R ownX(a.unjitterColor ? -T(a.in.jitterXPx) : T(0)), ownY(a.unjitterColor ? -T(a.in.jitterYPx) : T(0));
    vec3<R> sum(zero);
    for (int tap = -3; tap <= 3; tap++) {
        const R at = (R(T(tap)) + chance) * step;
        sum = sum + (colorAt(a.in, ownX + motion.x * at, ownY + motion.y * at, x, y) - result);
    }
    const vec3<R> blurred = result + sum * (share * R(T(1) / T(7)));
    // A motion of more than two pictures is no motion (conventions 9).
    const auto known = both(abs(motion.x) <= R(T(2 * a.in.width)), abs(motion.y) <= R(T(2 * a.in.height)));
    return select(both(known, both(share > zero, finite(blurred))), blurred, result);
}

// The frame's colour at pixel o.
template <class R>
AA_INLINE vec3<R> colorOf(const TemporalIn& in, const UniformFetch<R>& unjittered, bool unjitter, long o) {
    if (!unjitter) return load3<R>(in.color.c, o);
    return {unjittered(in.color.c[0] + o, in.stride), unjittered(in.color.c[1] + o, in.stride),
            unjittered(in.color.c[2] + o, in.stride)};
}
template <class R>
AA_INLINE void insidePixel(const InsideArgs& a, bool ycocg, bool unjitterWindow, int x, int y) {
    using T = Elem<R>;
    const TemporalIn& in = a.in;
    const long o = long(y) * in.stride + x;
    const UniformFetch<R> unjittered(-in.jitterXPx, -in.jitterYPx);
    const auto fetch = [&](bool unjitter, int i, int j) __attribute__((always_inline)) {
        return colorOf<R>(in, unjittered, unjitter, o + long(j) * in.stride + i);
    };
    const auto space = [&](vec3<R> c) __attribute__((always_inline)) { return ycocg ? toYcocg(c) : c; };
    const auto luma = [&](vec3<R> c) __attribute__((always_inline)) { return ycocg ? c.x : luminance(c, a.luminance); };
    const vec3<R> currentRgb = fetch(a.unjitterColor, 0, 0), current = space(currentRgb);

    const Motion<R> motion = a.unjitterReprojection ? Motion<R>{unjittered(in.motionXPx + o, in.stride),
                                                                unjittered(in.motionYPx + o, in.stride)}
                                                    : dilatedMotion<R>(in, o);
    const Reprojection<R> q = reproject(in, motion, x, y);
    const vec3<R> past = fetchHistory(in, x, y, q), history = space(past);

    const auto at = [&](int i, int j) __attribute__((always_inline)) { return space(fetch(unjitterWindow, i, j)); };
    const bool varying = a.neighbourhood == InsideNeighbourhood::fourTapVarying;
    const Neighbourhood kind = Neighbourhood(int(a.neighbourhood));  // unless varying
    const auto taps = [&]() __attribute__((always_inline)) {
        const R speed = sqrt(motion.x * motion.x + motion.y * motion.y);
        // 0 * 1e10 is 0, and a far surface at any speed counts as moving (conventions 11).
        const R still = saturate(R(T(0.5)) / max(speed * dilatedDepth<R>(in, o), R(T(1e-6))));
        const R s = R(T(0.5)) + still * R(T(0.1666));
        if (unjitterWindow)
            return fourTaps<R>([&](int i, int j) __attribute__((always_inline)) {
                return space(colorAt(in, R(T(i)) * s - R(T(in.jitterXPx)), R(T(j)) * s - R(T(in.jitterYPx)), x, y));
            });
        const Window<R> window(at);
        return fourTaps<R>([&](int i, int j) __attribute__((always_inline)) {
            const vec3<R> near = mix(window(0, 0), window(i, 0), s), far = mix(window(0, j), window(i, j), s);
            return mix(near, far, s);
        });
    };
    Box<R> box = varying ? taps().box : neighbourBox<R>(at, kind);
    if (ycocg) {
        const R chroma = (box.hi.x - box.lo.x) * R(T(0.125));
        box.lo = {box.lo.x, current.y - chroma, current.z - chroma};
        box.hi = {box.hi.x, current.y + chroma, current.z + chroma};
    }
    const auto mean = [&]() __attribute__((always_inline)) {
        const vec3<R> m = varying ? taps().mean : meanOf(neighbourMeans<R>(at), kind);
        return ycocg ? vec3<R>{m.x, current.y, current.z} : m;
    };
    const vec3<R> held = constrain(box, a.clipTarget, mean, current, history);
    const R k = min(luminanceFeedback(luma(current), luma(held), a.kMin, a.kMax), R(T(in.feedbackCeiling)));
    const vec3<R> mixed = blend(current, held, k);
    const vec3<R> rgb = ycocg ? saturate(fromYcocg(mixed)) : mixed;

    const vec3<R> result = sanitised(select(q.inside, rgb, currentRgb), load3<R>(in.color.c, o), past);
    storeBlend(in, x, y, result, R(T(1)));
    if (a.motionBlur > 0) store3(blurredByMotion(a, motion, result, x, y), in.out.c, o);
    storeDebug(in.debug, o, motion, q.inside, box, held - history, k);
}
template <class R>
__attribute__((flatten)) void insideRows(const InsideArgs& a, int y0, int y1) {
    const auto rows = [&](auto usual) __attribute__((always_inline)) {
        const bool ycocg = !usual && a.ycocg, unjitterWindow = !usual && a.unjitterNeighbourhood;
        for (int y = y0; y < y1; y++)
            for (int x = 0; x < a.in.width; x += N<R>)
                if (a.in.history)
                    insidePixel<R>(a, ycocg, unjitterWindow, x, y);
                else
                    storeFirst<R>(a.in, x, y,
                                  colorOf<R>(a.in, UniformFetch<R>(-a.in.jitterXPx, -a.in.jitterYPx), a.unjitterColor,
                                             long(y) * a.in.stride + x),
                                  R(Elem<R>(1)));
    };
    withOptions<R>(rows, !a.ycocg && !a.unjitterNeighbourhood);
}

}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::InsideKernels, insideKernels) = {AA_WIDE_ROWS(insideRows)};
