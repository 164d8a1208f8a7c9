// What `aaresolve stability` writes: stability.json, a text for a terminal, the page docs/results/stability.md.
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "image/formatted.h"
#include "image/json_text.h"
#include "methods/float_bounds.h"
#include "study/json_number.h"
#include "study/stability.h"

namespace aa {
namespace {
using json = nlohmann::ordered_json;

json toJson(const Deviation& d) {
    return {{"max", jsonNumber(d.max)},
            {"rms", jsonNumber(d.rms)},
            {"ulp", jsonNumber(d.ulp)},
            {"ulpMost", jsonNumber(d.ulpMost)},
            {"notFinite", d.notFinite}};
}
json toJson(const Settling& s) {
    return {{"stallCodes", jsonNumber(s.stallCodes)},
            {"bandingCodes", jsonNumber(s.bandingCodes)},
            {"drift", jsonNumber(s.drift)}};
}
// What a method is held to: a share of the value, or, where it is written so, of the largest value around.
json boundJson(const MethodStability& m) {
    const FloatBound* b = writtenFloatBound(m.id);
    if (!b) return {{"of", "value"}, {"most", kFloatBound}};
    return {{"of", "largest"}, {"most", b->ofLargest}, {"reason", b->reason}};
}
json toJson(const MethodStability& m) {
    json j = {{"method", m.text}, {"title", m.title}, {"family", m.family}, {"history", m.keepsHistory}};
    const auto maybe = [](json& to, const char* key, const auto& v) {
        if (v) to[key] = toJson(*v);
    };
    j["float"] = toJson(m.lanes);
    maybe(j, "history16", m.half), maybe(j, "history8", m.byte);
    maybe(j, "gpuExact", m.gpuExact), maybe(j, "gpuFast", m.gpuFast);
    j["wideLight"] = {{"ofValue", jsonNumber(m.wideLight.ofValue)},
                      {"ofLargest", jsonNumber(m.wideLight.ofLargest)},
                      {"bound", boundJson(m)}};
    json& a = j["amplification"] = {{"largest", jsonNumber(m.amplification.largest())}};
    for (const double v : m.amplification.most) a["most"].push_back(jsonNumber(v));
    for (const double v : m.amplification.rms) a["rms"].push_back(jsonNumber(v));
    if (m.settling) {
        json& s = j["settling"] = json::object();
        maybe(s, "32f", m.settling), maybe(s, "16f", m.settlingHalf), maybe(s, "8", m.settlingByte);
    }
    if (m.recovery) {
        j["recovery"] = {{"frames", nullptr}, {"tried", m.recovery->tried}};
        if (m.recovery->frames) j["recovery"]["frames"] = *m.recovery->frames;
    }
    j["ties"] = {{"share", m.tieShare}, {"pixels", m.tiePixels}};
    return j;
}

// ---- tables ----
const char* const kNone = "–";
std::string inTable(double v) {
    if (const char* word = nonFinite(v)) return word;
    return v == 0 ? "0" : formatted(v >= 1000 ? "%.0f" : "%.2g", v);
}
std::string cell(const std::optional<Deviation>& d) {
    if (!d) return kNone;
    return inTable(d->max) + " · " + inTable(d->rms) + " · " + inTable(d->ulp) +
           (d->notFinite ? formatted(", %zu not finite", d->notFinite) : "");
}
std::string wideLightCell(const MethodStability& m) {
    return writtenFloatBound(m.id) ? inTable(m.wideLight.ofLargest) + " of the largest" : inTable(m.wideLight.ofValue);
}
std::string codes(const std::optional<Settling>& s, double Settling::*figure) {
    return s ? formatted("%.2f", (*s).*figure) : kNone;
}
std::string drift(const std::optional<Settling>& s) { return s ? formatted("%.1e", s->drift) : kNone; }
std::string recovery(const std::optional<Recovery>& r) {
    if (!r) return kNone;
    return r->frames ? std::to_string(*r->frames) : "> " + std::to_string(r->tried);
}
std::string ties(const MethodStability& m) { return m.tieShare == 0 ? "0" : formatted("%.2g %%", 100 * m.tieShare); }

// A table as both the terminal and the page show it.
struct Table {
    std::string title;
    std::vector<std::string> heads;
    std::vector<std::vector<std::string>> rows;
};
std::vector<Table> tablesOf(const StabilityResults& r) {
    Table accuracy{
        "Against the double form: max · rms · ulp", {"method", "float lanes", "16-bit history", "8-bit history"}, {}};
    if (!r.device.empty()) accuracy.heads.insert(accuracy.heads.end(), {"GPU exact", "GPU fast"});
    accuracy.heads.push_back("light of 1e-6 to 1e6");
    Table changes{"Small changes", {"method", "most", "in frame", "rms, first frame", "rms, last", "ties"}, {}};
    Table history{
        "Histories at rest: 32-bit, 16-bit, 8-bit",
        {"method", "stall, codes", "16", "8", "banding, codes", "16", "8", "drift", "16", "8", "recovers after"},
        {}};
    for (const MethodStability& m : r.methods) {
        std::vector<std::string> row = {m.text, cell(m.lanes), cell(m.half), cell(m.byte)};
        if (!r.device.empty()) row.insert(row.end(), {cell(m.gpuExact), cell(m.gpuFast)});
        row.push_back(wideLightCell(m));
        accuracy.rows.push_back(std::move(row));
        const Amplification& a = m.amplification;
        const size_t worst = size_t(std::max_element(a.most.begin(), a.most.end()) - a.most.begin());
        changes.rows.push_back({m.text, inTable(a.largest()), std::to_string(worst + 1), inTable(a.rms.front()),
                                inTable(a.rms.back()), ties(m)});
        if (!m.settling) continue;
        history.rows.push_back({m.text});
        for (const auto figure : {&Settling::stallCodes, &Settling::bandingCodes})
            for (const auto* s : {&m.settling, &m.settlingHalf, &m.settlingByte})
                history.rows.back().push_back(codes(*s, figure));
        for (const auto* s : {&m.settling, &m.settlingHalf, &m.settlingByte}) history.rows.back().push_back(drift(*s));
        history.rows.back().push_back(recovery(m.recovery));
    }
    std::vector<Table> all = {std::move(accuracy), std::move(changes)};
    if (!history.rows.empty()) all.push_back(std::move(history));
    return all;
}
// Characters, not bytes: the continuation bytes of UTF-8 take no place.
size_t widthOf(const std::string& text) {
    return size_t(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}
std::string padded(const std::string& text, size_t width, bool left) {
    const std::string space(width - std::min(width, widthOf(text)), ' ');
    return left ? text + space : space + text;
}
std::string asText(const Table& t) {
    std::vector<size_t> widths;
    for (size_t k = 0; k < t.heads.size(); k++) {
        widths.push_back(widthOf(t.heads[k]));
        for (const auto& row : t.rows) widths[k] = std::max(widths[k], widthOf(row[k]));
    }
    std::string text = t.title + "\n";
    const auto line = [&](const std::vector<std::string>& cells) {
        std::string l;
        for (size_t k = 0; k < cells.size(); k++) l += (k ? "  " : "") + padded(cells[k], widths[k], k == 0);
        text += l + "\n";
    };
    line(t.heads);
    for (const auto& row : t.rows) line(row);
    return text;
}
std::string asMarkdown(const Table& t) {
    std::string text;
    const auto line = [&](const std::vector<std::string>& cells, bool isHead) {
        text += "|";
        for (size_t k = 0; k < cells.size(); k++)
            text += " " + (k == 0 && !isHead ? "`" + cells[k] + "`" : cells[k]) + " |";
        text += "\n";
    };
    line(t.heads, true);
    text += "|---|";
    for (size_t k = 1; k < t.heads.size(); k++) text += "---:|";
    text += "\n";
    for (const auto& row : t.rows) line(row, false);
    return text;
}
std::string deviceInWords(const StabilityResults& r) {
    return r.device.empty() ? "GPU forms left out: " + r.noDevice + "."
                            : "GPU forms on " + r.device + (r.deviceKind == "cpu" ? " (software)" : "") + ".";
}
std::string materialInWords(const StabilityResults& r) {
    return formatted("%dx%d, %d frames (%d for methods without a history), %d at rest, seed %u", r.width, r.height,
                     r.frames, std::min(r.frames, kStatelessFrames), r.longFrames, unsigned(r.seed));
}
}  // namespace

std::string toJsonText(const StabilityResults& r) {
    json j = {{"format", "aaresolve-stability"}, {"version", 1}, {"program", r.program}, {"complete", r.complete}};
    j["material"] = {{"words", r.material},        {"resolution", {r.width, r.height}},
                     {"frames", r.frames},         {"statelessFrames", std::min(r.frames, kStatelessFrames)},
                     {"longFrames", r.longFrames}, {"seed", r.seed}};
    if (!r.shot.empty()) j["material"]["shot"] = r.shot;
    if (!r.sanitised.empty()) j["material"]["sanitised"] = r.sanitised;
    if (r.device.empty())
        j["noDevice"] = r.noDevice;
    else
        j["device"] = {{"name", r.device}, {"kind", r.deviceKind}, {"driver", r.driver}};
    j["methods"] = json::array();
    for (const auto& m : r.methods) j["methods"].push_back(toJson(m));
    return jsonText(j) + "\n";
}

std::string toText(const StabilityResults& r) {
    std::string text = r.material + ": " + materialInWords(r) + "\n";
    for (const auto& [what, count] : r.sanitised)
        text += "input values that no method can use: " + what + " " + std::to_string(count) + "\n";
    for (const Table& t : tablesOf(r)) text += "\n" + asText(t);
    text += "\n" + deviceInWords(r) + " What the figures mean: docs/stability.md.\n";
    return text;
}

std::string toMarkdown(const StabilityResults& r) {
    const std::vector<Table> tables = tablesOf(r);
    std::string text =
        "# The accuracy that speed costs\n\n"
        "Generated by `aaresolve stability --markdown` (`make docs`); do not edit. What every figure means:\n"
        "[stability.md](../stability.md). What the speed is: [speed.md](speed.md).\n\n" +
        std::string(1, char(std::toupper(r.material[0]))) + r.material.substr(1) + ":\n" + materialInWords(r) + ". " +
        deviceInWords(r) + "\n";
    const char* const notes[] = {
        "Largest and root-mean-square difference, by max(1, value), and the units in the last place within which 99 % "
        "of "
        "the values are. In the\nlast column the largest error as a share of the value, or of the largest value around "
        "where a bound is written below.",
        "A change of every colour of every frame by one unit in the last place: the most that it becomes in the "
        "output, "
        "in units in the last\nplace, and in which frame; root mean square in the first and the last frame. Ties: "
        "pixels "
        "that jump when the input moves by 1e-6 of\nitself.",
        "Codes are those of 8 bits. Stall: what is still missed 256 frames after a step of 8 codes. Banding: steps on "
        "a "
        "slow gradient. Drift:\nrelative change of the mean. Recovers: frames after a bright pixel until nothing is "
        "left "
        "of it."};
    for (size_t k = 0; k < tables.size(); k++)
        text += "\n## " + tables[k].title + "\n\n" + notes[k] + "\n\n" + asMarkdown(tables[k]);
    text +=
        "\n## Written bounds\n\nFloat keeps to double within " + inTable(kFloatBound) +
        " of every value (no value less than 1e-6) where light spans 1e-6 to 1e6 by chance from pixel to\npixel, but "
        "in these methods, which keep to a share of the largest value in 7x7 pixels around. A test holds every "
        "method to it.\n\n| method | of the largest around | why |\n|---|---:|---|\n";
    for (const FloatBound& b : writtenFloatBounds())
        text += "| `" + std::string(b.method) + "` | " + inTable(b.ofLargest) + " | " + std::string(b.reason) + " |\n";
    return text;
}

bool holdsCompleteStability(const std::filesystem::path& file) {
    const auto text = textOf(file);
    if (!text) return false;
    try {
        const auto j = parseJson(*text, file.string(), "");
        return j.is_object() && j.value("format", "") == "aaresolve-stability" && j.value("complete", false);
    } catch (const std::exception&) {
        return false;
    }
}

}  // namespace aa
