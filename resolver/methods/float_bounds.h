// How far the fast form (float lanes) may be from the double form where light spans twelve decades, 1e-6 to 1e6, by
// chance from pixel to pixel: within 1e-3 of every value, or within a bound that is written here with its reason.
// `aaresolve stability` prints the table and tests hold every method to it.
#pragma once
#include <span>
#include <string_view>

namespace aa {

// Of the value itself, but no value less than 1e-6.
inline constexpr double kFloatBound = 1e-3;

// Methods of which float keeps less than that of a value beside light a million times as bright: what it keeps is a
// share of the largest value in 7x7 pixels around.
struct FloatBound {
    std::string_view method, reason;
    double ofLargest = kFloatBound;
};
std::span<const FloatBound> writtenFloatBounds();
const FloatBound* writtenFloatBound(std::string_view method);  // null: kFloatBound of every value

}  // namespace aa
