#include "image/json_text.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <vector>

#include "image/error.h"
#include "image/inputs.h"

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

using Event = json::parse_event_t;

// Follows the parser through a document and says which values stay in its tree.
class ListReader {
  public:
    explicit ListReader(const JsonList& list) : list_(list) {}
    bool keeps(int depth, Event event, const json& value) {
        if (depth == 1 && event == Event::key) {
            isNext_ = value.get_ref<const std::string&>() == list_.member;
        } else if (depth == 1) {
            isInside_ = event == Event::array_start && isNext_;
        } else if (depth == 2 && isInside_ && isEnd(event)) {
            list_.element(value);
            return false;
        }
        return true;
    }

  private:
    static bool isEnd(Event e) { return e == Event::object_end || e == Event::array_end || e == Event::value; }
    const JsonList& list_;
    bool isNext_ = false, isInside_ = false;
};

// The members of the objects that are open. A member that stands twice has two values, of which nobody knows which was
// meant.
class OpenObjects {
  public:
    bool isSecond(Event event, const json& value) {
        if (event == Event::object_start) members_.emplace_back();
        if (event == Event::object_end) members_.pop_back();
        return event == Event::key && !members_.back().insert(value.get_ref<const std::string&>()).second;
    }

  private:
    std::vector<std::set<std::string>> members_;
};

template <class Keeps>
json parsed(const std::string& text, const std::string& file, const std::string& advice, const Keeps& keeps) {
    OpenObjects objects;
    try {
        return json::parse(text, [&](int depth, Event event, json& value) {
            if (objects.isSecond(event, value))
                throw InputError(file + ": member '" + value.get_ref<const std::string&>().substr(0, 40) +
                                 "' stands twice in one object; " + advice);
            if (depth > kMaxDepth)
                throw InputError(file + ": nested deeper than " + std::to_string(kMaxDepth) + " levels; " + advice);
            return keeps(depth, event, value);
        });
    } catch (const json::parse_error& e) {
        throw InputError(file + ": not valid JSON at " + lineAndColumn(text, e.byte) + "; " + advice);
    } catch (const json::exception&) {
        throw InputError(file + ": holds a number that does not fit into a double; " + advice);
    }
}
}  // namespace

json parseJson(const std::string& text, const std::string& file, const std::string& advice) {
    return parsed(text, file, advice, [](int, Event, const json&) { return true; });
}
json parseJson(const std::string& text, const std::string& file, const std::string& advice, const JsonList& list) {
    ListReader reader(list);
    return parsed(text, file, advice,
                  [&](int depth, Event event, const json& value) { return reader.keeps(depth, event, value); });
}

std::optional<std::string> textOf(const fs::path& file) {
    std::error_code failed;
    const fs::file_status about = fs::status(file, failed);
    if (!fs::is_regular_file(about) && !fs::is_fifo(about)) return std::nullopt;
    noteInput(file);
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
