#include "methods/driver.h"

#include <chrono>

namespace aa {

RunningMethod::RunningMethod(MethodSpec s, const ShotInfo& shot) : spec(std::move(s)), method(spec.create(shot)) {}

double RunningMethod::resolve(const Frame& frame, const DisplayChain& chain, const Exec& exec) {
    if (out.width() != frame.width || out.height() != frame.height) out = Rgb(frame.width, frame.height);
    const auto start = std::chrono::steady_clock::now();
    method->resolve(frame, exec, out);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    out.fillBorder();
    if (spec.outputSpace() == Space::linear)
        encode(out, chain, exec, outEncoded);
    else
        outEncoded = out;
    return seconds;
}

ShotInfo shotInfo(const Manifest& m) {
    return {.width = m.width,
            .height = m.height,
            .jitterPeriod = m.jitterPeriod,
            .isStatic = m.isStatic,
            .frameCount = m.frames.size(),
            .subSamplePositionsPx = m.subsamplePositionsPx};
}

void encodeFrame(Frame& frame, const DisplayChain& chain, const Exec& exec) {
    encode(frame.colorLinear, chain, exec, frame.colorEncoded);
    if (!frame.albedoLinear.empty()) encode(frame.albedoLinear, {}, exec, frame.albedoEncoded);
}

void prepareFrame(Frame& frame, const std::vector<RunningMethod>& methods, const DisplayChain& chain,
                  const Exec& exec) {
    for (const auto& m : methods)
        if (m.spec.readsEncoded()) return encodeFrame(frame, chain, exec);
}

}  // namespace aa
