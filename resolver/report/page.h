// What the pages share: their files' places for text, and text made safe for them.
#pragma once
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>

namespace aa {
struct Figure;

// `page` with each {{name}} replaced. What is put in is not searched for places again.
std::string filled(std::string_view page, std::initializer_list<std::pair<std::string_view, std::string_view>> places);
// Inside <script>, "</" would end it; "<\/" is the same JSON string.
std::string forScript(const nlohmann::ordered_json& j);
// The 256 colours of errors, [red, green, blue] in codes, of 0 first.
nlohmann::ordered_json errorColoursJson();
// A figure of the program's table as the pages read it.
nlohmann::ordered_json figureJson(const Figure& figure);

// Everything before <body>, the same on every page: `title` is text, `styles` are inlined in this order.
std::string pageHead(const std::string& title, std::initializer_list<std::string_view> styles);

}  // namespace aa
