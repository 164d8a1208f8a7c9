// noaa: no anti-aliasing, the lower baseline. Source: seed 000 s.5; methods/01 s.1.1. Output = input, bit exact.
#pragma once
#include "methods/method.h"

namespace aa {
MethodDescriptor noaaDescriptor();
}
