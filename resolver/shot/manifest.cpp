#include "shot/manifest.h"

#include <cmath>
#include <exception>
#include <set>

#include "image/error.h"
#include "image/inputs.h"
#include "image/io.h"
#include "image/json_text.h"
#include "image/readable.h"
#include "shot/frame_notes.h"

namespace aa {
namespace fs = std::filesystem;
using nlohmann::json;

namespace {
constexpr const char* kAdvice = "correct it or export the shot again";

// What an error quotes of a value: short and on one line.
std::string quoted(const json& value) {
    if (value.is_object()) return "an object";
    if (value.is_array()) return "an array of " + std::to_string(value.size());
    std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
    return text.size() > 40 ? text.substr(0, 40) + "..." : text;
}

// A value of the document with its path, for errors that name it.
class Member {
  public:
    Member(const json& value, std::string path, const std::string& file)
        : value_(value), path_(std::move(path)), file_(file) {}

    [[noreturn]] void fail(const std::string& expected) const { fail(expected, quoted(value_)); }
    [[noreturn]] void fail(const std::string& expected, const std::string& found) const {
        throw InputError(file_ + ": " + (path_.empty() ? "the document" : path_) + ": expected " + expected +
                         ", found " + found + "; correct it or export the shot again");
    }
    const json& value() const { return value_; }

    std::optional<Member> find(const char* name) const {
        const auto it = object().find(name);
        if (it == object().end()) return std::nullopt;
        return Member(*it, path_.empty() ? name : path_ + "." + name, file_);
    }
    Member operator[](const char* name) const {
        if (auto member = find(name)) return *member;
        Member(value_, path_.empty() ? name : path_ + "." + name, file_)
            .fail("a value", "nothing (the member is missing)");
    }
    Member member(const std::string& name, const json& value) const { return {value, path_ + "." + name, file_}; }
    Member item(size_t i) const { return {value_[i], path_ + "[" + std::to_string(i) + "]", file_}; }

    const json& object() const {
        if (!value_.is_object()) fail("an object");
        return value_;
    }
    size_t arraySize() const {
        if (!value_.is_array()) fail("an array");
        return value_.size();
    }
    std::string text() const {
        if (!value_.is_string()) fail("a text");
        return value_.get<std::string>();
    }
    bool flag() const {
        if (!value_.is_boolean()) fail("true or false");
        return value_.get<bool>();
    }
    double number() const {
        if (!value_.is_number()) fail("a number");
        return value_.get<double>();
    }
    double number(double min, double max, const char* what) const {
        const double v = number();
        if (!(v >= min && v <= max)) fail(what);
        return v;
    }
    double number(const NumberRange& range) const { return number(range.min, range.max, range.inWords); }
    int integer(int min, int max) const {
        const std::string expected = "an integer in " + std::to_string(min) + ".." + std::to_string(max);
        if (!value_.is_number_integer()) fail(expected);
        if (value_.is_number_unsigned() && value_.get<uint64_t>() > uint64_t(INT64_MAX)) fail(expected);
        const auto v = value_.get<int64_t>();
        if (v < min || v > max) fail(expected);
        return int(v);
    }
    std::vector<double> numbers(size_t count) const {
        const std::string expected = "an array of " + std::to_string(count) + " numbers";
        if (!value_.is_array() || value_.size() != count) fail(expected);
        std::vector<double> r;
        for (size_t i = 0; i < count; i++) r.push_back(item(i).number());
        return r;
    }
    // An offset from the pixel centre: it stays within the pixel.
    glm::dvec2 offsetPx() const {
        const auto v = numbers(2);
        if (!(std::abs(v[0]) <= 0.5 + 1e-6 && std::abs(v[1]) <= 0.5 + 1e-6))
            fail("an offset from the pixel centre within -0.5..0.5 px",
                 "[" + json(v[0]).dump() + ", " + json(v[1]).dump() + "]");
        return {v[0], v[1]};
    }
    glm::dmat4 matrix() const {  // row-major in the file, column-major in memory
        const auto v = numbers(16);
        glm::dmat4 m;
        for (int row = 0; row < 4; row++)
            for (int column = 0; column < 4; column++) m[column][row] = v[size_t(row * 4 + column)];
        return m;
    }
    // A path below the shot's folder.
    std::string relativePath() const {
        const std::string path = text();
        if (!isPathBelow(path)) fail("a relative path below the shot's folder");
        return path;
    }

  private:
    const json& value_;
    std::string path_;
    const std::string& file_;
};

// `value` without the members in `known`: what a reader of this version does not understand but must not lose.
json unknownMembers(const json& value, const std::set<std::string>& known) {
    json rest = json::object();
    for (const auto& [name, member] : value.items())
        if (!known.contains(name)) rest[name] = member;
    return rest;
}
void keepUnknown(json& extra, const char* name, const json& value, const std::set<std::string>& known) {
    json rest = unknownMembers(value, known);
    if (!rest.empty()) extra[name] = std::move(rest);
}

Camera parseCamera(const Member& m, json& extra) {
    Camera c;
    c.kind = m["kind"].text();
    if (c.kind != "perspective" && c.kind != "orthographic" && c.kind != "panorama")
        m["kind"].fail("\"perspective\", \"orthographic\" or \"panorama\"");
    c.view = m["view"].matrix();
    c.projection = m["projection"].matrix();
    c.nearClip = m["near"].number();
    c.farClip = m["far"].number(c.nearClip, INFINITY, "a distance of at least `near`");
    keepUnknown(extra, "camera", m.value(), {"kind", "view", "projection", "near", "far"});
    return c;
}

FrameEntry parseFrame(const Member& m) {
    FrameEntry f;
    f.frame = m["frame"].integer(-kLastFrame, kLastFrame);
    f.file = m["file"].relativePath();
    if (const auto c = m.find("centre"); c && !c->value().is_null()) f.centre = c->relativePath();
    if (const auto t = m.find("truth"); t && !t->value().is_null()) f.truth = t->relativePath();
    if (const auto r = m.find("reset")) f.reset = r->flag();
    if (const auto j = m.find("jitter")) f.jitterPx = j->offsetPx();
    json extra =
        unknownMembers(m.value(), {"frame", "file", "centre", "truth", "reset", "jitter", "camera", "render_seconds"});
    if (const auto c = m.find("camera")) f.camera = parseCamera(*c, extra);
    if (!extra.empty()) f.extra = jsonText(extra, -1);
    if (const auto seconds = m.find("render_seconds"))
        for (const auto& [name, value] : seconds->object().items())
            f.renderSeconds[name] = seconds->member(name, value).number();
    return f;
}

void parseObjects(const Member& m, Manifest& manifest) {
    for (const auto& [key, value] : m.object().items()) {
        const auto id = objectIdIn(key);
        if (!id) m.fail("object ids (0..4294967295) as member names", "\"" + key.substr(0, 40) + "\"");
        manifest.objects[*id] = m.member(key, value).text();
    }
}

bool isPremultiplied(const Member& jitter) {
    const auto projection = jitter.find("projection");
    if (!projection) return false;
    const std::string text = projection->text();
    if (text != "premultiplied" && text != "postmultiplied")
        projection->fail("\"postmultiplied\" or \"premultiplied\"");
    return text == "premultiplied";
}

// The frames of a document, read as they come: a tree of all of them would be most of a long run's memory. What is
// wrong with the document itself is said before what is wrong with a frame.
class FrameList {
  public:
    explicit FrameList(const std::string& file) : file_(file) {}
    JsonList list() {
        return {"frames", [this](const json& element) { add(element); }};
    }
    std::vector<FrameEntry> take(const Member& frames, bool jittered) {
        frames.arraySize();
        for (size_t i = 0; i < entries_.size(); i++) {
            if (jittered && i == firstWithoutJitter_)
                at(i, "jitter").fail("a value", "nothing (the member is missing)");
            if (i == 0) continue;
            const int before = entries_[i - 1].frame, now = entries_[i].frame;
            if (now == before)
                at(i, "frame").fail("a frame number of its own", std::to_string(now) + " for the second time");
            if (now < before)
                at(i, "frame")
                    .fail("frame numbers that increase (after " + std::to_string(before) + ")", std::to_string(now));
        }
        if (fault_) std::rethrow_exception(fault_);
        if (entries_.empty()) frames.fail("at least one frame");
        entries_.shrink_to_fit();
        return std::move(entries_);
    }

  private:
    static std::string pathOf(size_t i) { return "frames[" + std::to_string(i) + "]"; }
    Member at(size_t i, const char* member) const { return {nothing_, pathOf(i) + "." + member, file_}; }
    void add(const json& element) {
        if (fault_) return;
        try {
            const Member m(element, pathOf(entries_.size()), file_);
            if (!firstWithoutJitter_ && !m.find("jitter")) firstWithoutJitter_ = entries_.size();
            entries_.push_back(parseFrame(m));
        } catch (const InputError&) {
            fault_ = std::current_exception();
        }
    }

    const std::string& file_;
    const json nothing_;
    std::vector<FrameEntry> entries_;
    std::optional<size_t> firstWithoutJitter_;
    std::exception_ptr fault_;  // of the frame behind these
};

Manifest parseDocument(const Member& doc, FrameList& frames) {
    Manifest m;
    if (doc["format"].text() != "aaresolve-shot") doc["format"].fail("\"aaresolve-shot\"");
    if (doc["version"].integer(1, INT32_MAX) != 1) doc["version"].fail("version 1 (what this program reads)");
    if (const auto v = doc.find("name")) m.name = v->text();
    const Member resolution = doc["resolution"];
    if (resolution.arraySize() != 2) resolution.fail("[width, height]");
    m.width = resolution.item(0).integer(1, kLargestSide);
    m.height = resolution.item(1).integer(1, kLargestSide);
    if (const auto v = doc.find("fps")) m.fps = v->number(kFps);
    m.extra = unknownMembers(doc.value(), {"format", "version", "name", "resolution", "fps", "jitter", "static",
                                           "subsamples", "objects", "truth", "frames"});
    if (const auto j = doc.find("jitter")) {
        m.jitterSequence = (*j)["sequence"].text();
        if (const auto v = j->find("start")) m.jitterStart = v->integer(0, INT32_MAX);
        if (const auto v = j->find("period")) m.jitterPeriod = v->integer(1, INT32_MAX);
        m.jitterPremultiplied = isPremultiplied(*j);
        keepUnknown(m.extra, "jitter", j->value(), {"sequence", "start", "period", "projection"});
    }
    if (const auto v = doc.find("static")) m.isStatic = v->flag();
    if (const auto s = doc.find("subsamples"); s && !s->value().is_null()) {
        m.subsamplePattern = (*s)["pattern"].text();
        const Member positions = (*s)["positions"];
        if (positions.arraySize() > size_t(kMaxSubSamples))
            positions.fail("at most " + std::to_string(kMaxSubSamples) + " positions");
        for (size_t i = 0; i < positions.arraySize(); i++)
            m.subsamplePositionsPx.push_back(positions.item(i).offsetPx());
        keepUnknown(m.extra, "subsamples", s->value(), {"pattern", "positions"});
    }
    if (const auto v = doc.find("objects")) parseObjects(*v, m);
    if (const auto t = doc.find("truth"); t && !t->value().is_null()) {
        if (const auto v = t->find("samples_per_half")) m.truthSamplesPerHalf = v->integer(0, INT32_MAX);
        if (const auto v = t->find("filter")) m.truthFilter = v->text();
        if (const auto v = t->find("filter_width")) m.truthFilterWidthPx = v->number(kTruthFilterWidthPx);
        if (const auto v = t->find("halves")) m.truthHalves = v->integer(1, 2);
        keepUnknown(m.extra, "truth", t->value(), {"samples_per_half", "filter", "filter_width", "halves"});
    }
    m.frames = frames.take(doc["frames"], m.jitterSequence != "none");
    return m;
}

json offset(const glm::dvec2& v) { return {v.x, v.y}; }
json rowMajor(const glm::dmat4& m) {
    json r = json::array();
    for (int row = 0; row < 4; row++)
        for (int column = 0; column < 4; column++) r.push_back(m[column][row]);
    return r;
}
}  // namespace

json toJson(const FrameEntry& f) {
    json j = f.extra.empty() ? json::object() : json::parse(f.extra);
    j["frame"] = f.frame;
    j["file"] = f.file;
    if (!f.centre.empty()) j["centre"] = f.centre;
    if (!f.truth.empty()) j["truth"] = f.truth;
    if (f.reset) j["reset"] = true;
    j["jitter"] = offset(f.jitterPx);
    if (f.camera) {
        json& c = j["camera"];
        c["kind"] = f.camera->kind;
        c["view"] = rowMajor(f.camera->view);
        c["projection"] = rowMajor(f.camera->projection);
        c["near"] = f.camera->nearClip;
        c["far"] = f.camera->farClip;
    }
    if (!f.renderSeconds.empty()) j["render_seconds"] = f.renderSeconds;
    return j;
}

std::optional<uint32_t> objectIdIn(const std::string& name) {
    if (name.empty() || name.size() > 10 || name.find_first_not_of("0123456789") != std::string::npos) return {};
    const uint64_t id = std::stoull(name);
    return id <= UINT32_MAX ? std::optional(uint32_t(id)) : std::nullopt;
}

const FrameEntry* Manifest::find(int frame) const {
    for (const auto& f : frames)
        if (f.frame == frame) return &f;
    return nullptr;
}

Manifest parseManifest(const std::string& text, const fs::path& file) {
    const std::string name = file.string();
    FrameList frames(name);
    const json doc = parseJson(text, name, kAdvice, frames.list());
    Manifest m = parseDocument(Member(doc, "", name), frames);
    m.folder = file.parent_path();
    return m;
}

Manifest readManifest(const fs::path& shot) {
    std::error_code ignored;
    const fs::path file = fs::is_directory(shot, ignored) ? shot / "shot.json" : shot;
    return parseManifest(requiredText(file, "; expected a shot (a folder with shot.json)"), file);
}

FrameNotes readFrameNotes(const fs::path& file) {
    return parseFrameNotes(parseJson(requiredText(file), file.string(), kAdvice), file);
}

FrameNotes parseFrameNotes(const json& document, const fs::path& file) {
    const std::string name = file.string();
    const Member doc(document, "", name);
    FrameNotes notes;
    if (const auto j = doc.find("jitter")) {
        if (const auto v = j->find("sequence")) notes.jitterSequence = v->text();
        if (const auto v = j->find("start")) notes.jitterStart = v->integer(0, INT32_MAX);
        if (const auto v = j->find("period")) notes.jitterPeriod = v->integer(1, INT32_MAX);
        notes.jitterPremultiplied = isPremultiplied(*j);
    }
    const Member frames = doc["frames"];
    json unused = json::object();
    for (size_t i = 0; i < frames.arraySize(); i++) {
        const Member f = frames.item(i);
        FrameNotes::Note note;
        if (const auto v = f.find("jitter")) note.jitterPx = v->offsetPx();
        if (const auto v = f.find("camera")) note.camera = parseCamera(*v, unused);
        if (const auto v = f.find("reset")) note.reset = v->flag();
        const int number = f["frame"].integer(-kLastFrame, kLastFrame);
        if (!notes.frames.emplace(number, note).second)
            f["frame"].fail("a frame number of its own", std::to_string(number) + " for the second time");
    }
    return notes;
}

json toJsonWithoutFrames(const Manifest& m) {
    json j = m.extra;
    j["format"] = "aaresolve-shot";
    j["version"] = 1;
    j["name"] = m.name;
    j["resolution"] = {m.width, m.height};
    j["fps"] = m.fps;
    j["jitter"]["sequence"] = m.jitterSequence;
    j["jitter"]["start"] = m.jitterStart;
    j["jitter"]["period"] = m.jitterPeriod;
    if (m.jitterPremultiplied) j["jitter"]["projection"] = "premultiplied";
    j["static"] = m.isStatic;
    if (!m.subsamplePositionsPx.empty()) {
        j["subsamples"]["pattern"] = m.subsamplePattern;
        json& positions = j["subsamples"]["positions"] = json::array();
        for (const auto& p : m.subsamplePositionsPx) positions.push_back(offset(p));
    }
    if (!m.objects.empty()) {
        json& objects = j["objects"] = json::object();
        for (const auto& [id, name] : m.objects) objects[std::to_string(id)] = name;
    }
    const bool anyTruth = std::any_of(m.frames.begin(), m.frames.end(), [](const auto& f) { return !f.truth.empty(); });
    if (anyTruth || m.truthSamplesPerHalf > 0) {
        j["truth"]["samples_per_half"] = m.truthSamplesPerHalf;
        j["truth"]["filter"] = m.truthFilter;
        j["truth"]["filter_width"] = m.truthFilterWidthPx;
        if (m.truthHalves) j["truth"]["halves"] = *m.truthHalves;
    }
    return j;
}

json toJson(const Manifest& m) {
    json j = toJsonWithoutFrames(m);
    json& frames = j["frames"] = json::array();
    for (const auto& f : m.frames) frames.push_back(toJson(f));
    return j;
}

void writeManifest(const Manifest& m) {
    const fs::path file = m.folder / "shot.json";
    mayBeReplaced(file);
    writeText(file, jsonText(toJson(m)) + "\n");
}

}  // namespace aa
