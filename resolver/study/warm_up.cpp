#include "study/warm_up.h"

#include "gpu/method.h"
#include "shot/frame_stream.h"

namespace aa {
namespace {
constexpr size_t kHistoryPeriods = 10;  // decisions 13

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
    if (o.protocol.history != History::full || o.frames.empty() || withHistory(o.methods).empty()) return 0;
    const size_t frames = kHistoryPeriods * size_t(std::max(m.jitterPeriod, 1));
    return (frames + o.frames.size() - 1) / o.frames.size();
}

std::optional<Camera> warmUp(const ShotReader& shot, const RunOptions& o, std::vector<RunningMethod>& methods,
                             size_t passes, const Progress& progress) {
    std::vector<size_t> frames;
    for (size_t pass = 0; pass < passes; pass++) frames.insert(frames.end(), o.frames.begin(), o.frames.end());
    FrameStream stream(shot, frames, passesOf(withHistory(o.methods)));
    std::optional<Camera> before;
    for (size_t i = 0; auto frame = stream.next(); i++) {
        const size_t pass = i / o.frames.size();
        const int number = frame->number;
        if (i % o.frames.size() == 0) {
            frame->reset = pass == 0;
            if (pass > 0) frame->previousCamera = before;
        }
        frame->number = numberInPass(number, passes - pass, o, shot.manifest());
        before = frame->camera;
        prepareFrame(*frame, methods, o.protocol.display, o.exec);
        if (o.device) o.device->share(*frame);
        for (auto& m : methods)
            if (m.spec.method->wantsHistory()) m.resolve(*frame, frame->display, o.exec);
        progress.step("warm-up " + std::to_string(pass + 1) + "/" + std::to_string(passes) + " frame " +
                      std::to_string(number));
        if (progress.interrupted()) break;
    }
    if (o.device) o.device->forget();
    return before;
}

}  // namespace aa
