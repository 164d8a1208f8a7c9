#include "study/warm_up.h"

#include "gpu/method.h"
#include "image/error.h"
#include "shot/frame_stream.h"
#include "shot/pass_table.h"

namespace aa {
namespace {
constexpr size_t kHistoryPeriods = 10;   // decisions 13
constexpr size_t kMostFrames = 1000000;  // days of work: no sequence that one waits for repeats after so many

std::vector<MethodSpec> withHistory(const std::vector<MethodSpec>& methods) {
    std::vector<MethodSpec> chosen;
    for (const auto& m : methods)
        if (m.method->wantsHistory()) chosen.push_back(m);
    return chosen;
}
// Frames of an earlier pass keep their parity, which tells methods with two sets of sub-samples apart, and get numbers
// that no frame of another pass has: they seed noise.
int numberInPass(int number, size_t passesLeft, const RunOptions& o, const Manifest& m) {
    const int count = m.frames[o.frames.back()].frame - m.frames[o.frames.front()].frame + 1;
    return number + int(passesLeft) * (count + count % 2);
}
}  // namespace

size_t warmUpPasses(const RunOptions& o, const Manifest& m) {
    if (o.protocol.history != History::full || o.frames.empty() || withHistory(o.every()).empty()) return 0;
    const size_t frames = kHistoryPeriods * size_t(std::max(m.jitterPeriod, 1));
    if (frames > kMostFrames)
        throw InputError((m.folder / "shot.json").string() + ": jitter.period: a full history takes " +
                         std::to_string(kHistoryPeriods) + " periods of " + std::to_string(m.jitterPeriod) +
                         " frames, above " + std::to_string(kMostFrames) + "; run with --history first");
    return (frames + o.frames.size() - 1) / o.frames.size();
}

namespace {
// The frames of every pass, ready for the methods: decoded and prepared once where all of them may stay in memory,
// which is most of a warm-up's work, else again in each pass.
class RepeatedFrames {
  public:
    RepeatedFrames(const ShotReader& shot, const RunOptions& o, const std::vector<RunningMethod>& methods,
                   size_t mostBytes)
        : shot_(shot), options_(o), methods_(methods), mostBytes_(mostBytes) {}

    // Frame i of a pass; to be asked for in order. Valid until the next call.
    Frame& at(size_t i) {
        const size_t count = options_.frames.size();
        if (kept_.size() == count) return kept_[i];
        if (i == 0) stream_.emplace(shot_, options_.frames, passesOf(withHistory(options_.methods)));
        current_ = *stream_->next();
        prepareFrame(current_, methods_, options_.protocol.display, options_.exec);
        if (i == 0 && count * bytes(current_) <= mostBytes_) kept_.reserve(count);
        if (kept_.capacity() < count) return current_;
        return kept_.emplace_back(std::move(current_));
    }

  private:
    size_t bytes(const Frame& f) const {
        const size_t encoded = bytesOfTarget(f.width, f.height);  // of colour
        return encoded + bytesOf(f.passes, f, shot_.manifest().subsamplePositionsPx.size());
    }
    const ShotReader& shot_;
    const RunOptions& options_;
    const std::vector<RunningMethod>& methods_;
    size_t mostBytes_;
    std::optional<FrameStream> stream_;
    std::vector<Frame> kept_;
    Frame current_;
};
}  // namespace

std::optional<Camera> warmUp(const ShotReader& shot, const RunOptions& o, std::vector<RunningMethod>& methods,
                             size_t passes, const Progress& progress, size_t mostBytes) {
    RepeatedFrames frames(shot, o, methods, mostBytes);
    std::optional<Camera> before;
    for (size_t step = 0; step < passes * o.frames.size() && !progress.interrupted(); step++) {
        const size_t pass = step / o.frames.size(), i = step % o.frames.size();
        Frame& frame = frames.at(i);
        if (i == 0) {
            frame.reset = pass == 0;
            if (pass > 0) frame.previousCamera = before;
        }
        const int number = shot.manifest().frames[o.frames[i]].frame;
        frame.number = numberInPass(number, passes - pass, o, shot.manifest());
        before = frame.camera;
        if (o.device) o.device->share(frame);
        for (auto& m : methods)
            if (m.spec.method->wantsHistory()) m.accumulate(frame, o.exec);
        progress.step("warm-up " + std::to_string(pass + 1) + "/" + std::to_string(passes) + " frame " +
                      std::to_string(number));
    }
    if (o.device) o.device->forget();
    return before;
}

}  // namespace aa
