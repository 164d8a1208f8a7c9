// Frames of a shot in order, each decoded when it is asked for, on all threads: to decode it beside the work on the
// frame before takes as long, and the memory of both at once (docs/decisions.md, 57). Meanwhile the system reads the
// next frame's files ahead.
#pragma once
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "image/trace.h"
#include "shot/reader.h"

namespace aa {

// The reader must outlive the stream. Errors of frame n surface in the call of next() that would return it.
class FrameStream {
  public:
    // `indices` into manifest().frames, in the order of delivery.
    FrameStream(const ShotReader& reader, std::vector<size_t> indices, PassSet wanted, bool withTruth = false,
                PassSet wantedOfCentre = {}, Trace* trace = nullptr);
    FrameStream(const FrameStream&) = delete;
    FrameStream& operator=(const FrameStream&) = delete;

    // The next frame; nullopt after the last. Ends after an error.
    std::optional<Frame> next();
    // What belongs to the frame that next() returned, once; afterwards the caller alone has it, unless the next frame
    // is in the same file (a static shot): these share it.
    // The centre-sampled frame of the same instant; null when nothing of it was wanted. The caller may add to it
    // (colorEncoded).
    std::shared_ptr<Frame> takeCentre() { return std::move(centre_.latest); }
    // Truth; null when the frame has none or none was asked for.
    std::shared_ptr<const Truth> takeTruth() { return std::move(truth_.latest); }
    // What the sanitiser replaced in all frames returned so far.
    const SanitiseCounts& counts() const { return counts_; }

  private:
    // What frames that follow each other may have in one file: decoded once.
    template <class T>
    struct Shared {
        std::shared_ptr<T> latest, ofNext;
        template <class Decode>
        void fill(bool nextHasIt, const Decode& decode) {
            latest = ofNext ? std::exchange(ofNext, nullptr) : decode();
            if (nextHasIt) ofNext = latest;
        }
    };
    const FrameEntry* entry(size_t n) const;  // of indices_[n], or null
    Frame decode(const FrameEntry& entry);
    void readAhead() const;

    const ShotReader& reader_;
    std::vector<size_t> indices_;
    PassSet wanted_;
    bool withTruth_;
    PassSet wantedOfCentre_;
    Trace* trace_;
    size_t next_ = 0;  // of indices_
    Shared<Frame> centre_;
    Shared<const Truth> truth_;
    SanitiseCounts counts_;
};

}  // namespace aa
