// Output that cannot be written: a full disk, a folder without permission, a closed pipe. Exit code 1, since neither
// the request nor the input is at fault.
#pragma once
#include "image/error.h"

namespace aa {

struct OutputError : InputError {
    using InputError::InputError;
};

}  // namespace aa
