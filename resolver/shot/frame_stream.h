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

    // The next frame; nullopt after the last. Ends after an error.
    std::optional<Frame> next();
    // The centre-sampled frame of the same instant; null when nothing of it was wanted. Frames that share a file (a
    // static shot) share one Frame. The caller may add to it (colorEncoded).
    const std::shared_ptr<Frame>& centre() const { return centre_; }
    // Truth of the frame that next() returned; null when it has none or none was asked for. Frames that share a truth
    // file (a static shot) share one Truth.
    const std::shared_ptr<const Truth>& truth() const { return truth_; }
    // What the sanitiser replaced in all frames returned so far.
    const SanitiseCounts& counts() const { return counts_; }

  private:
    struct Decoded {
        Frame frame;
        std::shared_ptr<Frame> centre;
        std::shared_ptr<const Truth> truth;
        SanitiseCounts counts;
    };
    void startDecoding();
    // What the last frame holds, so that a shared file is decoded once.
    struct Last {
        std::shared_ptr<Frame> centre;
        std::shared_ptr<const Truth> truth;
        std::string centreFile, truthFile;
    };
    Decoded decode(size_t index, const Last& last) const;

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
