#include "kernels/sparse.h"
#include "methods/area.kernel.h"
#include "methods/mlaa_kernels.h"

namespace AA_ARCH {
using namespace aa;

template <class R>
AA_INLINE vec3<R> colour_at(const RgbIn& in, long o) {
    return {load<R>(in.c[0] + o), load<R>(in.c[1] + o), load<R>(in.c[2] + o)};
}
template <class R>
AA_INLINE vec3<R> four_highest_bits(vec3<R> c) {  // of the 8-bit code
    using T = Elem<R>;
    auto bits = [](R v) __attribute__((always_inline)) {
        return floor(floor(v * R(T(255)) + R(T(0.5))) * R(T(1.0 / 16)));
    };
    return {bits(c.x), bits(c.y), bits(c.z)};
}
template <class R>
AA_INLINE Mask<R> differ(vec3<R> a, vec3<R> b, MlaaRule rule) {
    using T = Elem<R>;
    if (rule == MlaaRule::msb4) return max_component(abs(four_highest_bits(a) - four_highest_bits(b))) >= R(T(0.5));
    if (rule == MlaaRule::luma) return abs(luma601(a) - luma601(b)) >= R(T(0.1));
    return max_component(abs(a - b)) >= R(T(1.0 / 16));
}
template <class R>
__attribute__((flatten)) void edgeRows(const MlaaEdgeArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += N<R>) {
            const long o = long(y) * a.stride + x;
            const vec3<R> c = colour_at<R>(a.in, o);
            store_mask_bytes<R>(differ(c, colour_at<R>(a.in, o - 1), a.rule),
                                differ(c, colour_at<R>(a.in, o - a.stride), a.rule),
                                a.edges + long(y) * a.edgeStride + x);
        }
}

// A separation line: a maximal run of top edges. Its silhouette leaves from half the height of the edges that cross its
// ends; 0 where none does.
struct Silhouette {
    int first, last;
    float left, right;
};
AA_INLINE Silhouette silhouette(const MlaaWeightArgs& a, const uint8_t* row, int first) {
    int last = first;
    while (row[last + 1] & kEdgeTop) last++;
    auto height = [&](int x) __attribute__((always_inline)) {  // +1/2 up, -1/2 down, 2 both
        const bool up = row[x - a.edgeStride] & kEdgeLeft, down = row[x] & kEdgeLeft;
        return up && down ? 2.0f : up ? 0.5f : down ? -0.5f : 0.0f;
    };
    float left = height(first), right = height(last + 1);
    if (left == 2) left = right == 2 ? 0 : -right;  // make a Z with the other end where there is one
    if (right == 2) right = -left;
    return {first, last, left, right};
}
template <class T>
AA_INLINE Pair<T> mlaa_area(const Silhouette& s, int x) {
    const T l = T(x - s.first), d = T(s.last - s.first + 1), left = T(s.left), right = T(s.right);
    if (left * right < T(0)) return segment_area(T(0), left, d, right, l);
    Pair<T> sum{T(0), T(0)};
    if (left != T(0)) sum = first_half(left, d, l);
    if (right != T(0)) sum = sum + second_half(right, d, l);
    return sum;
}
template <class R>
__attribute__((flatten)) void weightRows(const MlaaWeightArgs& a, int y0, int y1) {
    using T = Elem<R>;
    for (int y = y0; y < y1; y++) {
        const uint8_t* const row = a.edges + long(y) * a.edgeStride;
        Silhouette line{0, -1, 0, 0};
        for (int x0 = 0; x0 < a.width; x0 += 8)
            for_each_byte(
                load_bytes(row + x0), [&](int i) __attribute__((always_inline)) {
                    const int x = x0 + i;
                    if (x >= a.width) return;
                    const uint8_t e = row[x];
                    if (e & kEdgeTop) {
                        if (x > line.last) line = silhouette(a, row, x);
                        const Pair<T> w = mlaa_area<T>(line, x);
                        const long at = x * a.weightAlong + y * a.weightAcross;
                        a.weights[2 * at] = float(w.own);
                        a.weights[2 * at + 1] = float(w.opposite);
                        if (a.shapes) {
                            const float product = line.left * line.right;
                            a.shapes[at] = product < 0                   ? 2.0f
                                           : product > 0                 ? 3.0f
                                           : line.left + line.right != 0 ? 1.0f
                                                                         : 0.0f;
                        }
                    }
                    if (a.transposed)
                        a.transposed[long(x) * a.transposedStride + y] =
                            uint8_t((e & kEdgeTop ? kEdgeLeft : 0) | (e & kEdgeLeft ? kEdgeTop : 0));
                });
    }
}

template <class T>
AA_INLINE void blend_pixel(const MlaaBlendArgs& a, long o, T toFirst, T toSecond, const T first[3], const T second[3]) {
    for (int c = 0; c < 3; c++) {
        const T own = a.out.c[c][o];
        a.out.c[c][o] = float(own + toFirst * (first[c] - own) + toSecond * (second[c] - own));
    }
}
// Horizontal lines blend the original rows; vertical lines blend the row that this gives.
template <class R>
__attribute__((flatten)) void blendRows(const MlaaBlendArgs& a, int y0, int y1) {
    using T = Elem<R>;
    constexpr uint64_t every = 0x0101010101010101ull;
    for (int y = y0; y < y1; y++) {
        for (int c = 0; c < 3; c++)
            for (int x = 0; x < a.width; x += N<R>) {
                const long o = long(y) * a.stride + x;
                store(load<R>(a.in.c[c] + o), a.out.c[c] + o);
            }
        const uint8_t *const row = a.edges + long(y) * a.edgeStride, *const below = row + a.edgeStride;
        const float* const top = a.topWeights + 2l * y * a.width;
        const float* const left = a.leftWeights + 2l * y * a.width;
        for (int x0 = 0; x0 < a.width; x0 += 8)
            for_each_byte((load_bytes(row + x0) | load_bytes(below + x0)) & every * kEdgeTop, [&](int i) __attribute__((
                                                                                                  always_inline)) {
                const int x = x0 + i;
                if (x >= a.width) return;
                const long o = long(y) * a.stride + x;
                const T up = row[x] & kEdgeTop ? T(top[2 * x]) : T(0);
                const T down = below[x] & kEdgeTop ? T(top[2l * a.width + 2 * x + 1]) : T(0);
                T above[3], under[3];
                for (int c = 0; c < 3; c++) above[c] = a.in.c[c][o - a.stride], under[c] = a.in.c[c][o + a.stride];
                blend_pixel(a, o, up, down, above, under);
            });
        int lastX = -2;
        T beforeBlend[3] = {T(0), T(0), T(0)};  // of pixel lastX
        for (int x0 = 0; x0 < a.width; x0 += 8)
            for_each_byte(
                (load_bytes(row + x0) | load_bytes(row + x0 + 1)) & every * kEdgeLeft, [&](int i) __attribute__((
                                                                                           always_inline)) {
                    const int x = x0 + i;
                    if (x >= a.width) return;
                    const long o = long(y) * a.stride + x;
                    const T back = row[x] & kEdgeLeft ? T(left[2 * x]) : T(0);
                    const T ahead = row[x + 1] & kEdgeLeft ? T(left[2 * x + 3]) : T(0);
                    T before[3], after[3];
                    for (int c = 0; c < 3; c++) {
                        before[c] = lastX == x - 1 ? beforeBlend[c] : T(a.out.c[c][o - 1]);
                        after[c] = a.out.c[c][o + 1];
                        beforeBlend[c] = a.out.c[c][o];
                    }
                    lastX = x;
                    blend_pixel(a, o, back, ahead, before, after);
                });
    }
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::MlaaKernels, mlaaKernels) = {AA_ROWS(edgeRows), AA_ROWS(weightRows), AA_ROWS(blendRows)};
