#include "shot/import/engine.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/matrix.hpp>
#include <set>

#include "image/error.h"
#include "image/exr.h"
#include "image/readable.h"
#include "shot/import/store.h"
#include "shot/pass_table.h"
#include "shot/writer.h"

namespace aa {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

// Files of a pattern, by the number that stands for {frame}.
std::map<int, fs::path> filesOf(const fs::path& from, const std::string& pattern) {
    const fs::path folder = from / fs::path(pattern).parent_path();
    const std::string name = fs::path(pattern).filename().string();
    const size_t at = name.find("{frame}");
    const std::string before = name.substr(0, at), after = name.substr(at + 7);
    std::error_code failed;
    requireFolder(folder, "; the layout names it");
    std::map<int, fs::path> files;
    for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed)) {
        const std::string file = it->path().filename().string();
        if (file.size() <= before.size() + after.size() || !file.starts_with(before) || !file.ends_with(after))
            continue;
        const std::string_view digits =
            std::string_view(file).substr(before.size(), file.size() - before.size() - after.size());
        int number = 0;
        const auto [last, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
        if (error != std::errc{} || last != digits.data() + digits.size() || std::abs(number) > kLastFrame) continue;
        const auto [other, isNew] = files.emplace(number, it->path());
        if (!isNew)
            throw InputError(folder.string() + ": both " + other->second.filename().string() + " and " + file +
                             " are frame " + std::to_string(number) + "; keep one of them");
    }
    if (failed)
        throw InputError(folder.string() + ": cannot be read (" + failed.message() + "); check its permissions");
    if (files.empty()) throw InputError(folder.string() + ": no file is named " + name + " with a number for {frame}");
    return files;
}

class EngineImport {
  public:
    explicit EngineImport(const EngineImportOptions& o) : o_(o) {}

    ImportReport run(const std::function<bool(int)>& goOn) {
        frames_ = filesOf(o_.from, colourFilesOf(o_.layout));
        const ExrFile first(frames_.begin()->second, kAdvice);
        width_ = first.parts()[0].shown.width, height_ = first.parts()[0].shown.height;
        layout_ = readEngineLayout(o_.layout, width_, height_);
        describe();
        std::vector<std::string> kinds = {"frames"};
        if (layout_.centre) kinds.push_back("centre");
        if (!layout_.truth.empty()) kinds.push_back("truth");
        store_.emplace(o_.out, settings(), kinds);
        std::optional<int> before;
        size_t index = 0;
        for (const auto& frame : frames_) {
            const int number = frame.first;
            addFrame(number, index++, before);
            before = number;
            if (goOn && !goOn(number)) {
                report_.complete = number == frames_.rbegin()->first;
                break;
            }
        }
        if (layout_.isStatic) shareTruth();
        writeManifest(report_.manifest);
        return std::move(report_);
    }

  private:
    static constexpr const char* kAdvice = "write the frame again";

    static PassSet offeredBy(const EnginePasses& p) {
        PassSet set;
        for (const auto& source : p.sources) set |= source.first;
        return set;
    }
    void describe() {
        Manifest& m = report_.manifest;
        m.name = o_.name.empty() ? layout_.name : o_.name;
        m.width = width_, m.height = height_, m.fps = layout_.fps;
        m.folder = o_.out;
        m.isStatic = layout_.isStatic;
        m.extra["producer"] = {{"name", "aaresolve import"}, {"version", AA_VERSION}};
        const bool noted = layout_.notes && std::any_of(layout_.notes->frames.begin(), layout_.notes->frames.end(),
                                                        [](auto& n) { return n.second.jitterPx.has_value(); });
        m.jitterSequence = noted ? "file" : layout_.jitterSequence;
        m.jitterPeriod = layout_.jitterPx.empty() ? 1 : int(layout_.jitterPx.size());
        if (!layout_.truth.empty()) {
            m.truthFilter = layout_.truthFilter;
            m.truthFilterWidthPx = layout_.truthFilterWidthPx;
            m.truthSamplesPerHalf = layout_.truthSamplesPerHalf;
            m.truthHalves = int(layout_.truth.size());
            if (layout_.truth.size() == 1)
                report_.warnings.push_back(
                    "one half of truth: without a second, independent one its noise is unknown, so no difference can "
                    "be "
                    "told from noise");
        }
        report_.passes = offeredBy(layout_.passes);
        if (layout_.isStatic) report_.passes |= Pass::motion;
        for (const PassInfo& info : allPasses())
            if (!report_.passes.has(info.pass))
                report_.missing.push_back(
                    {info.pass, info.isList || info.perSubSample || info.pass == Pass::edges
                                    ? "a layout has no place for it; write a shot (docs/format.md)"
                                    : "name it in the layout's passes"});
        if (!layout_.centre && (noted || !layout_.jitterPx.empty()))
            report_.notes.push_back(
                "no `centre`: methods that keep no history are judged on jittered frames, which lie beside the truth "
                "by "
                "up to half a pixel");
    }
    json settings() const { return {{"from", fs::weakly_canonical(o_.from).string()}, {"engine", true}}; }
    const FrameNotes::Note* noteOf(int frame) const {
        if (!layout_.notes) return nullptr;
        const auto it = layout_.notes->frames.find(frame);
        return it == layout_.notes->frames.end() ? nullptr : &it->second;
    }
    FrameEntry entryOf(int number, size_t index, std::optional<int> before) {
        FrameEntry e;
        e.frame = number;
        e.file = ImportStore::picture("frames", number);
        if (layout_.centre) e.centre = ImportStore::picture("centre", centreOf(number));
        const auto* note = noteOf(number);
        if (!layout_.jitterPx.empty()) e.jitterPx = layout_.jitterPx[index % layout_.jitterPx.size()];
        if (note && note->jitterPx) e.jitterPx = *note->jitterPx;
        if (note) e.camera = note->camera;
        e.reset = !before || *before + 1 != number || (note && note->reset);
        return e;
    }
    // A static shot may have one picture at the pixel centres for all frames: that of the first.
    int centreOf(int number) { return layout_.isStatic ? frames_.begin()->first : number; }
    // A file of the pattern for this frame; the folder is listed once.
    const fs::path& fileOf(const std::string& pattern, int number) {
        auto known = files_.find(pattern);
        if (known == files_.end()) known = files_.emplace(pattern, filesOf(o_.from, pattern)).first;
        const auto it = known->second.find(number);
        if (it == known->second.end())
            throw InputError((o_.from / pattern).string() + ": no file of frame " + std::to_string(number) +
                             ", which the colour has; write it, too");
        return it->second;
    }
    json identities(const EnginePasses& p, int number) {
        json j = json::object();
        for (const auto& [pass, source] : p.sources)
            j[std::string(name(pass))] = fileIdentity(fileOf(source.files, number));
        return j;
    }

    void addFrame(int number, size_t index, std::optional<int> before) {
        FrameEntry entry = entryOf(number, index, before);
        Manifest notes;
        notes.frames = {entry};
        // The layout's text decides every pixel, too.
        json inputs = {{"sources", identities(layout_.passes, number)},
                       {"layout", layout_.reads},
                       {"notes", toJson(notes)["frames"]}};
        if (before) inputs["before"] = {previousJitter_.x, previousJitter_.y};
        if (layout_.centre) inputs["centre"] = identities(*layout_.centre, centreOf(number));
        if (store_->finished("frames", number, inputs)) {
            report_.kept++;
        } else {
            if (layout_.centre) {
                FrameEntry centre = entry;
                centre.jitterPx = glm::dvec2(0.0);
                writeFrame(o_.out / entry.centre, convert(*layout_.centre, centreOf(number), centre), true);
            }
            writeFrame(o_.out / entry.file, convert(layout_.passes, number, entry), true);
            store_->finish("frames", number, inputs, json::object());
            report_.imported++;
        }
        entry.truth = addTruth(number);
        previousJitter_ = entry.jitterPx;
        report_.manifest.frames.push_back(std::move(entry));
    }
    // The channels of a source.
    void read(const EngineSource& source, int number, const std::vector<PlaneRef>& planes) {
        ExrFile file(fileOf(source.files, number), kAdvice);
        const auto has = [&](const ExrPart& part) {
            return std::all_of(source.channels.begin(), source.channels.end(), [&](auto& c) { return part.find(c); });
        };
        const ExrPart* part = nullptr;
        for (const ExrPart& p : file.parts())
            if (!part && (source.part.empty() ? has(p) : p.name == source.part)) part = &p;
        if (!part) {
            std::string all;
            for (const ExrPart& p : file.parts())
                for (const ExrChannel& c : p.channels)
                    all += (all.empty() ? "" : ", ") + (p.name.empty() ? "" : p.name + "/") + c.name;
            std::string wanted;
            for (const auto& c : source.channels) wanted += (wanted.empty() ? "" : ", ") + c;
            throw InputError(file.path().string() + ": expected " +
                             (source.part.empty() ? "" : "a part '" + source.part + "' with ") + "channels " + wanted +
                             " (the layout's), found " + all);
        }
        requireWhole(*part, file.path().string() + ": frame " + std::to_string(number),
                     "write whole frames, without a region, a crop or overscan");
        if (part->width != width_ || part->height != height_)
            throw InputError(file.path().string() + ": expected " + std::to_string(width_) + "x" +
                             std::to_string(height_) + " pixels as in the first frame's colour, found " +
                             std::to_string(part->width) + "x" + std::to_string(part->height) + "; " + kAdvice);
        std::vector<ChannelTarget> targets;
        for (size_t i = 0; i < planes.size(); i++) targets.push_back({source.channels[i], planes[i]});
        file.read(*part, targets);
    }

    Frame convert(const EnginePasses& passes, int number, const FrameEntry& entry) {
        Frame f;
        f.number = number;
        f.width = width_, f.height = height_;
        f.passes = offeredBy(passes);
        f.jitterPx = entry.jitterPx;
        f.camera = entry.camera;
        for (const PassInfo& info : allPasses())
            if (const auto source = passes.sources.find(info.pass); source != passes.sources.end())
                read(source->second, number, info.groups[0].ofFrame(f));
        if (f.passes.has(Pass::depth)) toPlanarDepth(f, passes);
        if (f.passes.has(Pass::normal)) toWorldNormals(f, passes);
        if (f.passes.has(Pass::motion)) toShotMotion(f, passes, entry);
        return f;
    }
    [[noreturn]] void fail(int number, const std::string& what) const {
        throw InputError(o_.layout.string() + ": frame " + std::to_string(number) + ": " + what);
    }
    void toPlanarDepth(Frame& f, const EnginePasses& p) const {
        const double n = p.nearPlane, far = p.farPlane;
        if (p.depthKind == DepthKind::distance && (!f.camera || f.camera->kind != "perspective"))
            fail(f.number, "depth along the ray needs the frame's perspective camera; state it in `frames`");
        for (int y = 0; y < f.height; y++)
            for (int x = 0; x < f.width; x++) {
                const double d = f.depthView.at(x, y);
                double z = d * p.depthScale;
                if (p.depthKind == DepthKind::device || p.depthKind == DepthKind::reversed) {
                    const double atFar = p.depthKind == DepthKind::device ? 1 - d : d;  // 0 at the far plane
                    z = !(atFar > 0) ? double(kBackgroundDepth)
                        : far > 0    ? n * far / (n + atFar * (far - n))
                                     : n / atFar;
                } else if (d >= p.background.value_or(double(kBackgroundFrom))) {
                    z = double(kBackgroundDepth);
                } else if (p.depthKind == DepthKind::distance) {
                    // The ray through the sample, in view space at depth 1.
                    const glm::dmat4& m = f.camera->projection;
                    const double ndcX = 2 * (x + 0.5 + f.jitterPx.x) / f.width - 1,
                                 ndcY = 1 - 2 * (y + 0.5 + f.jitterPx.y) / f.height;
                    const double rx = (ndcX + m[2][0]) / m[0][0], ry = (ndcY + m[2][1]) / m[1][1];
                    z /= std::sqrt(1 + rx * rx + ry * ry);
                }
                f.depthView.at(x, y) = z >= double(kBackgroundFrom) ? kBackgroundDepth : float(z);
            }
    }
    void toWorldNormals(Frame& f, const EnginePasses& p) const {
        if (p.normalSpace == NormalSpace::view && !f.camera)
            fail(f.number, "normals in view space need the frame's camera; state it in `frames`");
        const glm::dmat3 toWorld =
            p.normalSpace == NormalSpace::view ? glm::transpose(glm::dmat3(f.camera->view)) : glm::dmat3(1.0);
        for (int y = 0; y < f.height; y++)
            for (int x = 0; x < f.width; x++) {
                glm::dvec3 v(f.normalWorld.c[0].at(x, y), f.normalWorld.c[1].at(x, y), f.normalWorld.c[2].at(x, y));
                if (p.normalUnsigned) v = 2.0 * v - 1.0;
                const bool isBackground = f.passes.has(Pass::depth) && f.depthView.at(x, y) >= kBackgroundFrom;
                const double length = glm::length(v);
                v = isBackground || !(length > 1e-3) ? glm::dvec3(0.0) : toWorld * (v / length);
                for (int c = 0; c < 3; c++) f.normalWorld.c[size_t(c)].at(x, y) = float(v[c]);
            }
    }
    void toShotMotion(Frame& f, const EnginePasses& p, const FrameEntry& entry) const {
        glm::dvec2 scale(1.0);
        if (p.motionUnit != MotionUnit::px)
            scale = glm::dvec2(f.width, f.height) * (p.motionUnit == MotionUnit::ndc ? 0.5 : 1.0);
        if (p.motionYUp) scale.y = -scale.y;
        if (p.motionFromNow) scale = -scale;
        // Jittered geometry lies at its place less the jitter.
        const glm::dvec2 shift = p.motionJittered && !entry.reset ? entry.jitterPx - previousJitter_ : glm::dvec2(0.0);
        for (int y = 0; y < f.height; y++)
            for (int x = 0; x < f.width; x++) {
                f.motionXPx.at(x, y) = float(double(f.motionXPx.at(x, y)) * scale.x + shift.x);
                f.motionYPx.at(x, y) = float(double(f.motionYPx.at(x, y)) * scale.y + shift.y);
            }
    }
    // A static shot has one truth for all its frames.
    void shareTruth() {
        auto& frames = report_.manifest.frames;
        const auto first = std::find_if(frames.begin(), frames.end(), [](const auto& f) { return !f.truth.empty(); });
        if (first == frames.end()) return;
        const std::string file = first->truth;
        for (auto& f : frames) f.truth = file;
    }
    std::string addTruth(int number) {
        if (layout_.truth.empty()) return {};
        const auto has = [&](const EngineSource& s) {
            auto known = files_.find(s.files);
            if (known == files_.end()) known = files_.emplace(s.files, filesOf(o_.from, s.files)).first;
            return known->second.contains(number);
        };
        if (!has(layout_.truth[0])) return {};
        json inputs = {{"layout", layout_.reads}};
        for (const EngineSource& s : layout_.truth) inputs["halves"].push_back(fileIdentity(fileOf(s.files, number)));
        const std::string file = ImportStore::picture("truth", number);
        if (store_->finished("truth", number, inputs)) return file;
        Truth truth;
        const auto planes = [](Rgb& c) { return std::vector<PlaneRef>{&c.c[0], &c.c[1], &c.c[2]}; };
        read(layout_.truth[0], number, planes(truth.a));
        if (layout_.truth.size() == 2)
            read(layout_.truth[1], number, planes(truth.b));
        else
            truth.b = truth.a;
        if (layout_.truth.size() == 2 && truth.a.samePixels(truth.b))
            throw InputError(fileOf(layout_.truth[1].files, number).string() + ": is the same picture as " +
                             fileOf(layout_.truth[0].files, number).string() +
                             "; render the second half with another seed");
        writeTruth(o_.out / file, truth);
        store_->finish("truth", number, inputs, json::object());
        return file;
    }

    const EngineImportOptions& o_;
    EngineLayout layout_;
    std::optional<ImportStore> store_;
    ImportReport report_;
    std::map<int, fs::path> frames_;
    std::map<std::string, std::map<int, fs::path>> files_;
    glm::dvec2 previousJitter_{0.0};
    int width_ = 0, height_ = 0;
};
}  // namespace

ImportReport importEngine(const EngineImportOptions& options, const std::function<bool(int)>& goOn) {
    return EngineImport(options).run(goOn);
}
size_t engineFrames(const EngineImportOptions& o) { return filesOf(o.from, colourFilesOf(o.layout)).size(); }

}  // namespace aa
