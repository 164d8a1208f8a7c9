// Numbers in the program's JSON files: JSON has no infinity and no NaN, so they are texts (study/non_finite.h).
#pragma once
#include <limits>
#include <nlohmann/json.hpp>

#include "study/non_finite.h"

namespace aa {

inline nlohmann::ordered_json jsonNumber(double v) {
    if (const char* word = nonFinite(v)) return word;
    return v;
}
inline double numberOf(const nlohmann::ordered_json& j) {
    if (j.is_string()) {
        const auto& s = j.get_ref<const std::string&>();
        if (s == "Inf") return std::numeric_limits<double>::infinity();
        if (s == "-Inf") return -std::numeric_limits<double>::infinity();
        if (s == "NaN") return std::numeric_limits<double>::quiet_NaN();
    }
    return j.get<double>();  // throws on any other type
}

}  // namespace aa
