// How files and tables write what is no number: the same three words everywhere.
#pragma once
#include <cmath>

namespace aa {

// "Inf", "-Inf" or "NaN"; null for a finite number.
inline const char* nonFinite(double v) {
    if (std::isnan(v)) return "NaN";
    if (std::isinf(v)) return v > 0 ? "Inf" : "-Inf";
    return nullptr;
}

}  // namespace aa
