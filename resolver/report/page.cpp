#include "report/page.h"

#include <nlohmann/json.hpp>

#include "image/json_text.h"

namespace aa {

std::string filled(std::string_view page, std::initializer_list<std::pair<std::string_view, std::string_view>> places) {
    std::string text(page);
    for (const auto& [name, with] : places) {
        const std::string place = "{{" + std::string(name) + "}}";
        text.replace(text.find(place), place.size(), with);
    }
    return text;
}

std::string forScript(const nlohmann::ordered_json& j) {
    const std::string text = jsonText(j, -1);
    std::string safe;
    safe.reserve(text.size());
    for (const char c : text) {
        if (c == '/' && !safe.empty() && safe.back() == '<') safe += '\\';
        safe += c;
    }
    return safe;
}

std::string forHtml(const std::string& text) {
    std::string safe;
    for (const char c : text) safe += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
    return safe;
}

}  // namespace aa
