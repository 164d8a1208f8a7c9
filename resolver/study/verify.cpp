#include "study/verify.h"

#include <algorithm>
#include <cmath>

#include "methods/driver.h"
#include "shot/frame_stream.h"
#include "study/feed.h"
#include "study/prepare.h"
#include "study/run.h"

namespace aa {
namespace {

struct Sums {
    double squares = 0;
    size_t values = 0, pixels = 0, above = 0;
};
void compare(const Rgb& expected, const Rgb& found, int frame, VerifyResult& r, Sums& sums) {
    double mostHere = 0;
    for (int y = 0; y < expected.height(); y++)
        for (int x = 0; x < expected.width(); x++) {
            double worst = 0;
            for (size_t c = 0; c < 3; c++) {
                const double e = double(expected.c[c].at(x, y)), f = double(found.c[c].at(x, y));
                if (!std::isfinite(e) || !std::isfinite(f)) {
                    if (std::isfinite(e) != std::isfinite(f)) r.notFinite++;
                    continue;
                }
                const double difference = std::abs(e - f) / std::max(1.0, std::abs(e));
                worst = std::max(worst, difference);
                sums.squares += difference * difference, sums.values++;
            }
            sums.pixels++;
            if (worst > 1.0 / 255) sums.above++;
            mostHere = std::max(mostHere, worst);
            if (worst > r.most) r.most = worst, r.worstFrame = frame, r.worstX = x, r.worstY = y;
        }
    r.mostByFrame.push_back(mostHere);
}
}  // namespace

std::vector<VerifyResult> verify(const ShotReader& shot, const VerifyOptions& o, gpu::Session& session,
                                 const Progress& progress) {
    requirePasses(shot, o.methods);
    const ShotInfo info = shotInfo(shot.manifest());
    std::vector<RunningMethod> processor, device;
    std::vector<VerifyResult> results(o.methods.size());
    for (size_t k = 0; k < o.methods.size(); k++) {
        processor.emplace_back(o.methods[k], info);
        device.emplace_back(o.methods[k], gpu::create(session, o.methods[k], info));
        results[k].text = o.methods[k].text, results[k].family = o.methods[k].method->family;
    }
    RunOptions run;
    run.methods = o.methods, run.frames = o.frames;
    const InputPlan plan = planInput(shot, run);
    FrameStream stream(shot, o.frames, plan.jittered, /*withTruth=*/false, plan.centre);
    std::vector<Sums> sums(o.methods.size());
    Feed feed(
        stream,
        [&](int i, Frame& frame) {
            if (i == 0) frame.reset = true;
            prepareFrame(frame, processor, o.display, o.exec);
        },
        &session);
    while (const auto item = feed.next()) {
        for (size_t k = 0; k < o.methods.size(); k++) {
            const Frame& input = plan.readsCentre(o.methods[k]) ? *item->centre : *item->frame;
            processor[k].resolve(input, input.display, o.exec);
            device[k].resolve(input, input.display, o.exec);
            compare(processor[k].out, device[k].out, item->frame->number, results[k], sums[k]);
        }
        progress.step("frame " + std::to_string(item->frame->number));
        if (progress.interrupted()) break;
    }
    feed.stop();
    session.forget();
    for (size_t k = 0; k < results.size(); k++) {
        VerifyResult& r = results[k];
        r.rms = sums[k].values ? std::sqrt(sums[k].squares / double(sums[k].values)) : 0;
        r.shareAboveCode = sums[k].pixels ? double(sums[k].above) / double(sums[k].pixels) : 0;
        r.stateBytes = processor[k].method->stateBytes(), r.deviceStateBytes = device[k].method->stateBytes();
    }
    return results;
}

}  // namespace aa
