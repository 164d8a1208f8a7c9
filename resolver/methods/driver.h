// Colour-space conversions between a frame, a method and its judge. A method declares the space it reads and writes;
// nothing else converts.
#pragma once
#include "methods/spec.h"
#include "shot/manifest.h"

namespace aa {

// What a method took for a frame, conversions not counted.
struct ResolveSeconds {
    double processor = 0;  // of all its threads
    double wall = 0;
};

// A method in progress: its specification, its state and its last output.
struct RunningMethod {
    MethodSpec spec;
    std::unique_ptr<Method> method;
    Rgb out;  // in the method's output space
    RunningMethod(MethodSpec spec, const ShotInfo& shot);
    RunningMethod(MethodSpec spec, std::unique_ptr<Method> form);  // another form of spec's method
    // Resolves one frame. `chain` is frame.display of a frame that was prepared.
    ResolveSeconds resolve(const Frame& frame, const DisplayChain& chain, const Exec& exec);
    // Display-encoded, what the metrics see; of a method that gives encoded colour `out` itself, until it is changed.
    const Rgb& shown() const { return shown_.empty() ? out : shown_; }
    Rgb& changeShown();  // the one that is changed leaves `out` as it is
    // The same for the history's sake alone: no picture is to be shown.
    void accumulate(const Frame& frame, const Exec& exec);
    // Resolves it once more for the time alone. Not of a method that keeps something from frame to frame.
    ResolveSeconds again(const Frame& frame, const Exec& exec);
    void forgetPicture() { out = Rgb(), shown_ = Rgb(); }
    bool isRepeatable() const { return !spec.method->temporal && spec.stages.empty(); }

  private:
    Rgb shown_;  // empty: `out`
};

ShotInfo shotInfo(const Manifest& manifest);
// Sets frame.display; fills frame.colorEncoded, and frame.albedoEncoded where there is albedo. With the identity
// transfer everything happens in one space: all linear colours, sub-samples included, become displayed values, too.
// Once a frame.
void encodeFrame(Frame& frame, const DisplayChain& chain, const Exec& exec);
// The same for a run, with encoded colours only when one of the methods reads them. Albedo, which none reads as light,
// is then encoded in its own place: albedoLinear is empty.
void prepareFrame(Frame& frame, const std::vector<RunningMethod>& methods, const DisplayChain& chain, const Exec& exec);

}  // namespace aa
