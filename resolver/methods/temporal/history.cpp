#include "methods/temporal/history.h"

#include <string>

#include "image/error.h"

namespace aa {

void ColourHistory::begin(const Frame& frame, std::string_view method, TemporalIn& in) {
    const bool fits = planes_[0].width() == frame.width && planes_[0].height() == frame.height;
    const bool fresh = frame.reset || frames_ < 0;
    if (!fresh && !fits)
        throw InputError(std::string(method) + ": frame " + std::to_string(frame.number) + " is " +
                         std::to_string(frame.width) + "x" + std::to_string(frame.height) + ", its history is " +
                         std::to_string(planes_[0].width()) + "x" + std::to_string(planes_[0].height()) +
                         "; set `reset` on the frame where the size changes");
    if (!fits)
        for (auto& p : planes_) p = RgbaPlane(frame.width, frame.height);
    if (!fresh && storage_.format != HistoryFormat::float32) narrow();
    frames_ = fresh ? 0 : frames_ + 1;
    frameNumber_ = uint32_t(frame.number);
    in.history = fresh ? nullptr : planes_[current_].row(0);
    in.next = planes_[1 - current_].row(0);
}

void ColourHistory::end(const HistoryStorage& storage, const Exec& exec) {
    current_ = 1 - current_;
    planes_[current_].fillBorder();
    storage_ = storage, exec_ = exec;
}

void ColourHistory::narrow() {
    RgbaPlane& kept = planes_[current_];
    const NarrowHistoryArgs args{kept.row(0),     kept.stride(),   kept.width(),
                                 storage_.format, storage_.dither, frameNumber_};
    runKernel(temporalKernelsFor(exec_).narrow, exec_, args, kept.height());
    kept.fillBorder();
}

}  // namespace aa
