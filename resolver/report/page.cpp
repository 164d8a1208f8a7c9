#include "report/page.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "image/colour_map.h"
#include "image/error.h"
#include "image/json_text.h"
#include "image/markup.h"
#include "metrics/metric.h"
#include "report/format.h"
#include "report/web/web_files.h"
#include "study/json_number.h"

namespace aa {

std::string filled(std::string_view page, std::initializer_list<std::pair<std::string_view, std::string_view>> places) {
    std::string text;
    for (size_t at = 0; at < page.size();) {
        const size_t open = page.find("{{", at);
        text += page.substr(at, open == std::string_view::npos ? open : open - at);
        if (open == std::string_view::npos) break;
        const size_t close = page.find("}}", open);
        const auto place = std::find_if(places.begin(), places.end(), [&](const auto& p) {
            return close != std::string_view::npos && p.first == page.substr(open + 2, close - open - 2);
        });
        text += place == places.end() ? std::string_view("{{") : place->second;
        at = place == places.end() ? open + 2 : close + 2;
    }
    return text;
}

std::string forScript(const nlohmann::ordered_json& j) {
    const std::string text = jsonText(j, -1);
    std::string safe;
    safe.reserve(text.size());
    // Every one, not "</" alone: after "<!--<script>" an end tag ends nothing.
    for (const char c : text)
        if (c == '<')
            safe += "\\u003c";
        else
            safe += c;
    return safe;
}

nlohmann::ordered_json errorColoursJson() {
    constexpr int kColours = 256;
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (int i = 0; i < kColours; i++) {
        const Colour c = errorColour(double(i) / (kColours - 1));
        all.push_back({int(std::lround(255 * c[0])), int(std::lround(255 * c[1])), int(std::lround(255 * c[2]))});
    }
    return all;
}
nlohmann::ordered_json figureJson(const Figure& f) {
    return {{"name", f.name},
            {"title", f.title},
            {"about", f.help},
            {"better", f.higherIsBetter ? "high" : "low"},
            {"form", name(f.form)}};
}
nlohmann::ordered_json comparisonJson(const Comparison& c) {
    return {{"gain", jsonNumber(c.gainDb)},
            {"low", jsonNumber(c.gainLow)},
            {"high", jsonNumber(c.gainHigh)},
            {"resolved", c.resolved},
            {"why", nameOf(c.why)}};
}

std::string sectionOf(const MeasuredSection& s, const std::filesystem::path& folder) {
    const auto file = folder / s.file;
    const auto text = textOf(file);
    if (!text) return "";
    const std::string advice = "run `aaresolve " + std::string(s.command) + "` again or remove the file";
    const nlohmann::ordered_json j = parseJson(*text, file.string(), advice);
    const auto is = [&](const char* key, const nlohmann::ordered_json& v) { return j.contains(key) && j.at(key) == v; };
    if (!j.is_object() || !is("format", s.format) || !is("version", 1) || !j.contains("methods"))
        throw InputError(file.string() + ": expected what `aaresolve " + std::string(s.command) + "` writes; " +
                         advice);
    return "<script type=\"application/json\" id=\"" + std::string(s.dataId) + "\">" + forScript(j) +
           "</script>\n<script>" + std::string(s.script) + "</script>\n";
}

std::string pageHead(const std::string& title, std::initializer_list<std::string_view> styles) {
    std::string all;
    for (const auto style : styles) all += "<style>" + std::string(style) + "</style>\n";
    return filled(web::head, {{"title", forMarkup(title)}, {"styles", all}});
}

}  // namespace aa
