// The two ways in which a user's request fails. Each carries one line for the user and is caught once, in cli/.
#pragma once
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace aa {

struct InputError : std::runtime_error {  // bad input: exit code 3
    using std::runtime_error::runtime_error;
};
struct UsageError : std::runtime_error {  // wrong usage: exit code 2
    using std::runtime_error::runtime_error;
};

// The candidate nearest to `word` by edit distance, for "did you mean"; empty when none is near.
std::string suggestion(std::string_view word, const std::vector<std::string_view>& candidates);

}  // namespace aa
