#include "shot/import/engine_layout.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "image/error.h"
#include "image/json_text.h"
#include "image/readable.h"
#include "shot/manifest.h"
#include "shot/pass_table.h"

namespace aa {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

// An object of the file, whose members are taken one by one; what is left over was misspelt.
class Object {
  public:
    Object(const json& value, std::string path, const fs::path& file)
        : value_(value), path_(std::move(path)), file_(file) {
        if (!value.is_object()) fail("", "an object");
    }
    [[noreturn]] void fail(const std::string& member, const std::string& expected) const {
        const std::string name = member.empty() ? path_ : path_.empty() ? member : path_ + "." + member;
        const auto it = member.empty() ? value_.end() : value_.is_object() ? value_.find(member) : value_.end();
        std::string found = it == value_.end() ? "" : it->dump(-1, ' ', true, json::error_handler_t::replace);
        if (found.size() > 40) found = found.substr(0, 40) + "...";
        throw InputError(file_.string() + ": " + (name.empty() ? "the document" : name) + ": expected " + expected +
                         (found.empty() ? "" : ", found " + found) + " (docs/format.md describes this file)");
    }
    const json* find(const std::string& member) {
        taken_.insert(member);
        const auto it = value_.find(member);
        return it == value_.end() || it->is_null() ? nullptr : &*it;
    }
    std::optional<Object> object(const std::string& member) {
        const json* j = find(member);
        return j ? std::optional(Object(*j, path_.empty() ? member : path_ + "." + member, file_)) : std::nullopt;
    }
    std::optional<std::string> text(const std::string& member) {
        const json* j = find(member);
        if (j && !j->is_string()) fail(member, "a text");
        return j ? std::optional(j->get<std::string>()) : std::nullopt;
    }
    std::optional<double> number(const std::string& member) {
        const json* j = find(member);
        if (j && !(j->is_number() && std::isfinite(j->get<double>()))) fail(member, "a number");
        return j ? std::optional(j->get<double>()) : std::nullopt;
    }
    bool flag(const std::string& member, bool otherwise) {
        const json* j = find(member);
        if (j && !j->is_boolean()) fail(member, "true or false");
        return j ? j->get<bool>() : otherwise;
    }
    // One of some words; the first is what is meant without the member, unless it must be there.
    size_t choice(const std::string& member, const std::vector<std::string>& words, bool required = false) {
        const auto given = text(member);
        if (!given && !required) return 0;
        const auto it = given ? std::find(words.begin(), words.end(), *given) : words.end();
        std::string all;
        for (const auto& w : words) all += (all.empty() ? "" : w == words.back() ? " or " : ", ") + w;
        if (it == words.end()) fail(member, all);
        return size_t(it - words.begin());
    }
    void finish() const {
        for (const auto& [name, member] : value_.items())
            if (!taken_.contains(name)) {
                const std::vector<std::string_view> known(taken_.begin(), taken_.end());
                const std::string near = suggestion(name, known);
                throw InputError(file_.string() + ": " + (path_.empty() ? "" : path_ + ": ") + "unknown member '" +
                                 name + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?") +
                                 " (docs/format.md describes this file)");
            }
    }
    const json& value() const { return value_; }

  private:
    const json& value_;
    std::string path_;
    const fs::path& file_;
    std::set<std::string> taken_;
};

EngineSource sourceOf(Object& o, std::vector<std::string> usual) {
    EngineSource s;
    s.files = o.text("files").value_or("");
    const size_t at = s.files.find("{frame}");
    if (at == std::string::npos || s.files.find("{frame}", at + 1) != std::string::npos ||
        fs::path(s.files).filename().string().find("{frame}") == std::string::npos || !isPathBelow(s.files))
        o.fail("files", "a path below the folder of frames with {frame} once in its file name, as color/{frame}.exr");
    s.part = o.text("part").value_or("");
    s.channels = std::move(usual);
    if (const json* given = o.find("channels")) {
        const std::string expected = "a list of " + std::to_string(s.channels.size()) + " channel names";
        if (!given->is_array() || given->size() != s.channels.size()) o.fail("channels", expected);
        for (size_t i = 0; i < s.channels.size(); i++) {
            if (!(*given)[i].is_string()) o.fail("channels", expected);
            s.channels[i] = (*given)[i].get<std::string>();
        }
    }
    return s;
}
void depthOf(Object& o, EnginePasses& p) {
    p.depthKind = DepthKind(o.choice("kind", {"planar", "distance", "device", "reversed"}, true));
    const bool device = p.depthKind == DepthKind::device || p.depthKind == DepthKind::reversed;
    const auto near = o.number("near"), far = o.number("far"), background = o.number("background");
    if (device) {
        if (!near || !(*near > 0)) o.fail("near", "the distance of the near plane, above 0, which device depth needs");
        if (far && !(*far > *near)) o.fail("far", "a distance beyond near; leave it out where it is infinite");
        p.nearPlane = *near, p.farPlane = far.value_or(0);
    } else if (near || far) {
        o.fail(near ? "near" : "far", "nothing: only device depth (device, reversed) has planes");
    }
    if (const auto scale = o.number("scale")) {
        if (device || !(*scale > 0)) o.fail("scale", "scene units per stored unit, above 0, of planar or distance");
        p.depthScale = *scale;
    }
    if (background && device) o.fail("background", "nothing: device depth ends at its far plane");
    p.background = background;
}
EnginePasses passesIn(Object& o) {
    EnginePasses p;
    for (const PassInfo& info : allPasses()) {
        const std::string name(info.name);
        if (info.isList || info.perSubSample || info.pass == Pass::edges) continue;
        auto pass = o.object(name);
        if (!pass) continue;
        std::vector<std::string> usual(info.groups[0].channels.begin(), info.groups[0].channels.end());
        for (auto& channel : usual)  // "albedo.R" of a shot is R in a file of its own
            if (const size_t dot = channel.find('.'); dot != std::string::npos) channel = channel.substr(dot + 1);
        p.sources[info.pass] = sourceOf(*pass, usual);
        if (info.pass == Pass::depth) depthOf(*pass, p);
        if (info.pass == Pass::motion) {
            p.motionUnit = MotionUnit(pass->choice("units", {"px", "uv", "ndc"}, true));
            p.motionFromNow = pass->choice("means", {"current-previous", "previous-current"}, true) == 1;
            p.motionYUp = pass->choice("y", {"down", "up"}, true) == 1;
            p.motionJittered = pass->flag("jittered", false);
        }
        if (info.pass == Pass::normal) {
            p.normalSpace = NormalSpace(pass->choice("space", {"world", "view"}));
            p.normalUnsigned = pass->choice("encoding", {"signed", "unsigned"}) == 1;
        }
        pass->finish();
    }
    o.finish();
    if (!p.sources.contains(Pass::color)) o.fail("color", "an object: every shot has colour");
    return p;
}
void jitterOf(Object& o, int width, int height, EngineLayout& layout) {
    layout.jitterSequence = o.text("sequence").value_or("file");
    const size_t unit = o.choice("units", {"px", "uv", "ndc"}, true);
    const bool up = o.choice("y", {"down", "up"}, true) == 1;
    const bool ofImage = o.choice("of", {"sample", "image"}, true) == 1;
    const json* offsets = o.find("offsets");
    if (!offsets || !offsets->is_array() || offsets->empty()) o.fail("offsets", "a list of [x, y], one for each frame");
    for (const json& v : *offsets) {
        if (!v.is_array() || v.size() != 2 || !v[0].is_number() || !v[1].is_number())
            o.fail("offsets", "a list of [x, y], one for each frame");
        glm::dvec2 j(v[0].get<double>(), v[1].get<double>());
        if (unit > 0) j *= glm::dvec2(width, height) * (unit == 2 ? 0.5 : 1.0);
        if (up) j.y = -j.y;
        if (ofImage) j = -j;
        if (!(std::abs(j.x) <= 0.5 + 1e-6 && std::abs(j.y) <= 0.5 + 1e-6))
            o.fail("offsets", "offsets within half a pixel (is `units` right?)");
        layout.jitterPx.push_back(j);
    }
    o.finish();
}
json parsed(const fs::path& file) {
    return parseJson(requiredText(file), file.string(), "correct it (docs/format.md describes it)");
}
}  // namespace

std::string colourFilesOf(const fs::path& file) {
    const json document = parsed(file);
    Object doc(document, "", file);
    auto passes = doc.object("passes");
    auto color = passes ? passes->object("color") : std::nullopt;
    if (!color) doc.fail("passes.color", "an object: every shot has colour");
    return sourceOf(*color, {"R", "G", "B"}).files;
}

EngineLayout readEngineLayout(const fs::path& file, int width, int height) {
    const json document = parsed(file);
    Object doc(document, "", file);
    EngineLayout layout;
    for (const char* member : {"passes", "centre", "truth"})
        if (const auto it = document.find(member); document.is_object() && it != document.end())
            layout.reads += it->dump(-1, ' ', true, json::error_handler_t::replace);
    if (doc.text("format") != "aaresolve-frames") doc.fail("format", "\"aaresolve-frames\"");
    if (doc.number("version") != 1) doc.fail("version", "1 (what this program reads)");
    layout.name = doc.text("name").value_or("shot");
    layout.fps = doc.number("fps").value_or(24);
    if (!kFps.contains(layout.fps)) doc.fail("fps", kFps.inWords);
    layout.isStatic = doc.flag("static", false);
    auto passes = doc.object("passes");
    if (!passes) doc.fail("passes", "an object");
    layout.passes = passesIn(*passes);
    if (auto centre = doc.object("centre")) {
        layout.centre = passesIn(*centre);
        if (layout.centre->sources.contains(Pass::motion))
            doc.fail("centre", "no motion: methods at the pixel centres keep no history");
    }
    if (auto truth = doc.object("truth")) {
        for (const char* half : {"a", "b"})
            if (auto h = truth->object(half)) {
                layout.truth.push_back(sourceOf(*h, {"R", "G", "B"}));
                h->finish();
            }
        if (layout.truth.empty()) truth->fail("a", "an object: where the truth lies");
        layout.truthFilter = truth->text("filter").value_or("unknown");
        layout.truthFilterWidthPx = truth->number("filter_width").value_or(0);
        if (!kTruthFilterWidthPx.contains(layout.truthFilterWidthPx))
            truth->fail("filter_width", kTruthFilterWidthPx.inWords);
        const double samples = truth->number("samples_per_half").value_or(0);
        if (!(samples >= 0 && samples <= std::numeric_limits<int>::max() && samples == std::floor(samples)))
            truth->fail("samples_per_half", "a whole number from 0 on");
        layout.truthSamplesPerHalf = int(samples);
        truth->finish();
    }
    if (auto jitter = doc.object("jitter")) jitterOf(*jitter, width, height, layout);
    if (doc.find("frames")) {
        json alone = {{"frames", *doc.find("frames")}};
        layout.notes = parseFrameNotes(alone, file);
    }
    doc.finish();
    return layout;
}

}  // namespace aa
