#include "shot/frame_stream.h"

#include <tbb/global_control.h>

namespace aa {
namespace {
std::launch whenToDecode() {
    const bool alone = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism) == 1;
    return alone ? std::launch::deferred : std::launch::async;
}
}  // namespace

FrameStream::FrameStream(const ShotReader& reader, std::vector<size_t> indices, PassSet wanted, bool withTruth,
                         PassSet wantedOfCentre, Trace* trace)
    : reader_(reader),
      indices_(std::move(indices)),
      wanted_(wanted),
      withTruth_(withTruth),
      wantedOfCentre_(wantedOfCentre),
      trace_(trace) {
    decodeAhead();
}
FrameStream::~FrameStream() {
    if (pending_.valid() && pending_.wait_for(std::chrono::seconds(0)) != std::future_status::deferred) pending_.wait();
}

void FrameStream::decodeAhead() {
    if (pending_.valid() || started_ == indices_.size()) return;
    const size_t index = indices_[started_];
    const FrameEntry& entry = reader_.manifest().frames.at(index);
    Shared shared;
    if (entry.centre == centreFile_) shared.centre = centre_;
    if (entry.truth == truthFile_) shared.truth = truth_;
    pending_ = std::async(whenToDecode(), [this, index, shared] { return decode(index, shared); });
    started_++;
}

FrameStream::Decoded FrameStream::decode(size_t index, const Shared& shared) const {
    const FrameEntry& entry = reader_.manifest().frames.at(index);
    const Trace::Span span(trace_, "decode", std::to_string(entry.frame));
    Decoded d;
    d.frame = reader_.read(index, wanted_, &d.counts);
    if (!wantedOfCentre_.empty())
        d.centre = shared.centre ? shared.centre
                                 : std::make_shared<Frame>(reader_.readCentre(index, wantedOfCentre_, &d.counts));
    if (withTruth_ && !entry.truth.empty())
        d.truth = shared.truth ? shared.truth : std::make_shared<const Truth>(*reader_.readTruth(index, &d.counts));
    return d;
}

std::optional<Frame> FrameStream::next(Ahead ahead) {
    decodeAhead();
    if (!pending_.valid()) return std::nullopt;
    Decoded d;
    try {
        d = pending_.get();
    } catch (...) {
        started_ = indices_.size();
        throw;
    }
    const FrameEntry& entry = reader_.manifest().frames.at(indices_[started_ - 1]);
    centre_ = std::move(d.centre);
    centreFile_ = entry.centre;
    truth_ = std::move(d.truth);
    truthFile_ = entry.truth;
    counts_ += d.counts;
    if (ahead == Ahead::now) decodeAhead();
    return std::move(d.frame);
}

}  // namespace aa
