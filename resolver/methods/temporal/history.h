// The colour history of the temporal methods.
//
// It holds the blend before sharpening (conventions 5), RGBA float, two planes that swap roles. A frame with `reset`
// set, and the first frame, drop it; a change of size without reset is an InputError (conventions 5).
#pragma once
#include <string_view>

#include "kernels/dispatch.h"
#include "methods/temporal/temporal_kernels.h"
#include "shot/frame.h"

namespace aa {

// How the history is kept from one frame to the next: parameters historyBits and dither.
struct HistoryStorage {
    HistoryFormat format = HistoryFormat::float32;
    bool dither = false;
};

class ColourHistory {
  public:
    // Fills the history members of `in` for this frame: in.history stays null when there is none.
    void begin(const Frame& frame, std::string_view method, TemporalIn& in);
    // The blend of this frame is complete: fills its border and makes it the history of the next one, which finds it
    // as `storage` keeps it. What this frame shows is not narrowed.
    void end(const HistoryStorage& storage, const Exec& exec);
    size_t bytes() const { return planes_[0].bytes() + planes_[1].bytes(); }
    int framesSinceReset() const { return frames_; }  // 0 on the first frame
    const RgbaPlane& latest() const { return planes_[current_]; }

  private:
    void narrow();

    RgbaPlane planes_[2];
    size_t current_ = 0;
    int frames_ = -1;
    uint32_t frameNumber_ = 0;
    HistoryStorage storage_;
    Exec exec_;
};

}  // namespace aa
