#include "methods/spatial/edge_bits.h"

#include <cstring>

namespace aa {

void BitPlane::resize(int width, int height, int border) {
    if (width == width_ && height == height_ && border == border_) return;
    width_ = width;
    height_ = height;
    border_ = border;
    borderBytes_ = (border + 63) / 64 * 8 + 8;  // a window of 64 bits may start one word before the last pixel read
    stride_ = (width + 63) / 64 * 8 + 2 * borderBytes_;
    bytes_.assign(size_t(stride_) * size_t(height + 2 * kBitRows), 0);
}
void BitPlane::repeatBorder() {
    for (int y = 0; y < height_; y++) {
        uint8_t* const r = row(y);
        std::memset(r - borderBytes_, r[0] & 1 ? 0xff : 0, size_t(borderBytes_));
        const int last = width_ - 1, byte = width_ >> 3;
        const bool set = r[last >> 3] >> (last & 7) & 1;
        const int kept = (1 << (width_ & 7)) - 1;
        r[byte] = uint8_t((r[byte] & kept) | (set ? ~kept : 0));
        std::memset(r + byte + 1, set ? 0xff : 0, size_t(stride_ - borderBytes_ - byte - 1));
    }
    for (int y = 1; y <= kBitRows; y++) {
        std::memcpy(row(-y) - borderBytes_, row(0) - borderBytes_, size_t(stride_));
        std::memcpy(row(height_ - 1 + y) - borderBytes_, row(height_ - 1) - borderBytes_, size_t(stride_));
    }
}

void BitPlane::clearBorder() {  // the rest of the border is never written
    for (int y = 0; y < height_; y++) {
        uint8_t* const r = row(y);
        const int byte = width_ >> 3;
        r[byte] = uint8_t(r[byte] & ((1 << (width_ & 7)) - 1));
        std::memset(r + byte + 1, 0, 8);
    }
    std::memset(row(height_), 0, size_t(stride_) * 8);  // whole blocks of 8 rows are transposed
}

}  // namespace aa
