#include "image/json_text.h"

#include <algorithm>

#include "image/error.h"

namespace aa {
using nlohmann::json;

namespace {
constexpr int kMaxDepth = 64;  // nesting; our own files need 8

std::string lineAndColumn(const std::string& text, size_t byte) {
    const size_t at = std::min(byte > 0 ? byte - 1 : 0, text.size());
    const auto line = 1 + std::count(text.begin(), text.begin() + ptrdiff_t(at), '\n');
    const size_t lineStart = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
    return "line " + std::to_string(line) + ", column " +
           std::to_string(at - (lineStart == std::string::npos ? 0 : lineStart + 1) + 1);
}
}  // namespace

json parseJson(const std::string& text, const std::string& file, const std::string& advice) {
    try {
        return json::parse(text, [&](int depth, json::parse_event_t, json&) {
            if (depth > kMaxDepth)
                throw InputError(file + ": nested deeper than " + std::to_string(kMaxDepth) + " levels; " + advice);
            return true;
        });
    } catch (const json::parse_error& e) {
        throw InputError(file + ": not valid JSON at " + lineAndColumn(text, e.byte) + "; " + advice);
    } catch (const json::exception&) {
        throw InputError(file + ": holds a number that does not fit into a double; " + advice);
    }
}

}  // namespace aa
