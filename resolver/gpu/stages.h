// The stages of methods/stage.h on the device, between a method's last shader and the download: shaders/stages/. A new
// stage = one class in stages.cpp and one line in makeStage().
#pragma once
#include "gpu/method.h"

namespace aa::gpu {

// A stage of `method`'s specification. Throws UsageError where it, or the method that it runs, has no shader (named).
std::unique_ptr<DeviceStage> makeStage(Session& session, const StageSpec& stage, const MethodSpec& method,
                                       const ShotInfo& shot);

}  // namespace aa::gpu
