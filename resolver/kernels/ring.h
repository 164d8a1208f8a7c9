// Intermediate values of which a step over rows keeps only the last few. Include from *.kernel.cpp only.
#pragma once
#include "kernels/lanes.h"
#include "kernels/table.h"

namespace AA_ARCH {

// kRows rows of the picture's width, with room for kRingMargin values on either side.
template <class T, int kRows>
struct Ring {
    T* first;
    long stride;
    int width, height;
    AA_INLINE T* operator()(int y) const {  // beyond the picture: its first or last row
        y = y < 0 ? 0 : y >= height ? height - 1 : y;
        return first + (y % kRows) * stride;
    }
    // Continues a row by two values beyond the picture with its first and last one.
    AA_INLINE void continueBeyond(int y) const {
        T* const row = (*this)(y);
        for (int i = 1; i <= 2; i++) row[-i] = row[0], row[width - 1 + i] = row[width - 1];
    }
};
// Hands out a call's scratch memory (kernels/dispatch.h) as rings.
template <class T>
struct RingMaker {
    T* free;
    long stride;
    int width, height;
    AA_INLINE RingMaker(void* scratch, int stride_, int width_, int height_)
        : free(static_cast<T*>(scratch) + aa::kRingMargin), stride(stride_), width(width_), height(height_) {}
    template <int kRows>
    AA_INLINE void make(Ring<T, kRows>& ring) {
        ring = {free, stride, width, height};
        free += kRows * stride;
    }
};

// Of Elem<R>, not of float.
template <class R>
AA_INLINE R loadOwn(const Elem<R>* p) {
    if constexpr (N<R> == 1)
        return *p;
    else
        return load<R>(p);
}
template <class R>
AA_INLINE vec3<R> loadOwn(const Elem<R>* const (&c)[3], int x) {
    return {loadOwn<R>(c[0] + x), loadOwn<R>(c[1] + x), loadOwn<R>(c[2] + x)};
}

}  // namespace AA_ARCH
