#include "methods/geometry/sraa_any.kernel.h"
#include "methods/geometry/sraa_plane.kernel.h"

// Most pixels lie on one plane with all pixels around them, and have the same weights. Only the others, whose planes,
// normals or objects differ, need weights of their own: lanes compute N of them together, wherever they lie.
namespace AA_ARCH {

template <class R>
struct Sraa {
    using Plane = SraaPlane<R>;
    const SraaArgs& a;
    const GeometryArgs& g = *a.geometry;
    SraaAny<R> any{a};
    Plane plane{a};

    using Limits = typename Plane::Limits;
    using Piece = typename Plane::Piece;
    using Waiting = typename SraaAny<R>::Waiting;

    AA_INLINE void hold(const Limits& f, Piece& p) const {
        using Apart = typename Plane::Apart;
        switch (plane.apart(f)) {
            case Apart::perspective:
                return plane.template hold<Apart::perspective>(f, p);
            case Apart::parallel:
                return plane.template hold<Apart::parallel>(f, p);
            case Apart::depth:
                return plane.template hold<Apart::depth>(f, p);
        }
    }
    template <int radius>
    AA_INLINE void resolve(const Limits& f, const Piece& p, Waiting& waiting) const {
        for (int i = 0; i < p.groups; i++) {
            const unsigned found = plane.onOnePlane(f, p, i);
            const long o = p.o + i * N<R>;
            if (found) plane.template resolve<radius>(f, found, o);
            if (found && a.ownShareLayer) store(f.share, a.ownShareLayer + o);
            any.take(waiting, ~found & ((1u << N<R>)-1u), p.x0 + i * N<R>, p.y);
        }
    }
    AA_INLINE void rows(int y0, int y1) const {
        if constexpr (N<R> == 1) {
            for (int y = y0; y < y1; y++)
                for (int x = 0; x < g.width; x++) any.one(x, y);
        } else {
            Limits f;
            plane.findLimits(f);
            Piece p;
            Waiting waiting;
            for (int y = y0; y < y1; y++) {
                if (f.any && y >= a.radius && y + a.radius < g.height) {
                    for (int x = 0; x < g.width; x += Plane::kPiece) {
                        p.x0 = x, p.y = y, p.groups = Plane::groupsOf(g.width - x);
                        p.o = long(y) * g.stride + x;
                        hold(f, p);
                        a.radius == 1 ? resolve<1>(f, p, waiting) : resolve<2>(f, p, waiting);
                    }
                } else {
                    any.resolveFirst(waiting);
                    for (int x = 0; x < g.width; x += N<R>) any.take(waiting, (1u << N<R>)-1u, x, y);
                    any.resolveFirst(waiting);
                }
            }
            any.resolveFirst(waiting);
        }
    }
};

template <class R>
__attribute__((flatten)) void sraaRows(const SraaArgs& a, int y0, int y1) {
    Sraa<R>{a}.rows(y0, y1);
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::SraaKernels, sraaKernels) = {AA_WIDE_ROWS(sraaRows)};
