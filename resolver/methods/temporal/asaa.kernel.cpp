#include "methods/temporal/asaa.h"

#include "methods/temporal/rejection.kernel.h"

namespace AA_ARCH {

// Displacement in px of the pixel's surface, were it static, into another camera.
template <class R>
AA_INLINE Motion<R> cameraDisplacement(const CameraPath& path, const TemporalIn& in, R depth, int x, int y) {
    using T = Elem<R>;
    const R zero(T(0));
    if (!path.moves) return {zero, zero};
    const R px = R(T(x) + T(0.5)) + iota<R>(), py(T(y) + T(0.5));
    R clip[3];
    for (int r = 0; r < 3; r++)
        clip[r] =
            depth * (px * R(T(path.perDepth[r][0])) + py * R(T(path.perDepth[r][1])) + R(T(path.perDepth[r][2]))) +
            (px * R(T(path.constant[r][0])) + py * R(T(path.constant[r][1])) + R(T(path.constant[r][2])));
    const R half(T(0.5)), scale = R(T(1)) / select(clip[2] > R(T(1e-12)), clip[2], R(T(__builtin_nanf(""))));
    return {(clip[0] * scale * half + half) * R(T(in.width)) - px,
            (half - clip[1] * scale * half) * R(T(in.height)) - py};
}

template <class R>
struct TentSum {
    vec3<R> color;
    R weight;
};
// The four samples around p + (dx, dy) in a buffer, weighted by a tent of radius (rx, ry) px.
template <class R>
AA_INLINE void addTent(const float* p, int stride, R dx, R dy, R rx, R ry, Mask<R> valid, TentSum<R>& sum) {
    using T = Elem<R>;
    const R zero(T(0)), one(T(1));
    Reprojection<R> q;
    q.wholeX = floor(dx), q.wholeY = floor(dy), q.fracX = dx - q.wholeX, q.fracY = dy - q.wholeY, q.inside = valid;
    const Offsets<R> k = texelOffsets(q, stride);
    const R ix = one / rx, iy = one / ry;
    const R wx[2] = {saturate(one - q.fracX * ix), saturate(one - (one - q.fracX) * ix)};
    const R wy[2] = {saturate(one - q.fracY * iy), saturate(one - (one - q.fracY) * iy)};
    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++) {
            const R w = select(valid, wx[i] * wy[j], zero);
            if (!maskBits<R>(w != zero)) continue;  // a narrow tent covers one sample of the four
            const vec3<R> c = fetchRgba<R>(p + 4l * (j * stride + i), k).rgb;
            sum.color = sum.color + select(w == zero, vec3<R>(zero), c * w);
            sum.weight = sum.weight + w;
        }
}

template <class R>
AA_INLINE void asaaPixel(const AsaaArgs& a, int x, int y) {
    using T = Elem<R>;
    const TemporalIn& in = a.in;
    const R zero(T(0)), one(T(1)), half(T(0.5));
    const long o = long(y) * in.stride + x;
    const vec3<R> sample = load3<R>(in.color.c, o);
    const R depth = load<R>(in.depthView + o);
    if (!a.anyHistory) {
        storeBlend(in, x, y, sanitised(sample, sample, vec3<R>(zero)), depth);
        store(one, a.nextCount + o);  // nothing was rejected: 0 + 1
        if (in.debug.rejection) store(R(T(int(Rejection::firstFrame))), in.debug.rejection + o);
        return;
    }
    const Motion<R> motion = loadMotion<R>(in, o);
    const MotionSlope<R> slope = motionSlope<R>(in, x, y);
    const Motion<R> camera = cameraDisplacement(a.lastFrame, in, depth, x, y);
    const Motion<R> own{-motion.x - camera.x, -motion.y - camera.y};  // of the object, px per frame

    // 2-4: both sums over the valid buffers
    TentSum<R> b{vec3<R>(zero), zero}, f{vec3<R>(zero), zero};
    Mask<R> anyValid = all<R>(false);
    for (const AsaaBuffer& buffer : a.buffer) {
        if (!buffer.rgba) continue;
        const R age(T(buffer.age));
        const Motion<R> path = cameraDisplacement(buffer.path, in, depth, x, y);
        const Motion<R> back{-(path.x + own.x * age), -(path.y + own.y * age)};  // as a motion: current - then
        const Reprojection<R> q = reproject(in, back, x, y);
        const float* p = buffer.rgba + 4 * o;
        const Footprint<R> covered = footprint(slope, age);
        const R expected = expectedPreviousDepth(buffer.expected, depth, x, y);
        Mask<R> valid = both(q.inside, negate(disoccluded(expected, fetchDepth(p, in.stride, q),
                                                          a.rejection.depthTolerance, a.rejection.bothSides)));
        if (a.rejection.magnification > 0)
            valid = both(valid, negate(magnified(q, covered, a.rejection.magnification)));
        if (!maskBits<R>(valid)) continue;
        anyValid = either(anyValid, valid);
        const R least(T(0.125)), most(T(1));  // the four nearest samples serve radii up to 1 px (decisions 23)
        const R rx = min(max(covered.x * half, least), most), ry = min(max(covered.y * half, least), most);
        const R dx = q.wholeX + q.fracX, dy = q.wholeY + q.fracY;
        addTent(p, in.stride, dx + R(T(a.phiX - buffer.phiX)), dy + R(T(a.phiY - buffer.phiY)), rx, ry, valid, b);
        addTent(p, in.stride, dx - R(T(buffer.phiX)), dy - R(T(buffer.phiY)), min(rx + rx, most), min(ry + ry, most),
                valid, f);
    }
    const auto hasB = b.weight > R(T(1e-6)), hasF = f.weight > R(T(1e-6));
    const auto hit = both(anyValid, either(hasB, hasF));
    const vec3<R> previousB = select(hasB, b.color / select(hasB, b.weight, one), sample);
    const vec3<R> previousF = select(hasF, f.color / select(hasF, f.weight, one), sample);

    // 5: weight of the current sample, 7: sample count
    const Reprojection<R> q = reproject(in, motion, x, y);
    const R count =
        a.countAtPixel ? load<R>(a.previousCount + o) : gather<R>(a.previousCount + o, nearestOffsets(q, in.stride));
    R alpha, nextCount;
    if (a.eq331) {
        const R vx = abs(motion.x) - floor(abs(motion.x)), vy = abs(motion.y) - floor(abs(motion.y));
        const R V = vx * (one - vx) + vy * (one - vy);
        const R bound = V / (V + R(T(2 * 0.12)));  // tau_b - sigma_G^2 = 0.12
        alpha = select(hit, max(one / (count + one), bound), one);
        // Eq 3.29. alpha is at least 2^-24 and N at least 1, as after a rejection (alpha = 1): neither term is
        // infinite.
        nextCount = one / (alpha * alpha + (one - alpha) * (one - alpha) / max(count, one));
    } else {
        const auto still = both(motion.x == zero, motion.y == zero);
        const R four(T(4)), used = select(still, count, a.fourInMotion ? four : min(count, four));
        alpha = select(hit, one / (used + one), one);
        nextCount = select(hit, used + one, zero);
    }

    // 6
    const vec3<R> updated = previousB + (sample - previousB) * alpha;
    const vec3<R> shown = previousF + (sample - previousF) * (alpha * R(T(0.25)));
    const vec3<R> next = sanitised(select(alpha == one, sample, updated), sample, vec3<R>(zero));
    storeRgba(next, depth, in.next + 4 * o);
    store3(sanitised(select(alpha == one, sample, shown), sample, next), in.out.c, o);
    store(min(nextCount, R(T(16777215))), a.nextCount + o);  // the last whole step of float
    if (!in.debug.rejection) return;
    storeDebug(in.debug, o, motion, hit, Box<R>{previousF, previousF}, vec3<R>(zero), one - alpha);
    store(select(hit, zero, select(q.inside, R(T(int(Rejection::disoccluded))), R(T(int(Rejection::outside))))),
          in.debug.rejection + o);
}
template <class R>
__attribute__((flatten)) void asaaRows(const AsaaArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.in.width; x += N<R>) asaaPixel<R>(a, x, y);
}

}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::AsaaKernels, asaaKernels) = {AA_WIDE_ROWS(asaaRows)};
