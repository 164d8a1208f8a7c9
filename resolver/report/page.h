// What the pages share: their files' places for text, and text made safe for them.
#pragma once
#include <filesystem>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>

namespace aa {
struct Comparison;
struct Figure;

// `page` with each {{name}} replaced. What is put in is not searched for places again.
std::string filled(std::string_view page, std::initializer_list<std::pair<std::string_view, std::string_view>> places);
// Inside <script>, where "</" would end it: "\u003c" is the same in a JSON string.
std::string forScript(const nlohmann::ordered_json& j);
// The 256 colours of errors, [red, green, blue] in codes, of 0 first.
nlohmann::ordered_json errorColoursJson();
// A figure of the program's table as the pages read it.
nlohmann::ordered_json figureJson(const Figure& figure);
// A gain as the pages read it, with its doubt: `doubt` of tables.js.
nlohmann::ordered_json comparisonJson(const Comparison& c);

// A section of the report that another command measured: the data of a JSON file and the script that draws them.
struct MeasuredSection {
    std::string_view file;     // in the run's folder
    std::string_view format;   // its member "format"
    std::string_view command;  // that writes it
    std::string_view dataId;   // of the element that holds it
    std::string_view script;
};
// What goes before </body>; empty where the folder has no such file. Throws InputError: damaged, or another format.
std::string sectionOf(const MeasuredSection& section, const std::filesystem::path& folder);

// Everything before <body>, the same on every page: `title` is text, `styles` are inlined in this order.
std::string pageHead(const std::string& title, std::initializer_list<std::string_view> styles);

}  // namespace aa
