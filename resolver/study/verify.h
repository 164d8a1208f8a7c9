// A method's two forms side by side on every frame of a shot: the shaders against the kernels.
#pragma once
#include <string>
#include <vector>

#include "gpu/method.h"
#include "methods/spec.h"
#include "shot/reader.h"
#include "study/progress.h"
#include "study/protocol.h"

namespace aa {

struct VerifyOptions {
    std::vector<MethodSpec> methods;
    std::vector<size_t> frames;  // indices into the manifest, ascending
    DisplayChain display;
    Exec exec;  // of the processor's form
};

// Differences of the outputs, in the method's own space, each channel by max(1, |processor's|): absolute where values
// are displayable, relative above.
struct VerifyResult {
    std::string text, family;
    double most = 0, rms = 0;
    double shareAboveCode = 0;  // of pixels that differ by more than 1/255 in a channel
    size_t notFinite = 0;       // values that are no number in one form alone
    int worstFrame = 0, worstX = 0, worstY = 0;
    std::vector<double> mostByFrame;
    size_t stateBytes = 0, deviceStateBytes = 0;
};

// Throws InputError, UsageError, gpu::DeviceError.
std::vector<VerifyResult> verify(const ShotReader& shot, const VerifyOptions& options, gpu::Session& session,
                                 const Progress& progress);

}  // namespace aa
