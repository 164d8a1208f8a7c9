// Plane<T>: one channel of W x H values, row-major, y down, with a border that repeats the edge.
//
// Neighbourhood reads up to kBorderX / kBorderY pixels outside need no clamp after fillBorder(), and rows are padded so
// that lanes never need a masked tail: a kernel may write up to kRowPad - 1 values past the width.
#pragma once
#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>
#include <string>
#include <vector>

#include "image/plane_pool.h"
#include "kernels/table.h"

namespace aa {

template <class T>
struct PlaneAllocator {
    using value_type = T;
    PlaneAllocator() = default;
    template <class U>
    PlaneAllocator(const PlaneAllocator<U>&) {}
    T* allocate(size_t n) { return static_cast<T*>(takePlaneMemory(n * sizeof(T))); }
    void deallocate(T* p, size_t n) { givePlaneMemory(p, n * sizeof(T)); }
    // Without a value a plane's samples are left as they are: Plane::unset().
    template <class U>
    void construct(U* p) {
        ::new (static_cast<void*>(p)) U;
    }
    template <class U, class V>
    void construct(U* p, const V& value) {
        ::new (static_cast<void*>(p)) U(value);
    }
    template <class U>
    bool operator==(const PlaneAllocator<U>&) const {
        return true;
    }
};

template <class T>
using Samples = std::vector<T, PlaneAllocator<T>>;
// With any content, for what is written before it is read; builds with asserts fill it with what nobody wants.
template <class T>
Samples<T> unsetSamples(size_t count) {
#ifndef NDEBUG
    using Limits = std::numeric_limits<T>;
    return Samples<T>(count, Limits::has_quiet_NaN ? Limits::quiet_NaN() : Limits::max());
#else
    return Samples<T>(count);
#endif
}

inline constexpr int kBorderX = 16, kBorderY = 8, kRowPad = 16;
inline int paddedStride(int width) { return (width + kRowPad - 1) / kRowPad * kRowPad + 2 * kBorderX; }

// T per channel sample; Channels > 1 is interleaved (RGBA history, one 16-byte load per texel).
template <class T, int Channels = 1>
class Plane {
  public:
    Plane() = default;
    Plane(int width, int height, T value = T{})
        : width_(width),
          height_(height),
          stride_(paddedStride(width)),
          data_(size_t(stride_) * size_t(height + 2 * kBorderY) * Channels, value) {}

    // With any content: unsetSamples().
    static Plane unset(int width, int height) {
        Plane plane;
        plane.width_ = width, plane.height_ = height, plane.stride_ = paddedStride(width);
        plane.data_ = unsetSamples<T>(size_t(plane.stride_) * size_t(height + 2 * kBorderY) * Channels);
        return plane;
    }

    bool empty() const { return data_.empty(); }
    int width() const { return width_; }
    int height() const { return height_; }
    int stride() const { return stride_; }  // pixels, not samples, from one row to the next
    size_t bytes() const { return data_.size() * sizeof(T); }

    // First sample of pixel (0, y); -kBorderY <= y < height + kBorderY.
    T* row(int y) { return data_.data() + (ptrdiff_t(y + kBorderY) * stride_ + kBorderX) * Channels; }
    const T* row(int y) const { return data_.data() + (ptrdiff_t(y + kBorderY) * stride_ + kBorderX) * Channels; }
    T& at(int x, int y) { return row(y)[ptrdiff_t(x) * Channels]; }
    const T& at(int x, int y) const { return row(y)[ptrdiff_t(x) * Channels]; }
    const T& clamped(int x, int y) const { return at(std::clamp(x, 0, width_ - 1), std::clamp(y, 0, height_ - 1)); }

    // Repeats the edge pixels into the border and the row padding (clamp-to-edge, conventions 1).
    void fillBorder() {
        if (empty()) return;
        for (int y = 0; y < height_; y++) fillRowBorder(y);
        for (int y = -kBorderY; y < 0; y++) copyRow(0, y);
        for (int y = height_; y < height_ + kBorderY; y++) copyRow(height_ - 1, y);
    }

    // Equal pixels (the border is not compared).
    bool samePixels(const Plane& o) const {
        if (width_ != o.width_ || height_ != o.height_) return false;
        for (int y = 0; y < height_; y++)
            if (!std::equal(row(y), row(y) + ptrdiff_t(width_) * Channels, o.row(y))) return false;
        return true;
    }

  private:
    void fillRowBorder(int y) {
        T* r = row(y);
        const int end = stride_ - kBorderX;
        for (int x = -kBorderX; x < 0; x++)
            for (int c = 0; c < Channels; c++) r[x * Channels + c] = r[c];
        const T* last = r + ptrdiff_t(width_ - 1) * Channels;
        for (int x = width_; x < end; x++)
            for (int c = 0; c < Channels; c++) r[ptrdiff_t(x) * Channels + c] = last[c];
    }
    void copyRow(int from, int to) {
        const T* src = row(from) - ptrdiff_t(kBorderX) * Channels;
        std::copy(src, src + ptrdiff_t(stride_) * Channels, row(to) - ptrdiff_t(kBorderX) * Channels);
    }
    int width_ = 0, height_ = 0, stride_ = 0;
    Samples<T> data_;
};

using PlaneF = Plane<float>;
using PlaneU = Plane<uint32_t>;
using RgbaPlane = Plane<float, 4>;  // interleaved: for images sampled at arbitrary positions

// Three planes of equal size: RGB colours, or the components of a vector field. Planes share one stride.
struct Rgb {
    std::array<PlaneF, 3> c;
    Rgb() = default;
    Rgb(int width, int height, float value = 0) {
        for (auto& p : c) p = PlaneF(width, height, value);
    }
    static Rgb unset(int width, int height) {
        Rgb planes;
        for (auto& p : planes.c) p = PlaneF::unset(width, height);
        return planes;
    }
    bool empty() const { return c[0].empty(); }
    int width() const { return c[0].width(); }
    int height() const { return c[0].height(); }
    int stride() const { return c[0].stride(); }
    size_t bytes() const { return c[0].bytes() * 3; }
    void fillBorder() {
        for (auto& p : c) p.fillBorder();
    }
    bool samePixels(const Rgb& o) const {
        return c[0].samePixels(o.c[0]) && c[1].samePixels(o.c[1]) && c[2].samePixels(o.c[2]);
    }
};

// Planes of one size under a name: a colour or one value.
struct NamedPlanes {
    std::string name;
    std::vector<PlaneF> planes;  // 1 or 3
};

inline RgbIn view(const Rgb& i) { return {{i.c[0].row(0), i.c[1].row(0), i.c[2].row(0)}}; }
inline RgbOut view(Rgb& i) { return {{i.c[0].row(0), i.c[1].row(0), i.c[2].row(0)}}; }

}  // namespace aa

// Compiled in plane.cpp alone, for speed: of what every source compiles, and some with little optimisation, the linker
// would take any.
extern template class std::vector<float, aa::PlaneAllocator<float>>;
extern template class std::vector<uint32_t, aa::PlaneAllocator<uint32_t>>;
extern template class aa::Plane<float>;
extern template class aa::Plane<float, 4>;
extern template class aa::Plane<uint32_t>;
