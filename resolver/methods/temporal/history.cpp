#include "methods/temporal/history.h"

#include <string>

#include "image/error.h"

namespace aa {

void History::begin(const Frame& frame, std::string_view method) {
    const bool starts = frame.reset || frames_ < 0;
    if (!starts && (frame.width != width_ || frame.height != height_))
        throw InputError(std::string(method) + ": frame " + std::to_string(frame.number) + " is " +
                         std::to_string(frame.width) + "x" + std::to_string(frame.height) + ", its history is " +
                         std::to_string(width_) + "x" + std::to_string(height_) +
                         "; set `reset` on the frame where the size changes");
    width_ = frame.width, height_ = frame.height;
    frames_ = starts ? 0 : frames_ + 1;
    for (HistoryPart* part : parts_) part->begin();
}

void History::end() {
    for (HistoryPart* part : parts_) part->end();
}

size_t History::bytes() const {
    size_t sum = 0;
    for (const HistoryPart* part : parts_) sum += part->bytes();
    return sum;
}

void ColourHistory::begin(const Frame& frame, std::string_view method, TemporalIn& in) {
    History::begin(frame, method);
    if (!fresh() && storage_.format != HistoryFormat::float32) narrow();
    frameNumber_ = uint32_t(frame.number);
    in.history = fresh() ? nullptr : blend_.previous().row(0);
    in.next = blend_.next().row(0);
}

void ColourHistory::end(const HistoryStorage& storage, const Exec& exec) {
    History::end();
    storage_ = storage, exec_ = exec;
}

void ColourHistory::narrow() {
    RgbaPlane& kept = blend_.inPlace();
    const NarrowHistoryArgs args{kept.row(0),     kept.stride(),   kept.width(),
                                 storage_.format, storage_.dither, frameNumber_};
    runKernel(temporalKernelsFor(exec_).narrow, exec_, args, kept.height());
    kept.fillBorder();
}

}  // namespace aa
