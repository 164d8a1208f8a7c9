// Edge bits of the morphological methods, 1 bit per pixel: 64 pixels of a search in one instruction, and a whole image
// in the second-level cache.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace aa {

inline constexpr int kBitRows = 24;  // border rows above and below: more than diagonal searches overshoot

// A plane of bits, least significant first, whose border repeats the bits at the image's edge (clamp-to-edge).
class BitPlane {
  public:
    void resize(int width, int height, int border);  // border to the left and right, px
    void repeatBorder();                             // and overwrites what rows hold past the width
    void clearBorder();                              // instead
    // The byte of pixels 0 to 7. Row functions write whole bytes, past the width too.
    uint8_t* row(int y) { return bytes_.data() + ptrdiff_t(y + kBitRows) * stride_ + borderBytes_; }
    const uint8_t* row(int y) const { return bytes_.data() + ptrdiff_t(y + kBitRows) * stride_ + borderBytes_; }
    bool at(int x, int y) const { return row(y)[x >> 3] >> (x & 7) & 1; }
    int stride() const { return stride_; }
    int rows() const { return height_; }
    size_t bytes() const { return bytes_.size(); }

  private:
    int width_ = 0, height_ = 0, border_ = 0, borderBytes_ = 0, stride_ = 0;
    std::vector<uint8_t> bytes_;
};

}  // namespace aa
