// What synthetic frames must have for a method to run on them.
#pragma once
#include <string>

#include "methods/spec.h"

namespace aa {

// The first sub-sample pattern that the method accepts; empty where it reads none. Throws what creating it throws when
// none serves.
std::string subSamplePatternFor(const MethodSpec& method);
// A scene of `synth` that has the passes which the method reads: `asked`, or, where that is empty, `moving`, whose
// discs have no edges that a pass could list, and half_planes for methods that read such. Throws UsageError: `asked`
// has none.
std::string synthSceneFor(const MethodSpec& method, const std::string& asked = "");

}  // namespace aa
