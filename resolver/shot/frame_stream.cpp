#include "shot/frame_stream.h"

namespace aa {

FrameStream::FrameStream(const ShotReader& reader, std::vector<size_t> indices, PassSet wanted, bool withTruth)
    : reader_(reader), indices_(std::move(indices)), wanted_(wanted), withTruth_(withTruth) {
    startDecoding();
}
FrameStream::~FrameStream() {
    if (pending_.valid()) pending_.wait();
}

void FrameStream::startDecoding() {
    if (started_ == indices_.size()) return;
    pending_ = std::async(std::launch::async, [this, index = indices_[started_], last = truth_, lastFile = truthFile_] {
        return decode(index, last, lastFile);
    });
    started_++;
}

FrameStream::Decoded FrameStream::decode(size_t index, std::shared_ptr<const Truth> lastTruth,
                                         const std::string& lastTruthFile) const {
    Decoded d;
    d.frame = reader_.read(index, wanted_, &d.counts);
    const std::string& file = reader_.manifest().frames.at(index).truth;
    if (!withTruth_ || file.empty()) return d;
    if (lastTruth && file == lastTruthFile) {
        d.truth = std::move(lastTruth);
        return d;
    }
    lastTruth.reset();
    d.truth = std::make_shared<const Truth>(*reader_.readTruth(index));
    return d;
}

std::optional<Frame> FrameStream::next() {
    if (!pending_.valid()) return std::nullopt;
    Decoded d;
    try {
        d = pending_.get();
    } catch (...) {
        started_ = indices_.size();
        throw;
    }
    truth_ = std::move(d.truth);
    truthFile_ = reader_.manifest().frames.at(indices_[started_ - 1]).truth;
    counts_ += d.counts;
    startDecoding();
    return std::move(d.frame);
}

}  // namespace aa
