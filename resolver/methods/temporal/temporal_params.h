// Parameters that several temporal methods share, each declared once, and what a method reads of them.
#pragma once
#include <string_view>

#include "methods/method.h"
#include "methods/temporal/history.h"
#include "methods/temporal/temporal_kernels.h"

namespace aa::temporal {

ParamSpec unjitterParam(bool def, std::string_view source);
ParamSpec luminanceParam(std::string_view def, std::string_view source, std::string_view onlyWhen = {});
ParamSpec dilationParam(std::string_view def, std::string_view source);
ParamSpec historyFilterParam(std::string_view def, std::string_view source);
ParamSpec historyClampParam();  // every method with historyFilterParam has it
ParamSpec neighbourhoodParam(std::string_view def, std::string_view source);
ParamSpec clipTargetParam(std::string_view def, std::string_view source);
ParamSpec warmupParam();
ParamSpec historyBitsParam(Space space);  // eight bits hold display-encoded colours only
ParamSpec ditherParam(Space space);
ParamSpec outsideParam();
ParamSpec sharpenParam(std::string_view def, std::string_view source);
// The two ends of the luminance feedback (conventions 7.8).
ParamSpec kMinParam(std::string_view def, std::string_view source);
ParamSpec kMaxParam(std::string_view def, std::string_view source);
// Thresholds of the rejection by geometry (conventions 7.3): read together by rejectionTest().
ParamSpec depthToleranceParam(std::string_view onlyWhen = {});
ParamSpec bothSidesParam(std::string_view onlyWhen = {});
ParamSpec magnificationParam(std::string_view def, std::string_view source);
// Where the sample count of the last frame is read: countAtPixel().
ParamSpec countAtParam(std::string_view source, std::string_view onlyWhen = {});
void requireOrdered(std::string_view method, const Params& p);  // kmin <= kmax, else UsageError

Dilation dilation(const Params& p);
HistoryFilter historyFilter(const Params& p);
Neighbourhood neighbourhood(const Params& p);
ClipTarget clipTarget(const Params& p);
HistoryStorage historyStorage(const Params& p);
Luminance luminance(const Params& p);
SharpenKernel sharpenKernel(const Params& p);
RejectionTest rejectionTest(const Params& p);
bool countAtPixel(const Params& p);

// Depth is read only to dilate motion by it.
PassSet dilationPasses(const Params& p);

// Largest weight that history may have in the frame t after a reset: warmup=ramp gives each of the first frames the
// weight 1/(t+1), as a running mean.
float feedbackCeiling(const Params& p, int framesSinceReset);

}  // namespace aa::temporal
