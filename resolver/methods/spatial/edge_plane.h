// Edge bits, one byte per pixel, for the morphological methods.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace aa {

// A plane of bytes with a border as wide as the searches of a method reach. Row functions may write 16 bytes past the
// width, so the border is set after them.
class EdgePlane {
  public:
    void resize(int width, int height, int border);
    void clear();
    void repeatBorder();        // with the edge pixels
    void clearBesideTheRows();  // to the left and right
    uint8_t* row(int y) { return bytes_.data() + (ptrdiff_t(y) + border_) * stride_ + border_; }
    const uint8_t* row(int y) const { return bytes_.data() + (ptrdiff_t(y) + border_) * stride_ + border_; }
    int stride() const { return stride_; }
    size_t bytes() const { return bytes_.size(); }

  private:
    int width_ = 0, height_ = 0, border_ = 0, stride_ = 0;
    std::vector<uint8_t> bytes_;
};

}  // namespace aa
