// What the pages share: their files' places for text, and text made safe for them.
#pragma once
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>

namespace aa {

// `page` with each {{name}} replaced, in this order; a place is filled once.
std::string filled(std::string_view page, std::initializer_list<std::pair<std::string_view, std::string_view>> places);
// Inside <script>, "</" would end it; "<\/" is the same JSON string.
std::string forScript(const nlohmann::ordered_json& j);
std::string forHtml(const std::string& text);

}  // namespace aa
