#include "study/run.h"

#include <algorithm>

#include "gpu/method.h"
#include "metrics/temporal.h"
#include "shot/frame_stream.h"
#include "shot/pass_table.h"
#include "study/feed.h"
#include "study/images.h"
#include "study/judge.h"
#include "study/prepare.h"
#include "study/warm_up.h"

namespace aa {

size_t stepsOf(const RunOptions& o, const Manifest& m) { return o.frames.size() * (1 + warmUpPasses(o, m)); }

RunResults run(const ShotReader& shot, const RunOptions& o, const Progress& progress) {
    std::vector<TileErrors> errors;
    RunResults results = runMethods(shot, o, progress, errors);
    finish(results, errors);
    writeResults(results, o.out);
    return results;
}

namespace {
// The methods' indices: the one that the others are held against first.
std::vector<size_t> orderOfWork(const std::vector<RunningMethod>& methods, const std::string& reference) {
    std::vector<size_t> order(methods.size());
    for (size_t k = 0; k < order.size(); k++) order[k] = k;
    std::stable_partition(order.begin(), order.end(), [&](size_t k) { return methods[k].spec.text == reference; });
    return order;
}
}  // namespace

RunResults runMethods(const ShotReader& shot, const RunOptions& o, const Progress& progress,
                      std::vector<TileErrors>& errors) {
    const Manifest& manifest = shot.manifest();
    std::vector<RunningMethod> methods = startMethods(shot, o);
    std::vector<std::unique_ptr<Method>> timed;  // the same methods on a device, for its time alone
    if (o.device && o.timeOnly)
        for (const auto& spec : o.methods) timed.push_back(gpu::create(*o.device, spec, shotInfo(manifest)));
    Rgb unused;
    RunResults results = describeRun(manifest, o);
    const InputPlan plan = planInput(shot, o);
    Judge judge(manifest, o, plan.overTime);

    const size_t passes = warmUpPasses(o, manifest);
    std::optional<Camera> before;
    if (passes > 0) before = warmUp(shot, o, methods, passes, progress);
    results.warmUpFrames = passes * o.frames.size();
    errors = judge.errors();
    if (progress.interrupted()) return results;

    const std::vector<size_t> order = orderOfWork(methods, o.protocol.reference);
    const bool standsIn = !o.protocol.reference.empty();
    FrameStream stream(shot, o.frames, plan.jittered, /*withTruth=*/!standsIn, plan.centre);
    const DisplayChain& display = o.protocol.display;
    Feed feed(
        stream,
        [&](int i, Frame& frame) {
            if (i == 0) {
                frame.reset = passes == 0;  // a sequence may start in the middle
                if (passes > 0) frame.previousCamera = before;
            }
            prepareFrame(frame, methods, display, o.exec);
        },
        o.device.get());
    for (size_t i = 0; auto item = feed.next(); i++) {
        const auto& frame = item->frame;
        if (!standsIn) judge.look(*frame, item->truth, nullptr);
        const auto isWritten = [&] {
            return o.writeAllFrames || (judge.reference() && (!manifest.isStatic || i + 1 == o.frames.size()));
        };
        if (!standsIn && judge.reference() && isWritten())
            if (const auto image = writeTruthImage(*judge.reference(), frame->number, o); !image.empty())
                results.truthImages[frame->number] = image;

        for (const size_t k : order) {
            const bool isReference = standsIn && k == order.front();
            const Frame& input = plan.readsCentre(methods[k].spec) ? *item->centre : *frame;
            const double seconds = methods[k].resolve(input, input.display, o.exec);
            if (!timed.empty()) timed[k]->resolve(input, o.exec, unused);
            if (o.protocol.eightBit) quantise8(methods[k].outEncoded, o.exec);
            if (isReference) judge.look(*frame, nullptr, &methods[k]);
            FrameResult result = judge.judge(k, methods[k], o.device && !o.timeOnly ? 0 : seconds);
            if (o.device) result.deviceSeconds = (timed.empty() ? *methods[k].method : *timed[k]).deviceSeconds();
            if (isWritten()) result.image = writeImage(methods[k], frame->number, o);
            if (isWritten() && judge.reference() && !isReference)
                writeMaps(methods[k], judge.measured(), frame->number, o);
            if (isReference && !result.image.empty()) results.truthImages[frame->number] = result.image;
            MethodResult& of = results.methods[k];
            if (manifest.isStatic && !of.frames.empty()) of.frames.back().judged = false;
            of.frames.push_back(std::move(result));
            of.inputBytes =
                std::max(of.inputBytes, bytesOf(methods[k].spec.passes(), input, manifest.subsamplePositionsPx.size()));
            of.targetBytes = bytesOfTarget(input.width, input.height);
            of.stateBytes = std::max(of.stateBytes, methods[k].method->stateBytes());
        }
        judge.judgeRejected(methods, results.methods);
        progress.step("frame " + std::to_string(frame->number));
        if (progress.interrupted()) break;
    }
    feed.stop();
    if (o.device) o.device->forget();
    judge.finish(results, passes == 0);
    results.sanitised = counted(stream.counts());
    errors = judge.errors();
    return results;
}

}  // namespace aa
