#include "shot/reader.h"

#include "image/error.h"
#include "image/exr.h"
#include "shot/sanitise.h"
#include "shot/segments.h"

namespace aa {
namespace {

// Decodes one frame's file into a Frame, pass by pass.
class FrameDecoder {
  public:
    FrameDecoder(const Manifest& manifest, const FrameEntry& entry, const std::string& file, InputPolicy policy,
                 Frame& frame, SanitiseCounts& counts)
        : manifest_(manifest),
          entry_(entry),
          policy_(policy),
          file_(manifest.folder / file),
          frame_(frame),
          counts_(counts) {}

    void decode(PassSet wanted) {
        if (wanted.has(Pass::color)) colour("color", {"R", "G", "B"}, frame_.colorLinear);
        if (wanted.has(Pass::albedo)) colour("albedo", {"albedo.R", "albedo.G", "albedo.B"}, frame_.albedoLinear);
        if (wanted.has(Pass::depth)) depth();
        if (wanted.has(Pass::normal)) normal();
        if (wanted.has(Pass::object)) objectIds();
        if (wanted.has(Pass::motion)) motion();
        if (wanted.has(Pass::subsamples) || wanted.has(Pass::subsampleColor)) subSamples(wanted);
        if (wanted.has(Pass::edges)) edges();
        if (wanted.has(Pass::segments)) segments();
    }

  private:
    const ExrPart& part(const char* name) {
        const ExrPart* p = file_.find(name);
        if (!p) throw InputError(where() + " has no part '" + name + "'; export the shot again with this pass");
        if (p->width != manifest_.width || p->height != manifest_.height)
            throw InputError(where() + ", part '" + name + "': expected " + size(manifest_.width, manifest_.height) +
                             " pixels (shot.json), found " + size(p->width, p->height) + "; export the frame again");
        return *p;
    }
    static std::string size(int w, int h) { return std::to_string(w) + "x" + std::to_string(h); }
    std::string where() const { return file_.path().string() + ": frame " + std::to_string(entry_.frame); }
    PlaneName planeName(const char* part, std::vector<std::string> channels) const {
        return {where() + ", part '" + part + "'", std::move(channels)};
    }

    void colour(const char* partName, const std::vector<std::string>& channels, Rgb& to) {
        std::vector<ChannelTarget> t = {{channels[0], &to.c[0]}, {channels[1], &to.c[1]}, {channels[2], &to.c[2]}};
        file_.read(part(partName), t);
        finishColour(partName, t, to);
    }
    void finishColour(const char* partName, std::span<const ChannelTarget> t, Rgb& colour) {
        sanitiseColour(colour, t[0].stored == ChannelType::half, policy_,
                       planeName(partName, {t[0].channel, t[1].channel, t[2].channel}), counts_);
        colour.fillBorder();
    }
    void finishDepth(const char* partName, const std::string& channel, PlaneF& plane) {
        sanitiseDepth(plane, policy_, planeName(partName, {channel}), counts_);
        plane.fillBorder();
    }
    void finishNormal(const char* partName, std::span<const ChannelTarget> t, Rgb& normals) {
        sanitiseNormal(normals, policy_, planeName(partName, {t[0].channel, t[1].channel, t[2].channel}), counts_);
        normals.fillBorder();
    }
    void depth() {
        std::vector<ChannelTarget> t = {{"Z", &frame_.depthView}};
        file_.read(part("depth"), t);
        finishDepth("depth", "Z", frame_.depthView);
    }
    void normal() {
        Rgb& n = frame_.normalWorld;
        std::vector<ChannelTarget> t = {{"N.X", &n.c[0]}, {"N.Y", &n.c[1]}, {"N.Z", &n.c[2]}};
        file_.read(part("normal"), t);
        finishNormal("normal", t, n);
    }
    void objectIds() {
        std::vector<ChannelTarget> t = {{"id", &frame_.objectId}};
        file_.read(part("object"), t);
        frame_.objectId.fillBorder();
    }
    void motion() {
        if (manifest_.isStatic && !file_.find("motion")) {
            frame_.motionXPx = PlaneF(manifest_.width, manifest_.height);
            frame_.motionYPx = PlaneF(manifest_.width, manifest_.height);
            return;
        }
        std::vector<ChannelTarget> t = {{"motion.X", &frame_.motionXPx}, {"motion.Y", &frame_.motionYPx}};
        file_.read(part("motion"), t);
        sanitiseMotion(frame_.motionXPx, frame_.motionYPx, policy_, planeName("motion", {"motion.X", "motion.Y"}),
                       counts_);
        frame_.motionXPx.fillBorder();
        frame_.motionYPx.fillBorder();
    }
    void edges() {
        std::vector<ChannelTarget> t = {{"edge.X", &frame_.edgeXPx}, {"edge.Y", &frame_.edgeYPx}};
        file_.read(part("edges"), t);
        sanitiseEdges(frame_.edgeXPx, frame_.edgeYPx, policy_, planeName("edges", {"edge.X", "edge.Y"}), counts_);
        frame_.edgeXPx.fillBorder();
        frame_.edgeYPx.fillBorder();
    }
    // A list: its part has a size of its own.
    void segments() {
        const ExrPart* list = file_.find("segments");
        if (!list) throw InputError(where() + " has no part 'segments'; export the shot again with this pass");
        const PlaneName name = planeName("segments", {kSegmentChannels.begin(), kSegmentChannels.end()});
        if (list->width > kSegmentsPerRow || (list->height > 1 && list->width != kSegmentsPerRow))
            throw InputError(name.where + ": expected a list of one row of at most " + std::to_string(kSegmentsPerRow) +
                             " segments, or of rows of " + std::to_string(kSegmentsPerRow) + ", found " +
                             size(list->width, list->height) + "; export the frame again");
        SegmentPlanes planes;
        std::vector<ChannelTarget> t;
        for (size_t c = 0; c < planes.size(); c++) t.push_back({name.channels[c], &planes[c]});
        file_.read(*list, t);
        frame_.segments = unpackSegments(planes, policy_, name, counts_);
    }
    // One read for all sub-samples: the part's channels share their compressed blocks.
    void subSamples(PassSet wanted) {
        const bool geometry = wanted.has(Pass::subsamples), colours = wanted.has(Pass::subsampleColor);
        const size_t count = manifest_.subsamplePositionsPx.size();
        if (count == 0)
            throw InputError((manifest_.folder / "shot.json").string() +
                             ": subsamples.positions: expected the positions of the sub-samples, found none; export "
                             "the shot again with sub-samples");
        frame_.subSamplePositionsPx = manifest_.subsamplePositionsPx;
        frame_.subSamples.resize(count);
        std::vector<ChannelTarget> t;
        if (geometry) t.push_back({"mask", &frame_.subSampleMask});
        for (size_t k = 0; k < count; k++) {
            SubSample& s = frame_.subSamples[k];
            if (geometry) {
                t.push_back({subSampleChannel(k, "Z"), &s.depthView});
                t.push_back({subSampleChannel(k, "N.X"), &s.normalWorld.c[0]});
                t.push_back({subSampleChannel(k, "N.Y"), &s.normalWorld.c[1]});
                t.push_back({subSampleChannel(k, "N.Z"), &s.normalWorld.c[2]});
                t.push_back({subSampleChannel(k, "id"), &s.objectId});
            }
            if (colours)
                for (size_t c = 0; c < 3; c++)
                    t.push_back({subSampleChannel(k, std::string_view("RGB").substr(c, 1)), &s.colorLinear.c[c]});
        }
        file_.read(part("subsamples"), t);
        frame_.subSampleMask.fillBorder();
        std::span<const ChannelTarget> rest(t);
        if (geometry) rest = rest.subspan(1);
        for (SubSample& s : frame_.subSamples) {
            if (geometry) {
                finishDepth("subsamples", rest[0].channel, s.depthView);
                finishNormal("subsamples", rest.subspan(1, 3), s.normalWorld);
                s.objectId.fillBorder();
                rest = rest.subspan(5);
            }
            if (colours) {
                finishColour("subsamples", rest.first(3), s.colorLinear);
                rest = rest.subspan(3);
            }
        }
    }

    const Manifest& manifest_;
    const FrameEntry& entry_;
    InputPolicy policy_;
    ExrFile file_;
    Frame& frame_;
    SanitiseCounts& counts_;
};

}  // namespace

ShotReader::ShotReader(const std::filesystem::path& shot, InputPolicy policy)
    : manifest_(readManifest(shot)), policy_(policy) {}

PassSet ShotReader::offered(Sampling sampling) const {
    const FrameEntry& first = manifest_.frames.at(0);
    const ExrFile file(manifest_.folder / (sampling == Sampling::centre ? first.centre : first.file));
    PassSet r;
    for (const auto& info : allPasses()) {
        const ExrPart* part = file.find(info.part);
        if (!part) continue;
        if (info.pass == Pass::subsamples && !part->find("s00.Z")) continue;
        if (info.pass == Pass::subsampleColor && !part->find("s00.R")) continue;
        r |= info.pass;
    }
    if (manifest_.isStatic) r |= Pass::motion;
    return r;
}

Frame ShotReader::decode(size_t index, PassSet wanted, Sampling sampling, SanitiseCounts* counts) const {
    const FrameEntry& entry = manifest_.frames.at(index);
    const bool centre = sampling == Sampling::centre;
    Frame f;
    f.number = entry.frame;
    f.width = manifest_.width;
    f.height = manifest_.height;
    f.reset = entry.reset;
    if (!centre) f.jitterPx = entry.jitterPx;
    f.camera = entry.camera;
    if (index > 0 && !entry.reset) f.previousCamera = manifest_.frames[index - 1].camera;
    f.passes = wanted;
    SanitiseCounts own;
    FrameDecoder(manifest_, entry, centre ? entry.centre : entry.file, policy_, f, own).decode(wanted);
    if (counts) *counts += own;
    return f;
}

Frame ShotReader::read(size_t index, PassSet wanted, SanitiseCounts* counts) const {
    return decode(index, wanted, Sampling::jittered, counts);
}

Frame ShotReader::readCentre(size_t index, PassSet wanted, SanitiseCounts* counts) const {
    return decode(index, wanted, Sampling::centre, counts);
}

std::optional<Truth> ShotReader::readTruth(size_t index) const {
    const FrameEntry& entry = manifest_.frames.at(index);
    if (entry.truth.empty()) return std::nullopt;
    ExrFile file(manifest_.folder / entry.truth);
    Truth truth;
    for (auto [name, half] : {std::pair{"a", &truth.a}, {"b", &truth.b}}) {
        const ExrPart* part = file.find(name);
        const std::string where = file.path().string() + ": truth of frame " + std::to_string(entry.frame);
        if (!part)
            throw InputError(where + " has no part '" + name + "'; export the truth again (two independent halves)");
        if (part->width != manifest_.width || part->height != manifest_.height)
            throw InputError(where + ", part '" + name + "': expected " + std::to_string(manifest_.width) + "x" +
                             std::to_string(manifest_.height) + " pixels (shot.json), found " +
                             std::to_string(part->width) + "x" + std::to_string(part->height) +
                             "; export the truth again");
        std::vector<ChannelTarget> t = {{"R", &half->c[0]}, {"G", &half->c[1]}, {"B", &half->c[2]}};
        file.read(*part, t);
        SanitiseCounts counts;
        // A reference is not repaired: every figure rests on it.
        sanitiseColour(*half, false, policy_ == InputPolicy::raw ? policy_ : InputPolicy::strict,
                       {where + ", part '" + name + "'", {"R", "G", "B"}}, counts);
        half->fillBorder();
    }
    return truth;
}

}  // namespace aa
