#include "study/verify.h"

#include <algorithm>
#include <cmath>

#include "methods/driver.h"
#include "shot/frame_stream.h"
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
double median(std::vector<double> v) {
    if (v.empty()) return 0;
    std::nth_element(v.begin(), v.begin() + std::ptrdiff_t(v.size() / 2), v.end());
    return v[v.size() / 2];
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
    std::vector<std::vector<double>> deviceSeconds(o.methods.size()), cpuSeconds(o.methods.size());
    std::shared_ptr<Frame> centreFrame;
    for (bool first = true; auto frame = stream.next(); first = false) {
        if (first) frame->reset = true;
        prepareFrame(*frame, processor, o.display, o.exec);
        if (stream.centre() && stream.centre() != centreFrame)
            prepareFrame(*stream.centre(), processor, o.display, o.exec);
        centreFrame = stream.centre();
        session.share(*frame);
        for (size_t k = 0; k < o.methods.size(); k++) {
            const Frame& input = plan.readsCentre(o.methods[k]) ? *stream.centre() : *frame;
            cpuSeconds[k].push_back(processor[k].resolve(input, input.display, o.exec));
            deviceSeconds[k].push_back(device[k].resolve(input, input.display, o.exec));
            compare(processor[k].out, device[k].out, frame->number, results[k], sums[k]);
        }
        progress.step("frame " + std::to_string(frame->number));
        if (progress.interrupted()) break;
    }
    session.forget();
    for (size_t k = 0; k < results.size(); k++) {
        VerifyResult& r = results[k];
        r.rms = sums[k].values ? std::sqrt(sums[k].squares / double(sums[k].values)) : 0;
        r.shareAboveCode = sums[k].pixels ? double(sums[k].above) / double(sums[k].pixels) : 0;
        r.deviceSeconds = median(deviceSeconds[k]), r.cpuSeconds = median(cpuSeconds[k]);
        r.stateBytes = processor[k].method->stateBytes(), r.deviceStateBytes = device[k].method->stateBytes();
    }
    return results;
}

}  // namespace aa
