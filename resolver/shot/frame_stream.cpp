#include "shot/frame_stream.h"

#include "image/io.h"

namespace aa {

FrameStream::FrameStream(const ShotReader& reader, std::vector<size_t> indices, PassSet wanted, bool withTruth,
                         PassSet wantedOfCentre, Trace* trace)
    : reader_(reader),
      indices_(std::move(indices)),
      wanted_(wanted),
      withTruth_(withTruth),
      wantedOfCentre_(wantedOfCentre),
      trace_(trace) {}

const FrameEntry* FrameStream::entry(size_t n) const {
    return n < indices_.size() ? &reader_.manifest().frames.at(indices_[n]) : nullptr;
}

std::optional<Frame> FrameStream::next() {
    const FrameEntry* const now = entry(next_);
    if (!now) return std::nullopt;
    try {
        Frame frame = decode(*now);
        next_++;
        readAhead();
        return frame;
    } catch (...) {
        next_ = indices_.size();
        throw;
    }
}

Frame FrameStream::decode(const FrameEntry& now) {
    const Trace::Span span(trace_, "decode", std::to_string(now.frame));
    const size_t index = indices_[next_];
    const FrameEntry* const next = entry(next_ + 1);
    Frame frame = reader_.read(index, wanted_, &counts_);
    if (!wantedOfCentre_.empty())
        centre_.fill(next && next->centre == now.centre,
                     [&] { return std::make_shared<Frame>(reader_.readCentre(index, wantedOfCentre_, &counts_)); });
    truth_.latest.reset();
    if (withTruth_ && !now.truth.empty())
        truth_.fill(next && next->truth == now.truth,
                    [&] { return std::make_shared<const Truth>(*reader_.readTruth(index, &counts_)); });
    return frame;
}

void FrameStream::readAhead() const {
    const FrameEntry* const next = entry(next_);
    if (!next) return;
    const auto& folder = reader_.manifest().folder;
    willRead(folder / next->file);
    if (!wantedOfCentre_.empty() && !centre_.ofNext) willRead(folder / next->centre);
    if (withTruth_ && !next->truth.empty() && !truth_.ofNext) willRead(folder / next->truth);
}

}  // namespace aa
