// The registry as JSON: for `list --json`, the add-on's panel and the docs.
#pragma once
#include <nlohmann/json.hpp>

#include "methods/method.h"

namespace aa {
nlohmann::ordered_json describe(const MethodDescriptor& method);
nlohmann::ordered_json describeRegistry();
}  // namespace aa
