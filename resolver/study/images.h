// The images that a run leaves behind.
#pragma once
#include <functional>
#include <string>

#include "methods/driver.h"
#include "metrics/measure.h"
#include "study/run.h"

namespace aa {

// Images that are compared are displayed by the protocol's chain and, if asked, rounded to 8-bit codes. EXR files are
// never rounded: they hold linear light, of methods with encoded output decoded again; with the identity transfer the
// displayed values. PNG files hold the displayed values as codes. Both return a path relative to options.out.
std::string writeImage(const RunningMethod& method, int frame, const RunOptions& options);
std::string writeTruthImage(const Reference& reference, int frame, const RunOptions& options);
// What options.maps asks for, of its difference from `measured`: the reference, or its region.
// `sequenceMap` gives the values of maps over time; empty ones are not drawn.
void writeMaps(const RunningMethod& method, const Reference& measured, int frame, const RunOptions& options,
               const std::function<PlaneF(const MapKind&)>& sequenceMap);

}  // namespace aa
