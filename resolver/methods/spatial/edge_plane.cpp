#include "methods/spatial/edge_plane.h"

#include <cstring>

namespace aa {

void EdgePlane::resize(int width, int height, int border) {
    if (width == width_ && height == height_ && border == border_) return;
    width_ = width;
    height_ = height;
    border_ = border;
    stride_ = width + 2 * border + 16;  // lanes may write past the width
    bytes_.assign(size_t(stride_) * size_t(height + 2 * border) + 16, 0);
}
void EdgePlane::clear() { std::memset(bytes_.data(), 0, bytes_.size()); }
void EdgePlane::repeatBorder() {
    for (int y = 0; y < height_; y++) {
        uint8_t* const r = row(y);
        std::memset(r - border_, r[0], size_t(border_));
        std::memset(r + width_, r[width_ - 1], size_t(border_));
    }
    const size_t length = size_t(width_ + 2 * border_);
    for (int y = 1; y <= border_; y++) {
        std::memcpy(row(-y) - border_, row(0) - border_, length);
        std::memcpy(row(height_ - 1 + y) - border_, row(height_ - 1) - border_, length);
    }
}
void EdgePlane::clearBesideTheRows() {
    for (int y = 0; y < height_; y++) {
        std::memset(row(y) - border_, 0, size_t(border_));
        std::memset(row(y) + width_, 0, size_t(border_ + 16));
    }
}

}  // namespace aa
