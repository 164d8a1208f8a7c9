#include "image/json_text.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "image/error.h"

namespace aa {
namespace fs = std::filesystem;
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

std::optional<std::string> textOf(const fs::path& file) {
    std::error_code failed;
    const fs::file_status about = fs::status(file, failed);
    if (!fs::is_regular_file(about) && !fs::is_fifo(about)) return std::nullopt;
    std::ifstream in(file, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(in), {}};
    return in.bad() || !in.is_open() ? std::nullopt : std::optional(std::move(text));
}

bool isPathBelow(const std::string& path) {
    const fs::path p(path);
    bool below = !path.empty() && path.find('\0') == std::string::npos && path.find('\\') == std::string::npos &&
                 p.is_relative();
    for (const auto& step : p) below = below && step != "..";
    return below;
}

}  // namespace aa
