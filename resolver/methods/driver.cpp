#include "methods/driver.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "kernels/dispatch.h"
#include "shot/manifest.h"

namespace aa {

RunningMethod::RunningMethod(MethodSpec s, const ShotInfo& shot) : spec(std::move(s)), method(spec.create(shot)) {}
RunningMethod::RunningMethod(MethodSpec s, std::unique_ptr<Method> form)
    : spec(std::move(s)), method(std::move(form)) {}

void RunningMethod::accumulate(const Frame& frame, const Exec& exec) {
    if (out.width() != frame.width || out.height() != frame.height) out = Rgb::unset(frame.width, frame.height);
    method->resolve(frame, exec, out);
}
ResolveSeconds RunningMethod::again(const Frame& frame, const Exec& exec) {
    const auto start = std::chrono::steady_clock::now();
    const ProcessorTime processor;
    accumulate(frame, exec);
    const ResolveSeconds seconds{processor.seconds(),
                                 std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()};
    out.fillBorder();
    return seconds;
}

ResolveSeconds RunningMethod::resolve(const Frame& frame, const DisplayChain& chain, const Exec& exec) {
    const ResolveSeconds seconds = again(frame, exec);
    if (spec.outputSpace() == Space::linear)
        encode(out, chain, exec, shown_);
    else
        shown_ = Rgb();
    return seconds;
}

Rgb& RunningMethod::changeShown() {
    if (shown_.empty()) shown_ = out;
    return shown_;
}

ShotInfo shotInfo(const Manifest& m) {
    return {.width = m.width,
            .height = m.height,
            .jitterPeriod = m.jitterPeriod,
            .isStatic = m.isStatic,
            .frameCount = m.frames.size(),
            .subSamplePositionsPx = m.subsamplePositionsPx};
}

namespace {
// Linear and displayed become one: what a method calls linear is what is shown.
void useOneSpace(Frame& frame, const DisplayChain& chain, const Exec& exec) {
    if (!frame.colorLinear.empty()) encode(frame.colorLinear, chain, exec, frame.colorLinear);
    if (!frame.albedoLinear.empty()) encode(frame.albedoLinear, chain.transferOnly(), exec, frame.albedoLinear);
    for (SubSample& s : frame.subSamples)
        if (!s.colorLinear.empty()) encode(s.colorLinear, chain, exec, s.colorLinear);
}
void setDisplay(Frame& frame, const DisplayChain& chain, const Exec& exec) {
    if (chain.transfer == Transfer::identity) useOneSpace(frame, chain, exec);
    frame.display = chain.transfer == Transfer::identity ? chain.transferOnly() : chain;
}
void encodeColour(Frame& frame, const Exec& exec) {
    if (!frame.colorLinear.empty()) encode(frame.colorLinear, frame.display, exec, frame.colorEncoded);
}
void encodeAlbedo(const Rgb& linear, Frame& frame, const Exec& exec) {
    if (!linear.empty()) encode(linear, frame.display.transferOnly(), exec, frame.albedoEncoded);
}
}  // namespace

void encodeFrame(Frame& frame, const DisplayChain& chain, const Exec& exec) {
    setDisplay(frame, chain, exec);
    encodeColour(frame, exec);
    encodeAlbedo(frame.albedoLinear, frame, exec);
}

void prepareFrame(Frame& frame, const std::vector<RunningMethod>& methods, const DisplayChain& chain,
                  const Exec& exec) {
    setDisplay(frame, chain, exec);
    if (std::none_of(methods.begin(), methods.end(), [](const auto& m) { return m.spec.readsEncoded(); })) return;
    encodeColour(frame, exec);
    frame.albedoEncoded = std::exchange(frame.albedoLinear, {});
    encodeAlbedo(frame.albedoEncoded, frame, exec);
}

}  // namespace aa
