// The two ways in which a user's request fails. Each carries one line for the user and is caught once, in cli/.
#pragma once
#include <stdexcept>

namespace aa {

struct InputError : std::runtime_error {  // bad input: exit code 3
    using std::runtime_error::runtime_error;
};
struct UsageError : std::runtime_error {  // wrong usage: exit code 2
    using std::runtime_error::runtime_error;
};

}  // namespace aa
