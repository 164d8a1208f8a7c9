// Frames of a shot in order, each decoded on a background thread while the caller works on the one before; where the
// program may use one thread alone, when it is asked for.
#pragma once
#include <future>
#include <memory>
#include <vector>

#include "image/trace.h"
#include "shot/reader.h"

namespace aa {

// At most two frames are in memory: the caller's, as long as it keeps only the last one, and the one being decoded.
// The reader must outlive the stream. Errors of frame n surface in the call of next() that would return it.
class FrameStream {
  public:
    // `indices` into manifest().frames, in the order of delivery.
    FrameStream(const ShotReader& reader, std::vector<size_t> indices, PassSet wanted, bool withTruth = false,
                PassSet wantedOfCentre = {}, Trace* trace = nullptr);
    ~FrameStream();
    FrameStream(const FrameStream&) = delete;
    FrameStream& operator=(const FrameStream&) = delete;

    // When the frame after the next is decoded: at once, or when the caller has given back what is large of the next.
    enum class Ahead { now, whenTold };
    // The next frame; nullopt after the last. Ends after an error.
    std::optional<Frame> next(Ahead ahead = Ahead::now);
    void decodeAhead();  // unless that has begun
    // What belongs to the frame that next() returned, once; afterwards the caller alone has it, unless the next frame
    // is in the same file (a static shot): these share it.
    // The centre-sampled frame of the same instant; null when nothing of it was wanted. The caller may add to it
    // (colorEncoded).
    std::shared_ptr<Frame> takeCentre() { return std::move(centre_); }
    // Truth; null when the frame has none or none was asked for.
    std::shared_ptr<const Truth> takeTruth() { return std::move(truth_); }
    // What the sanitiser replaced in all frames returned so far.
    const SanitiseCounts& counts() const { return counts_; }

  private:
    struct Decoded {
        Frame frame;
        std::shared_ptr<Frame> centre;
        std::shared_ptr<const Truth> truth;
        SanitiseCounts counts;
    };
    // What the last frame has of the next one's files, so that they are decoded once; else null.
    struct Shared {
        std::shared_ptr<Frame> centre;
        std::shared_ptr<const Truth> truth;
    };
    Decoded decode(size_t index, const Shared& shared) const;

    const ShotReader& reader_;
    std::vector<size_t> indices_;
    PassSet wanted_;
    bool withTruth_;
    PassSet wantedOfCentre_;
    Trace* trace_;
    size_t started_ = 0;  // how many of indices_ have been given to the background
    std::future<Decoded> pending_;
    std::shared_ptr<Frame> centre_;
    std::shared_ptr<const Truth> truth_;
    std::string centreFile_, truthFile_;
    SanitiseCounts counts_;
};

}  // namespace aa
