#include "shot/import/import.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "image/error.h"
#include "image/io.h"
#include "shot/frame_notes.h"
#include "shot/import/folder.h"
#include "shot/import/frame.h"
#include "shot/import/pitfalls.h"
#include "shot/import/store.h"
#include "shot/writer.h"

namespace aa {
namespace fs = std::filesystem;
using nlohmann::json;

namespace {
constexpr double kRestsPx = 1e-3;  // Cycles' Vector pass is exact to 2e-4 px

std::string plural(uint64_t n, const char* what) { return std::to_string(n) + " " + what + (n == 1 ? "" : "s"); }

// What was found in one frame: kept in its record, so that an import that goes on knows it, too.
struct FrameFacts {
    std::set<uint32_t> ids;
    double motionMaxPx = 0;
    double changed = 0;  // share of the pixels, against the frame before
    EdgeCounts edges;
    ImportCounts counts;

    json toJson() const {
        return {{"ids", ids},
                {"motionMaxPx", motionMaxPx},
                {"changed", changed},
                {"edges", {edges.sharp, edges.blended}},
                {"counts", {counts.normalised, counts.noIndex, counts.idOnBackground}}};
    }
    static std::optional<FrameFacts> of(const std::optional<json>& j) {
        if (!j) return std::nullopt;
        try {
            FrameFacts f;
            f.ids = j->at("ids").get<std::set<uint32_t>>();
            f.motionMaxPx = j->at("motionMaxPx").get<double>();
            f.changed = j->at("changed").get<double>();
            f.edges = {j->at("edges").at(0).get<uint64_t>(), j->at("edges").at(1).get<uint64_t>()};
            const json& c = j->at("counts");
            f.counts = {c.at(0).get<uint64_t>(), c.at(1).get<uint64_t>(), c.at(2).get<uint64_t>()};
            return f;
        } catch (const json::exception&) {
            return std::nullopt;  // not of this program: import again
        }
    }
};

class Import {
  public:
    explicit Import(const ImportOptions& o) : o_(o) {}

    ImportReport run(const std::function<bool(int)>& goOn) {
        frames_ = renderedFrames(o_.from);
        readTruthFolders();
        if (!o_.jitter.empty()) jitter_ = readFrameNotes(o_.jitter);
        if (!o_.camera.empty()) camera_ = readFrameNotes(o_.camera);
        plan_ = planImport(frames_.begin()->second, o_, report_);
        describe();
        std::vector<std::string> kinds = {"frames"};
        if (!truths_.empty()) kinds.push_back("truth");
        store_.emplace(o_.out, settings(), kinds);
        std::optional<int> before;
        for (const auto& [number, file] : frames_) {
            addFrame(number, file, before);
            before = number;
            if (goOn && !goOn(number)) {
                report_.complete = number == frames_.rbegin()->first;
                break;
            }
        }
        judge();
        writeManifest(report_.manifest);
        return std::move(report_);
    }

  private:
    void readTruthFolders() {
        for (const auto& folder : o_.truth) truths_.push_back(renderedFrames(folder));
        if (truths_.size() > 2)
            throw UsageError("--truth: expected one or two folders, the independent halves a and b");
        if (truths_.size() == 2)
            for (const auto& [number, file] : truths_[0])
                if (frames_.contains(number) && !truths_[1].contains(number))
                    throw InputError(o_.truth[1].string() + ": has no frame " + std::to_string(number) + ", of which " +
                                     file.string() + " is the other half; render it");
        if (truths_.size() == 1)
            report_.warnings.push_back(
                "one folder of truth: without a second, independent half its noise is unknown, so "
                "no difference can be told from noise; render it again with another seed");
    }
    const FrameNotes::Note* noteOf(const std::optional<FrameNotes>& notes, int frame) const {
        if (!notes) return nullptr;
        const auto it = notes->frames.find(frame);
        return it == notes->frames.end() ? nullptr : &it->second;
    }
    std::optional<Camera> cameraOf(int frame) const {
        const auto* note = noteOf(camera_, frame);
        return note ? note->camera : std::nullopt;
    }

    // Everything in the manifest but the frames, and what the first file's header warns of.
    void describe() {
        Manifest& m = report_.manifest;
        m.name = o_.name.empty() ? fs::weakly_canonical(o_.from).filename().string() : o_.name;
        m.width = plan_.width;
        m.height = plan_.height;
        m.fps = o_.fps;
        m.folder = o_.out;
        if (jitter_) {
            m.jitterSequence = jitter_->jitterSequence;
            m.jitterStart = jitter_->jitterStart;
            m.jitterPeriod = jitter_->jitterPeriod;
            m.jitterPremultiplied = jitter_->jitterPremultiplied;
        }
        BlenderExr first(frames_.begin()->second);
        first.choose(plan_.layer, plan_.view);
        m.extra["producer"] = {{"name", "aaresolve import"}, {"version", AA_VERSION}};
        if (const auto v = first.text("Software")) m.extra["producer"]["source"] = *v;
        report_.passes = plan_.passes();
        for (auto& w : headerPitfalls(first)) report_.warnings.push_back(std::move(w));
        if (plan_.ids == IdSource::cryptomatte) names_ = cryptomatteNames(first, report_.notes);
        if (!truths_.empty()) {
            m.truthFilter = o_.truthFilter;
            m.truthFilterWidthPx = o_.truthFilterWidthPx;
            m.truthHalves = int(truths_.size());
            BlenderExr truth(truths_[0].begin()->second);
            for (const auto& layer : truth.layers())
                if (const auto samples = truth.text("cycles." + layer + ".samples"))
                    m.truthSamplesPerHalf = std::max(m.truthSamplesPerHalf, std::atoi(samples->c_str()));
        }
    }

    json settings() const {
        json s = {{"from", fs::weakly_canonical(o_.from).string()},
                  {"layer", plan_.layer},
                  {"view", plan_.view},
                  {"passes", names(plan_.passes())},
                  {"ids", plan_.ids == IdSource::cryptomatte ? "cryptomatte" : "index"},
                  {"truth", json::array()}};
        for (const auto& t : o_.truth) s["truth"].push_back(fs::weakly_canonical(t).string());
        return s;
    }

    FrameEntry entryOf(int number, std::optional<int> before) const {
        FrameEntry e;
        e.frame = number;
        e.file = ImportStore::picture("frames", number);
        if (jitter_) {
            const auto* note = noteOf(jitter_, number);
            if (!note || !note->jitterPx)
                throw InputError(o_.jitter.string() + ": has no jitter of frame " + std::to_string(number) +
                                 "; list every frame that was rendered");
            e.jitterPx = *note->jitterPx;
        }
        e.camera = cameraOf(number);
        if (camera_ && !e.camera)
            throw InputError(o_.camera.string() + ": has no camera of frame " + std::to_string(number) +
                             "; list every frame that was rendered");
        const auto* note = noteOf(camera_, number);
        e.reset = !before || *before + 1 != number || (note && note->reset);
        return e;
    }

    void addFrame(int number, const fs::path& source, std::optional<int> before) {
        const FrameEntry entry = entryOf(number, before);
        Manifest notes;
        notes.frames = {entry};
        const json inputs = {{"source", fileIdentity(source)},
                             {"notes", toJson(notes)["frames"]},
                             {"previousCamera", cameraOf(number - 1) ? toJson(*cameraOf(number - 1)) : json()}};
        std::optional<FrameFacts> facts = FrameFacts::of(store_->finished("frames", number, inputs));
        if (facts) {
            report_.kept++;
        } else {
            facts = convert(source, entry, before);
            store_->finish("frames", number, inputs, facts->toJson());
            report_.imported++;
        }
        if (o_.isStatic && facts->motionMaxPx > kRestsPx)
            throw InputError(source.string() + ": frame " + std::to_string(number) +
                             " holds motion, but --static says that nothing moves; leave --static out");
        facts_.push_back(*facts);
        report_.manifest.frames.push_back(entry);
        report_.manifest.frames.back().truth = addTruth(number);
    }
    static json toJson(const Camera& c) {
        json j = json::array({c.kind, c.nearClip, c.farClip});
        for (int i = 0; i < 4; i++)
            for (int k = 0; k < 4; k++) j.push_back(c.view[i][k]), j.push_back(c.projection[i][k]);
        return j;
    }
    static json toJson(const Manifest& m) { return aa::toJson(m); }

    FrameFacts convert(const fs::path& source, const FrameEntry& entry, std::optional<int> before) {
        FrameFacts facts;
        const bool follows = !entry.reset && before;
        Frame frame = importFrame(source, plan_, entry, follows ? cameraOf(*before) : std::nullopt, facts.counts);
        if (before) {  // what the frame before showed: still here, or from its file
            if (!previous_ || previous_->number != *before) {
                ImportCounts again;
                FrameEntry other;
                other.frame = *before;
                previous_ = importFrame(frames_.at(*before), plan_, other, std::nullopt, again);
            }
            facts.changed = changedShare(*previous_, frame);
        }
        facts.edges = countEdges(frame.colorLinear);
        for (int y = 0; y < frame.height; y++)
            for (int x = 0; x < frame.width; x++) {
                if (!frame.objectId.empty() && frame.objectId.at(x, y)) facts.ids.insert(frame.objectId.at(x, y));
                if (frame.motionXPx.empty()) continue;
                const double length = std::hypot(frame.motionXPx.at(x, y), frame.motionYPx.at(x, y));
                if (length < kInvalidMotionPx) facts.motionMaxPx = std::max(facts.motionMaxPx, length);
            }
        writeFrame(o_.out / entry.file, frame, /*motionPart=*/true);
        previous_ = std::move(frame);
        return facts;
    }

    // Relative path of the frame's truth; empty when no folder has it.
    std::string addTruth(int number) {
        if (truths_.empty() || !truths_[0].contains(number)) return {};
        json inputs = json::array();
        for (const auto& folder : truths_) inputs.push_back(fileIdentity(folder.at(number)));
        const std::string file = ImportStore::picture("truth", number);
        if (store_->finished("truth", number, inputs)) return file;
        Truth truth{readTruth(truths_[0].at(number)), {}};
        truth.b = truths_.size() == 2 ? readTruth(truths_[1].at(number)) : truth.a;
        if (truths_.size() == 2 && truth.a.samePixels(truth.b))
            throw InputError(truths_[1].at(number).string() + ": is the same picture as " +
                             truths_[0].at(number).string() + "; render the second half with another seed");
        writeTruth(o_.out / file, truth);
        store_->finish("truth", number, inputs, json::object());
        return file;
    }
    Rgb readTruth(const fs::path& path) const {
        BlenderExr file(path);
        Rgb rgb;
        if (file.isPlain()) {
            file.wantPlain(rgb);
        } else {
            const auto layers = file.layers();
            const bool known = std::find(layers.begin(), layers.end(), plan_.layer) != layers.end();
            file.choose(known ? plan_.layer : "", plan_.view);
            file.want(BlenderPass::combined, {&rgb.c[0], &rgb.c[1], &rgb.c[2]});
        }
        file.read();
        if (rgb.width() != plan_.width || rgb.height() != plan_.height)
            throw InputError(path.string() + ": expected " + std::to_string(plan_.width) + "x" +
                             std::to_string(plan_.height) + " pixels as in the frames, found " +
                             std::to_string(rgb.width()) + "x" + std::to_string(rgb.height()) +
                             "; render the truth again");
        for (const auto& c : {file.file().parts()[0].compression})
            if (c.starts_with("dwa") || c.starts_with("b44"))
                throw InputError(path.string() + ": " + c +
                                 " compression loses digits, and every figure rests on the "
                                 "truth; render it with ZIP");
        return rgb;
    }

    // What only all frames together tell.
    void judge() {
        Manifest& m = report_.manifest;
        double motionMax = 0, changed = 0;
        EdgeCounts edges;
        ImportCounts counts;
        std::set<uint32_t> ids;
        for (const FrameFacts& f : facts_) {
            motionMax = std::max(motionMax, f.motionMaxPx);
            changed = std::max(changed, f.changed);
            edges += f.edges;
            ids.insert(f.ids.begin(), f.ids.end());
            counts.normalised += f.counts.normalised;
            counts.noIndex += f.counts.noIndex;
            counts.idOnBackground += f.counts.idOnBackground;
        }
        const double mostChanged = jitter_ ? kChangedShareJittered : kChangedShare;
        const bool rests = motionMax <= kRestsPx && changed <= mostChanged;
        m.isStatic = o_.isStatic || rests;
        if (m.isStatic) shareTruth(m);
        nameObjects(ids);
        auto& notes = report_.notes;
        auto& warnings = report_.warnings;
        if (m.isStatic && !plan_.vector) {
            report_.passes |= Pass::motion;
            std::erase_if(report_.missing, [](const auto& x) { return x.pass == Pass::motion; });
        }
        if (m.isStatic && facts_.size() > 1)
            notes.push_back(o_.isStatic ? "static, as --static says" : "nothing moves: the shot is static");
        if (counts.normalised)
            notes.push_back(plural(counts.normalised, "normal") +
                            " not of unit length (means over several surfaces): normalised");
        if (counts.noIndex)
            notes.push_back(plural(counts.noIndex, "pixel") + " of objects whose pass index is 0: they share the id " +
                            std::to_string(kNoPassIndex));
        if (counts.idOnBackground) notes.push_back(plural(counts.idOnBackground, "id") + " on background: set to 0");
        if (edges.isAntiAliased())
            warnings.push_back(
                std::to_string(100 * edges.blended / (edges.sharp + edges.blended)) +
                " % of the edge pixels lie between their two sides: the picture is anti-aliased already, "
                "and no method can be judged on it; render with 1 sample per pixel");
        if (plan_.vector && motionMax == 0 && changed > mostChanged && !o_.isStatic)
            warnings.push_back(
                "every motion vector is 0 although the pictures change: motion blur was on (Vector is empty "
                "then), or only noise or the light changes (then pass --static); switch it off and render again");
        if (plan_.vector && !camera_ && motionMax > kRestsPx)
            notes.push_back(
                "without --camera: motion of the background is 0, and a change of lens is not in the vectors");
        if (!camera_) notes.push_back("without --camera: depth cannot be checked against its range");
        size_t withTruth = 0;
        for (const auto& f : m.frames) withTruth += !f.truth.empty();
        if (!truths_.empty() && withTruth < m.frames.size())
            notes.push_back("truth for " + std::to_string(withTruth) + " of " + plural(m.frames.size(), "frame"));
    }
    // A static shot has one truth for all its frames.
    static void shareTruth(Manifest& m) {
        const auto first =
            std::find_if(m.frames.begin(), m.frames.end(), [](const auto& f) { return !f.truth.empty(); });
        if (first == m.frames.end()) return;
        const std::string file = first->truth;
        for (auto& f : m.frames) f.truth = file;
    }
    void nameObjects(const std::set<uint32_t>& ids) {
        for (const uint32_t id : ids) {
            const auto known = names_.find(id);
            report_.manifest.objects[id] = known != names_.end()          ? known->second
                                           : id == kNoPassIndex           ? "objects without a pass index"
                                           : plan_.ids == IdSource::index ? "pass index " + std::to_string(id)
                                                                          : "cryptomatte " + std::to_string(id);
        }
    }

    const ImportOptions& o_;
    std::optional<ImportStore> store_;
    ImportReport report_;
    ImportPlan plan_;
    std::map<int, fs::path> frames_;
    std::vector<std::map<int, fs::path>> truths_;
    std::optional<FrameNotes> jitter_, camera_;
    std::map<uint32_t, std::string> names_;
    std::vector<FrameFacts> facts_;
    std::optional<Frame> previous_;
};
}  // namespace

ImportReport importBlender(const ImportOptions& options, const std::function<bool(int)>& goOn) {
    return Import(options).run(goOn);
}

}  // namespace aa
