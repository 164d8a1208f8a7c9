// JSON as it is written: a text that is no UTF-8 (a path in another encoding) gets U+FFFD for what cannot be read, as
// JSON holds nothing else.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace aa {

// indent -1: on one line.
template <class Json>
std::string jsonText(const Json& value, int indent = 1) {
    return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace aa
