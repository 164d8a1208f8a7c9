// What both ways of sraa share: weights by place alone, and the colour of a pixel. Included by *.kernel.cpp files.
#pragma once
#include "kernels/lanes.h"
#include "kernels/math.h"
#include "kernels/subsamples.h"
#include "methods/geometry/sraa.h"

namespace AA_ARCH {
using namespace aa;

template <class R>
struct SraaBase {
    using T = Elem<R>;
    const SraaArgs& a;
    const GeometryArgs& g;
    static constexpr int kMostTaps = 25, kMostSamples = 64;

    AA_INLINE explicit SraaBase(const SraaArgs& args) : a(args), g(*args.geometry) {}
    static AA_INLINE R unusable() { return R(T(-1e9)); }  // the log of weight 0
    AA_INLINE T spatial(float stepX, float stepY) const {
        return a.maxMetric ? T(0) : (T(stepX) * T(stepX) + T(stepY) * T(stepY)) * T(a.spatial);
    }
    // A dark result beside a bright own colour is rounded, which must not make light negative.
    AA_INLINE R lit(R own, R sum) const { return max(own + sum / R(T(g.samples)), R(T(0))); }
};

}  // namespace AA_ARCH
