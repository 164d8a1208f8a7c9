// What a temporal method keeps of one frame for the next (conventions 5): any number of planes of the frame's size.
//
//     History history_;
//     Kept<PlaneF> depth_{history_};    // declared after its history
//
//     history_.begin(frame, "mine");    // checks the size; the first frame, or `reset`, starts afresh
//     depth_.previous(), depth_.next()  // what the last frame left, and where this one writes
//     history_.end();                   // fills the border of what was written, which the next frame finds as previous
//
// A change of size without `reset` is an InputError. A plane is made, of zeros, when it is first asked for, so what a
// method has no use for costs nothing; a fresh start keeps old pixels in place, so a method asks fresh() or filled()
// before it reads them.
#pragma once
#include <cassert>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "kernels/dispatch.h"
#include "methods/temporal/temporal_kernels.h"
#include "shot/frame.h"

namespace aa {

// `planes` (Plane or Rgb) in this size: made anew, of zeros, where they have another.
template <class P>
P& fitted(P& planes, int width, int height) {
    if (planes.width() != width || planes.height() != height) planes = P(width, height);
    return planes;
}

class HistoryPart;

class History {
  public:
    History() = default;
    History(const History&) = delete;  // its parts point to it
    History& operator=(const History&) = delete;

    // `method` is named in the error about the size; after that error the history is as it was.
    void begin(const Frame& frame, std::string_view method);
    void end();
    int framesSinceReset() const { return frames_; }  // 0 on the first frame
    bool fresh() const { return frames_ == 0; }       // nothing is known of earlier frames
    int width() const { return width_; }
    int height() const { return height_; }
    size_t bytes() const;  // of all its planes, those that a frame writes included

  private:
    friend class HistoryPart;
    std::vector<HistoryPart*> parts_;
    int frames_ = -1, width_ = 0, height_ = 0;
};

// What History knows of the planes that it serves.
class HistoryPart {
  protected:
    explicit HistoryPart(History& history) : history_(history) { history.parts_.push_back(this); }
    HistoryPart(const HistoryPart&) = delete;
    HistoryPart& operator=(const HistoryPart&) = delete;
    ~HistoryPart() = default;
    const History& history_;

  private:
    friend class History;
    virtual void begin() = 0;
    virtual void end() = 0;
    virtual size_t bytes() const = 0;
};

// One quantity that is kept, as P: PlaneF, PlaneU, RgbaPlane or Rgb. Usually of the last frame alone; with several
// `slots` each frame replaces one of them and the others grow older.
template <class P>
class Kept : HistoryPart {
  public:
    explicit Kept(History& history, size_t slots = 1) : HistoryPart(history), slots_(slots) {}

    // Between begin() and end().
    const P& previous(size_t slot = 0) { return sized(slots_[slot].planes); }
    // What will replace previous(slot), with any content: the frame writes every pixel. Without this call the slot
    // stays as it is. Between frames nobody has it: of twenty methods side by side, one or two resolve at a time.
    P& next(size_t slot = 0) {
        assert(!written_ || written_ == slot);
        assert(history_.framesSinceReset() >= 0);
        written_ = slot;
        if (!std::exchange(replaced_, true)) next_ = P::unset(history_.width(), history_.height());
        nextBytes_ = next_.bytes();
        return next_;
    }
    // The same plane as previous(slot), for a frame that writes it when everything has read it: saves the second one.
    P& inPlace(size_t slot = 0) {
        assert(!written_ || written_ == slot);
        written_ = slot;
        return sized(slots_[slot].planes);
    }

    // What was written last: by the frame before, after end() by this one.
    const P& latest(size_t slot = 0) const { return slots_[slot].planes; }
    bool filled(size_t slot = 0) const { return slots_[slot].writtenIn >= 0; }  // since the reset
    // Frames from the one that wrote the slot, which is filled, to this one.
    int age(size_t slot = 0) const { return history_.framesSinceReset() - slots_[slot].writtenIn; }

  private:
    struct Slot {
        P planes;
        int writtenIn = -1;  // frames since the reset
    };
    P& sized(P& planes) const {
        assert(history_.framesSinceReset() >= 0);
        return fitted(planes, history_.width(), history_.height());
    }
    void begin() override {
        written_.reset(), replaced_ = false;
        if (history_.fresh())
            for (Slot& slot : slots_) slot.writtenIn = -1;
    }
    void end() override {
        if (!written_) return;
        Slot& slot = slots_[*written_];
        if (replaced_) slot.planes = std::exchange(next_, P());
        slot.planes.fillBorder();
        slot.writtenIn = history_.framesSinceReset();
        written_.reset(), replaced_ = false;
    }
    size_t bytes() const override {
        size_t sum = nextBytes_;
        for (const Slot& slot : slots_) sum += slot.planes.bytes();
        return sum;
    }

    std::vector<Slot> slots_;
    P next_;
    size_t nextBytes_ = 0;           // of the latest
    std::optional<size_t> written_;  // by this frame
    bool replaced_ = false;          // in next_
};

// How colours are kept from one frame to the next: parameters historyBits and dither.
struct HistoryStorage {
    HistoryFormat format = HistoryFormat::float32;
    bool dither = false;
};

// The history that most methods have: the blend before sharpening (conventions 5), RGBA. What a method keeps beside it
// is Kept in it.
class ColourHistory : public History {
  public:
    // Fills the history members of `in` for this frame: in.history stays null when there is none.
    void begin(const Frame& frame, std::string_view method, TemporalIn& in);
    // The blend of this frame is complete and the history of the next one, which finds it as `storage` keeps it. What
    // this frame shows is not narrowed.
    void end(const HistoryStorage& storage, const Exec& exec);
    const RgbaPlane& latest() const { return blend_.latest(); }

  private:
    void narrow();

    Kept<RgbaPlane> blend_{*this};
    uint32_t frameNumber_ = 0;
    HistoryStorage storage_;
    Exec exec_;
};

}  // namespace aa
