#include "shot/reader.h"

#include <algorithm>

#include "image/error.h"
#include "image/exr.h"
#include "shot/pass_table.h"
#include "shot/sanitise.h"
#include "shot/segments.h"

namespace aa {
namespace {

constexpr const char* kWholeFrames = "export whole frames, without a region, a crop or overscan";

std::string size(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

// The part holds the shot's whole picture; `advice` ends the line where it has another size.
void requirePicture(const ExrPart& part, const std::string& name, const Manifest& m, const std::string& where,
                    const std::string& advice) {
    requireWhole(part, where + ", part '" + name + "'", kWholeFrames);
    if (part.width != m.width || part.height != m.height)
        throw InputError(where + ", part '" + name + "': expected " + size(m.width, m.height) +
                         " pixels (shot.json), found " + size(part.width, part.height) + "; " + advice);
}

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
        for (const auto& info : allPasses()) {
            if (!wanted.hasAnyOf(info.pass)) continue;
            if (info.isList)
                segments();
            else if (info.perSubSample)
                subSamples(wanted, info.part);
            else
                picture(info);
        }
    }

  private:
    const ExrPart& part(std::string_view name) {
        const ExrPart* p = file_.find(name);
        if (!p)
            throw InputError(where() + " has no part '" + std::string(name) +
                             "'; export the shot again with this pass");
        requirePicture(*p, std::string(name), manifest_, where(), "export the frame again");
        return *p;
    }
    std::string where() const { return file_.path().string() + ": frame " + std::to_string(entry_.frame); }
    PlaneName planeName(std::string_view part, std::vector<std::string> channels) const {
        return {where() + ", part '" + std::string(part) + "'", std::move(channels)};
    }

    // A group of channels that is to be read, and where it goes.
    struct Wanted {
        const ChannelGroup* group;
        size_t first;  // of its targets
    };
    static void want(const ChannelGroup& group, const std::vector<PlaneRef>& planes, const std::string& prefix,
                     std::vector<ChannelTarget>& targets, std::vector<Wanted>& wanted) {
        wanted.push_back({&group, targets.size()});
        for (size_t i = 0; i < planes.size(); i++)
            targets.push_back({prefix + std::string(group.channels[i]), planes[i]});
    }
    // One read of a part, then the repairs, group by group.
    void read(std::string_view partName, std::vector<ChannelTarget>& targets, const std::vector<Wanted>& wanted) {
        file_.read(part(partName), targets);
        for (const Wanted& w : wanted) {
            const std::span<const ChannelTarget> own(targets.data() + w.first, w.group->channels.size());
            std::vector<PlaneRef> planes;
            std::vector<std::string> names;
            for (const ChannelTarget& t : own) planes.push_back(t.plane), names.push_back(t.channel);
            if (w.group->sanitise)
                w.group->sanitise(planes, own[0].stored == ChannelType::half, policy_, planeName(partName, names),
                                  counts_);
            for (const PlaneRef& p : planes) std::visit([](auto* plane) { plane->fillBorder(); }, p);
        }
    }
    void picture(const PassInfo& info) {
        std::vector<ChannelTarget> targets;
        std::vector<Wanted> wanted;
        for (const ChannelGroup& group : info.groups) {
            const std::vector<PlaneRef> planes = group.ofFrame(frame_);
            if (info.zeroWhereStatic && manifest_.isStatic && !file_.find(info.part)) {
                for (const PlaneRef& p : planes)
                    std::visit([&]<class P>(P* plane) { *plane = P(manifest_.width, manifest_.height); }, p);
                return;
            }
            want(group, planes, "", targets, wanted);
        }
        read(info.part, targets, wanted);
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
    // One read for everything at the sub-samples: the part's channels share their compressed blocks.
    void subSamples(PassSet wanted, std::string_view partName) {
        if (!frame_.subSamples.empty()) return;  // another pass of the part has read it
        const size_t count = manifest_.subsamplePositionsPx.size();
        if (count == 0)
            throw InputError((manifest_.folder / "shot.json").string() +
                             ": subsamples.positions: expected the positions of the sub-samples, found none; export "
                             "the shot again with sub-samples");
        frame_.subSamplePositionsPx = manifest_.subsamplePositionsPx;
        frame_.subSamples.resize(count);
        std::vector<ChannelTarget> targets;
        std::vector<Wanted> groups;
        const auto isWanted = [&](const ChannelGroup& g) { return wanted.has(g.share); };
        const auto ofPart = [&](const PassInfo& p) {
            return p.perSubSample && p.part == partName && wanted.hasAnyOf(p.pass);
        };
        for (const auto& info : allPasses())
            if (ofPart(info))
                for (const ChannelGroup& g : info.shared)
                    if (isWanted(g)) want(g, g.ofFrame(frame_), "", targets, groups);
        for (size_t k = 0; k < count; k++)
            for (const auto& info : allPasses())
                if (ofPart(info))
                    for (const ChannelGroup& g : info.groups)
                        if (isWanted(g))
                            want(g, g.ofSubSample(frame_.subSamples[k]), subSampleChannel(k, ""), targets, groups);
        read(partName, targets, groups);
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

size_t ShotReader::firstWithCentre() const {
    const auto& frames = manifest_.frames;
    const auto has = [](const FrameEntry& f) { return !f.centre.empty(); };
    return size_t(std::find_if(frames.begin(), frames.end(), has) - frames.begin());
}

const std::string& ShotReader::fileOf(size_t index, Sampling sampling) const {
    const FrameEntry& entry = manifest_.frames.at(index);
    if (sampling != Sampling::centre) return entry.file;
    if (entry.centre.empty())
        throw InputError((manifest_.folder / "shot.json").string() + ": frame " + std::to_string(entry.frame) +
                         ": expected `centre`, its samples at the pixel centres, as other frames have, found none; " +
                         "export them for every frame");
    return entry.centre;
}

PassSet ShotReader::offered(Sampling sampling) const {
    return offeredBy(sampling == Sampling::centre ? firstWithCentre() : 0, sampling);
}

PassSet ShotReader::offeredBy(size_t index, Sampling sampling) const {
    const ExrFile file(manifest_.folder / fileOf(index, sampling));
    PassSet r;
    for (const auto& info : allPasses()) {
        const ExrPart* part = file.find(info.part);
        if (!part) continue;
        if (info.perSubSample && !part->find(subSampleChannel(0, info.groups[0].channels[0]))) continue;
        r |= info.pass;
    }
    for (const auto& info : allPasses())
        if (info.zeroWhereStatic && manifest_.isStatic) r |= info.pass;
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
    FrameDecoder(manifest_, entry, fileOf(index, sampling), policy_, f, own).decode(wanted);
    if (counts) *counts += own;
    return f;
}

Frame ShotReader::read(size_t index, PassSet wanted, SanitiseCounts* counts) const {
    return decode(index, wanted, Sampling::jittered, counts);
}

Frame ShotReader::readCentre(size_t index, PassSet wanted, SanitiseCounts* counts) const {
    return decode(index, wanted, Sampling::centre, counts);
}

std::optional<Truth> ShotReader::readTruth(size_t index, SanitiseCounts* counts) const {
    const FrameEntry& entry = manifest_.frames.at(index);
    if (entry.truth.empty()) return std::nullopt;
    ExrFile file(manifest_.folder / entry.truth);
    Truth truth;
    for (auto [name, half] : {std::pair{"a", &truth.a}, {"b", &truth.b}}) {
        const ExrPart* part = file.find(name);
        const std::string where = file.path().string() + ": truth of frame " + std::to_string(entry.frame);
        if (!part)
            throw InputError(where + " has no part '" + name + "'; export the truth again (two independent halves)");
        requirePicture(*part, name, manifest_, where, "export the truth again");
        std::vector<ChannelTarget> t = {{"R", &half->c[0]}, {"G", &half->c[1]}, {"B", &half->c[2]}};
        file.read(*part, t);
        const ColourCounts found =
            sanitiseColour(*half, false, policy_ == InputPolicy::raw ? policy_ : InputPolicy::strict, ColourUse::truth,
                           {where + ", part '" + name + "'",
                            {"R", "G", "B"},
                            "render the truth again: it is never repaired, since every figure rests on it"});
        if (counts) {
            counts->truthNan += found.nan, counts->truthInf += found.inf, counts->truthNegative += found.negative;
        }
        half->fillBorder();
    }
    return truth;
}

}  // namespace aa
