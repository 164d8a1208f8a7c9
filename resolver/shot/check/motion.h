// Does p - motion land where the surface was? On every pixel that moves, the sample position minus the motion is looked
// up in the frame before: the same object must be among the four samples around it, or something nearer must have
// hidden it. Without ids the colour alone decides. All eight sign and axis variants of the
// vectors compete; the stated one must win.
#pragma once
#include <array>

#include "shot/check/check.h"

namespace aa {

class MotionCheck {
  public:
    // Both frames need depth and motion; ids and colour tell more where they are present.
    void add(const Frame& previous, const Frame& frame);
    // A static shot may carry motion, but only zeros.
    void addStatic(const Frame& frame, CheckReport& report);
    void judge(CheckReport& report) const;

  private:
    struct Variant {
        uint64_t hits = 0, misses = 0;
        double colourError = 0;  // sum over hits
        // Where this and the stated one hit: in how many pixels its colour is nearer or farther, by more than chance.
        uint64_t both = 0, nearer = 0, farther = 0;
    };
    std::array<Variant, 8> variants_{};
    uint64_t moving_ = 0;
    struct Miss {
        int frame = 0;
        glm::ivec2 pixel{0};
        uint32_t expected = 0, found = 0;
    };
    std::optional<Miss> firstMiss_;
    bool staticFound_ = false, ids_ = false;
};

}  // namespace aa
