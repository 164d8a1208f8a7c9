// JSON as it is written and read: shot.json, results, surveys and their answers.
#pragma once
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace aa {

// A text that is no UTF-8 (a path in another encoding) gets U+FFFD for what cannot be read, as JSON holds nothing else.
// indent -1: on one line.
template <class Json>
std::string jsonText(const Json& value, int indent = 1) {
    return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

// `file` begins the message of an error and `advice` ends it. Throws InputError, one line: not JSON (with line and
// column), nested too deep, a number beyond a double, a member that stands twice.
nlohmann::json parseJson(const std::string& text, const std::string& file, const std::string& advice);
// A list that is read as it goes: a member of the document whose elements are handed on one by one and left out of the
// tree, which takes ten times the room of its text. Where the member is no list nothing is handed on.
struct JsonList {
    std::string_view member;
    std::function<void(const nlohmann::json&)> element;
};
nlohmann::json parseJson(const std::string& text, const std::string& file, const std::string& advice,
                         const JsonList& list);

// A whole file; nothing where there is none, or none that ends: a folder, a device. A pipe may be one.
std::optional<std::string> textOf(const std::filesystem::path& file);

// Whether a path in a document stays below the folder that the document speaks of.
bool isPathBelow(const std::string& path);

}  // namespace aa
