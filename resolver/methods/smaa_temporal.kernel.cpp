#include "kernels/lanes.h"
#include "methods/smaa_temporal_kernels.h"

namespace AA_ARCH {
using namespace aa;

template <class T>
AA_INLINE T speed(const SmaaTemporalArgs& a, const float* x, const float* y, long o) {
    const T vx = T(x[o]) * T(a.scaleX), vy = T(y[o]) * T(a.scaleY);
    return sqrt(vx * vx + vy * vy);
}
// Two frames count half each; less where the surface at the reprojected pixel moved at another speed, which means that
// it is another surface. Outside the previous frame, or with a motion that is no number, nothing is taken from it.
template <class R>
__attribute__((flatten)) void resolveRows(const SmaaTemporalArgs& a, int y0, int y1) {
    using T = Elem<R>;
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x++) {
            const long o = long(y) * a.stride + x;
            long p = o;
            T weight = T(0.5);
            if (a.reproject) {
                const T px = T(x) + T(0.5) - T(a.motionX[o]), py = T(y) + T(0.5) - T(a.motionY[o]);
                if (px >= T(0) && px <= T(a.width) && py >= T(0) && py <= T(a.height)) {
                    const int qx = int(px) < a.width ? int(px) : a.width - 1,
                              qy = int(py) < a.height ? int(py) : a.height - 1;
                    p = long(qy) * a.stride + qx;
                    const T difference = abs(speed<T>(a, a.velocityX, a.velocityY, o) -
                                             speed<T>(a, a.previousVelocityX, a.previousVelocityY, p));
                    weight = T(0.5) * max(T(0), T(1) - T(a.rejection) * sqrt(difference));
                } else {
                    weight = T(0);
                }
            }
            for (int c = 0; c < 3; c++)  // what is no number must not outlive its frame
                if (!(abs(T(a.previous.c[c][p])) <= T(3e38))) weight = T(0);
            for (int c = 0; c < 3; c++) {
                const T own = a.current.c[c][o];
                a.out.c[c][o] = float(weight > T(0) ? own + (T(a.previous.c[c][p]) - own) * weight : own);
            }
            if (a.weight) a.weight[o] = float(weight);
        }
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::SmaaTemporalKernels, smaaTemporalKernels) = {AA_WIDE_ROWS(resolveRows)};
