// noaa: no anti-aliasing, the lower baseline. Output = input, bit exact.
#pragma once
#include "methods/method.h"

namespace aa {
MethodDescriptor noaaDescriptor();
}
