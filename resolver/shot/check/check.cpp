#include "shot/check/check.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <set>

#include "image/error.h"
#include "shot/check/depth.h"
#include "shot/check/ids.h"
#include "shot/check/jitter.h"
#include "shot/check/motion.h"
#include "shot/reader.h"
#include "shot/segments.h"

namespace aa {
using glm::dvec2;

namespace {
constexpr double kUnitTolerance = 4e-3;  // of a normal's length; half has 1e-3
constexpr size_t kFewestForMean = 4;     // frames that stand in for a missing truth

std::vector<const PlaneF*> planesOf(const Rgb& c) { return {&c.c[0], &c.c[1], &c.c[2]}; }
Rgb meanOf(const Truth& t) {
    Rgb r = t.a;
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < r.height(); y++)
            for (int x = 0; x < r.width(); x++) r.c[c].at(x, y) = 0.5f * (t.a.c[c].at(x, y) + t.b.c[c].at(x, y));
    return r;
}
// A number per object, so that ids can be registered like a picture.
float shadeOf(uint32_t id) { return 0.05f + 0.95f * float((id * 2654435761u) >> 8) / float(1u << 24); }

class ShotCheck {
  public:
    explicit ShotCheck(const std::filesystem::path& shot)
        : reader_(shot, InputPolicy::raw), manifest_(reader_.manifest()) {
        report_.name = manifest_.name;
        report_.frames = manifest_.frames.size();
    }

    CheckReport run(const std::function<bool(int)>& goOn) {
        gaps();
        std::optional<Frame> previous;
        for (size_t i = 0; i < manifest_.frames.size(); i++) {
            std::optional<Frame> frame = frameAt(i);
            centreAt(i);
            const bool follows = i > 0 && previous && frame && !frame->reset && frame->number == previous->number + 1;
            if (frame && follows && has(*frame, Pass::motion | Pass::depth)) {
                const bool sameIds = !has(*frame, Pass::object) || ids_.add(*previous, *frame, report_);
                if (sameIds && !manifest_.isStatic) motion_.add(*previous, *frame);
            }
            if (frame && !manifest_.isStatic && has(*frame, Pass::motion | Pass::depth)) depth_.addMotion(*frame);
            previous = std::move(frame);
            if (goOn && !goOn(manifest_.frames[i].frame)) break;
        }
        if (manifest_.jitterPremultiplied)
            namePremultiplied();
        else if (jitter_.size() == 0)
            registerWithoutTruth();
        if (jitter_.size() > 0) jitter_.judge(report_);
        if (!manifest_.isStatic) motion_.judge(report_);
        depth_.judge(report_);
        return std::move(report_);
    }

  private:
    static bool has(const Frame& f, PassSet p) { return p.without(f.passes).empty(); }
    void find(const char* check, std::optional<int> frame, std::string channel, std::optional<glm::ivec2> pixel,
              std::string expected, std::string found, std::string advice, uint64_t count = 0) {
        report_.findings.push_back(
            {check, frame, std::move(channel), pixel, std::move(expected), std::move(found), std::move(advice), count});
    }

    void gaps() {
        for (size_t i = 1; i < manifest_.frames.size(); i++) {
            const FrameEntry &before = manifest_.frames[i - 1], &now = manifest_.frames[i];
            if (now.frame == before.frame + 1 || now.reset) continue;
            find("files", before.frame + 1, "", std::nullopt,
                 "frame " + std::to_string(before.frame + 1) + " after frame " + std::to_string(before.frame),
                 "frame " + std::to_string(now.frame),
                 "export the missing frames, or set \"reset\" where the sequence starts anew");
        }
        if (!manifest_.frames[0].reset && !manifest_.isStatic)
            find("files", manifest_.frames[0].frame, "", std::nullopt, "\"reset\": true in the first frame", "none",
                 "set it: there is no history before it");
    }

    // Decodes and checks what concerns one frame alone; nothing when it cannot be read.
    std::optional<Frame> frameAt(size_t i) {
        const FrameEntry& entry = manifest_.frames[i];
        Frame f;
        try {
            if (report_.passes.empty()) report_.passes = reader_.offeredBy(i);
            f = reader_.read(i, report_.passes);
        } catch (const InputError& e) {
            unreadable(entry.frame, "a readable frame", e.what());
            return std::nullopt;
        }
        numbers(f, "");
        if (has(f, Pass::normal)) normals(f);
        if (has(f, Pass::object)) objects(f);
        if (has(f, Pass::depth)) depth_.add(f, entry, report_);
        if (manifest_.isStatic && has(f, Pass::motion)) motion_.addStatic(f, report_);
        if (has(f, Pass::color)) registerAgainstTruth(i, f, entry.jitterPx);
        return f;
    }
    void centreAt(size_t i) {
        const FrameEntry& entry = manifest_.frames[i];
        if (!reader_.hasCentreFrames() || (!entry.centre.empty() && entry.centre == lastCentre_)) return;
        lastCentre_ = entry.centre;
        try {
            if (report_.centrePasses.empty()) report_.centrePasses = reader_.offeredBy(i, Sampling::centre);
            const Frame f = reader_.readCentre(i, report_.centrePasses);
            numbers(f, "centre ");
            if (has(f, Pass::color)) registerAgainstTruth(i, f, dvec2(0.0));
        } catch (const InputError& e) {
            unreadable(entry.frame, "a readable centre-sampled frame", e.what());
        }
    }
    // `why` is an error's line, whose last words say what to do.
    void unreadable(int frame, const char* expected, const std::string& why) {
        const size_t advice = why.rfind("; ");
        find("files", frame, "", std::nullopt, expected, why.substr(0, advice),
             advice == std::string::npos ? "export the frame again" : why.substr(advice + 2));
    }

    void numbers(const Frame& f, const std::string& prefix) {
        const auto count = [&](const PlaneF& plane, const std::string& channel) {
            if (plane.empty() || numbersFound_.contains(prefix + channel)) return;
            uint64_t nan = 0, inf = 0;
            glm::ivec2 first(0);
            for (int y = 0; y < f.height; y++)
                for (int x = 0; x < f.width; x++) {
                    const float v = plane.at(x, y);
                    if (std::isfinite(v)) continue;
                    if (nan + inf == 0) first = {x, y};
                    (std::isnan(v) ? nan : inf)++;
                }
            if (nan + inf == 0) return;
            numbersFound_.insert(prefix + channel);
            find("numbers", f.number, prefix + channel, first, "finite numbers",
                 std::to_string(nan) + " NaN and " + std::to_string(inf) + " Inf",
                 "repair the render; `run` replaces and counts them", nan + inf);
        };
        const auto rgb = [&](const Rgb& c, const std::string& part, const char* channels) {
            for (size_t k = 0; k < 3; k++) count(c.c[k], part + channels[k]);
        };
        rgb(f.colorLinear, "color ", "RGB");
        rgb(f.albedoLinear, "albedo.", "RGB");
        rgb(f.normalWorld, "N.", "XYZ");
        count(f.depthView, "Z");
        count(f.motionXPx, "motion.X");
        count(f.motionYPx, "motion.Y");
        count(f.edgeXPx, "edge.X");
        count(f.edgeYPx, "edge.Y");
        segmentNumbers(f, prefix);
        for (size_t k = 0; k < f.subSamples.size(); k++) {
            count(f.subSamples[k].depthView, subSampleChannel(k, "Z"));
            rgb(f.subSamples[k].normalWorld, subSampleChannel(k, "N."), "XYZ");
            rgb(f.subSamples[k].colorLinear, subSampleChannel(k, ""), "RGB");
        }
    }

    void segmentNumbers(const Frame& f, const std::string& prefix) {
        uint64_t bad = 0;
        size_t first = 0;
        for (size_t i = 0; i < f.segments.size(); i++)
            if (!isUsable(f.segments[i]) && bad++ == 0) first = i;
        if (bad == 0 || !numbersFound_.insert(prefix + "segments").second) return;
        find("numbers", f.number, prefix + "segments", std::nullopt, "finite positions and depths > 0",
             std::to_string(bad) + " unusable segments, the first at index " + std::to_string(first),
             "repair the export; `run` leaves them out and counts them");
    }

    void normals(const Frame& f) {
        if (normalsFound_) return;
        uint64_t bad = 0;
        glm::ivec2 first(0);
        double length = 0;
        for (int y = 0; y < f.height; y++)
            for (int x = 0; x < f.width; x++) {
                const double l = std::sqrt(double(f.normalWorld.c[0].at(x, y)) * f.normalWorld.c[0].at(x, y) +
                                           double(f.normalWorld.c[1].at(x, y)) * f.normalWorld.c[1].at(x, y) +
                                           double(f.normalWorld.c[2].at(x, y)) * f.normalWorld.c[2].at(x, y));
                if (!std::isfinite(l)) continue;
                const bool background = has(f, Pass::depth) && f.depthView.at(x, y) >= 1e9f;
                const bool fine = background ? l <= kUnitTolerance
                                             : std::abs(l - 1) <= kUnitTolerance || (l == 0 && !has(f, Pass::depth));
                if (!fine && bad++ == 0) first = {x, y}, length = l;
            }
        // Renderers average the two sides of an edge in a few pixels; more than that is a wrong encoding.
        if (bad <= size_t(f.width) * size_t(f.height) / 200) return;
        normalsFound_ = true;
        find("normal", f.number, "N.X N.Y N.Z", first, "unit length on surfaces, 0 on background",
             "length " + std::to_string(length), "write world-space unit normals, not colours in 0..1", bad);
    }

    void objects(const Frame& f) {
        if (objectsFound_ || manifest_.objects.empty()) return;
        for (int y = 0; y < f.height; y++)
            for (int x = 0; x < f.width; x++) {
                const uint32_t id = f.objectId.at(x, y);
                if (id == 0 || id == lastKnownId_) continue;
                if (manifest_.objects.contains(id)) {
                    lastKnownId_ = id;
                    continue;
                }
                objectsFound_ = true;
                find("object", f.number, "id", glm::ivec2(x, y), "an id listed under \"objects\" in shot.json",
                     std::to_string(id), "list every object and instance, or write uint ids (float ids lose digits)");
                return;
            }
    }

    void registerAgainstTruth(size_t i, const Frame& f, dvec2 statedPx) {
        FrameEntry entry = manifest_.frames[i];
        if (entry.truth.empty()) return;
        if (entry.truth != truthFile_) {
            truthFile_ = entry.truth;
            truthMean_.reset();
            try {
                const Truth truth = *reader_.readTruth(i);
                truthMean_ = meanOf(truth);
                truthMean_->fillBorder();
                for (const auto& plane : truthMean_->c)
                    for (int y = 0; y < plane.height() && truthMean_; y++)
                        for (int x = 0; x < plane.width(); x++)
                            if (!std::isfinite(plane.at(x, y))) {
                                find("numbers", entry.frame, "truth", glm::ivec2(x, y), "a finite truth", "NaN or Inf",
                                     "render the truth again");
                                truthMean_.reset();
                                return;
                            }
            } catch (const InputError& e) {
                find("files", entry.frame, "", std::nullopt, "a readable truth", e.what(), "export the truth again");
            }
        }
        if (!truthMean_) return;
        const bool atOwnPlace = !manifest_.jitterPremultiplied || statedPx == dvec2(0.0);
        entry.jitterPx = statedPx;
        (atOwnPlace ? jitter_ : premultiplied_)
            .add(entry, registerSamples(planesOf(f.colorLinear), planesOf(*truthMean_)));
    }

    // Its samples do not lie at the stated jitter, so they are not held against it; frames at pixel centres are.
    void namePremultiplied() {
        char text[400];
        const auto& camera = manifest_.frames[0].camera;
        const dvec2 focal = camera ? dvec2(camera->projection[0][0], camera->projection[1][1]) : dvec2(0.0);
        std::snprintf(
            text, sizeof text,
            "premultiplied jitter, as shot.json says: a sample lies at (%.4g jx, %.4g jy) / depth px from the "
            "pixel centre and not at the jitter (jx, jy) that the methods are told",
            focal.x, focal.y);
        report_.variants.emplace_back(text);
        const auto scale = premultiplied_.scaleFound();
        if (!scale) {
            report_.notChecked.push_back("premultiplied jitter: no truth, or too few edges that can be registered");
            return;
        }
        report_.measured.push_back({"jitter.premultipliedScaleX", scale->x});
        report_.measured.push_back({"jitter.premultipliedScaleY", scale->y});
    }

    // No truth: the mean over all frames stands in for it, on pixels that rest. Ids are registered like a picture,
    // beside the colour.
    void registerWithoutTruth() {
        const size_t count = manifest_.frames.size();
        const PassSet all = ids_.changed() ? PassSet(Pass::color) : Pass::object | Pass::color;
        const PassSet pictures = all.without(all.without(report_.passes));
        if (count < kFewestForMean || pictures.empty() || !report_.passes.has(Pass::motion)) {
            report_.notChecked.push_back(
                "jitter: no truth, and without it at least 4 frames with motion and ids or colour are needed");
            return;
        }
        std::vector<dvec2> samples;
        dvec2 meanJitter(0.0);
        for (const auto& entry : manifest_.frames) {
            samples.push_back(entry.jitterPx);
            meanJitter += entry.jitterPx / double(count);
        }
        // The mean is only as wide as the stated jitter: a wrong unit scales both and stays unseen.
        report_.notChecked.push_back("size of the jitter: needs a truth");
        std::vector<dvec2> centred = samples;
        for (auto& p : centred) p -= meanJitter;
        jitter_ = JitterCheck(std::move(centred));
        try {
            const auto [mean, rests] = restingMean(pictures);
            for (size_t i = 0; i < count; i++) {
                const auto p = picturesOf(reader_.read(i, pictures));
                FrameEntry entry = manifest_.frames[i];
                entry.jitterPx -= meanJitter;  // which is where the mean picture is sampled
                // A mean of n samples knows where an edge lies to within half of their spacing.
                jitter_.add(entry, registerSamples(pointers(p), pointers(mean), samples, rests), 0.5 / double(count));
            }
        } catch (const InputError&) {  // has been reported
        }
    }
    static std::vector<const PlaneF*> pointers(const std::vector<PlaneF>& planes) {
        std::vector<const PlaneF*> r;
        for (const auto& p : planes) r.push_back(&p);
        return r;
    }
    static std::vector<PlaneF> picturesOf(const Frame& f) {
        std::vector<PlaneF> r;
        if (!f.colorLinear.empty()) r.push_back(f.colorLinear.c[1]);
        if (!f.objectId.empty()) {
            PlaneF shades(f.width, f.height);
            for (int y = 0; y < f.height; y++)
                for (int x = 0; x < f.width; x++) shades.at(x, y) = shadeOf(f.objectId.at(x, y));
            r.push_back(std::move(shades));
        }
        return r;
    }
    // Mean pictures over all frames, and 1 where nothing within 2 px moves in any of them.
    std::pair<std::vector<PlaneF>, Plane<uint8_t>> restingMean(PassSet pictures) const {
        std::vector<PlaneF> mean;
        Plane<uint8_t> rests(manifest_.width, manifest_.height, 1);
        for (size_t i = 0; i < manifest_.frames.size(); i++) {
            const Frame f = reader_.read(i, pictures | Pass::motion);
            const auto p = picturesOf(f);
            if (i == 0) mean.assign(p.size(), PlaneF(f.width, f.height));
            for (int y = 0; y < f.height; y++)
                for (int x = 0; x < f.width; x++) {
                    for (size_t k = 0; k < p.size(); k++)
                        mean[k].at(x, y) += p[k].at(x, y) / float(manifest_.frames.size());
                    if (std::abs(f.motionXPx.at(x, y)) < 0.01f && std::abs(f.motionYPx.at(x, y)) < 0.01f) continue;
                    for (int j = std::max(y - 2, 0); j <= std::min(y + 2, f.height - 1); j++)
                        for (int k = std::max(x - 2, 0); k <= std::min(x + 2, f.width - 1); k++) rests.at(k, j) = 0;
                }
        }
        return {std::move(mean), std::move(rests)};
    }

    ShotReader reader_;
    const Manifest& manifest_;
    CheckReport report_;
    JitterCheck jitter_, premultiplied_;
    IdCheck ids_;
    MotionCheck motion_;
    DepthCheck depth_;
    std::string lastCentre_, truthFile_;
    std::optional<Rgb> truthMean_;
    std::set<std::string> numbersFound_;
    bool normalsFound_ = false, objectsFound_ = false;
    uint32_t lastKnownId_ = 0;
};
}  // namespace

std::string Finding::line() const {
    std::string s = check + ":";
    if (frame) s += " frame " + std::to_string(*frame);
    if (!channel.empty()) s += (frame ? ", " : " ") + channel;
    if (pixel) s += ", pixel (" + std::to_string(pixel->x) + ", " + std::to_string(pixel->y) + ")";
    s += ": expected " + expected + ", found " + found;
    if (count > 1) s += " (" + std::to_string(count) + " pixels)";
    return s + "; " + advice;
}

nlohmann::ordered_json toJson(const CheckReport& r) {
    nlohmann::ordered_json j = {
        {"shot", r.name}, {"clean", r.clean()}, {"frames", r.frames}, {"passes", names(r.passes)}};
    if (!r.centrePasses.empty()) j["centrePasses"] = names(r.centrePasses);
    j["findings"] = nlohmann::ordered_json::array();
    for (const auto& f : r.findings) {
        nlohmann::ordered_json e = {{"check", f.check}};
        if (f.frame) e["frame"] = *f.frame;
        if (!f.channel.empty()) e["channel"] = f.channel;
        if (f.pixel) e["pixel"] = {f.pixel->x, f.pixel->y};
        e["expected"] = f.expected;
        e["found"] = f.found;
        e["advice"] = f.advice;
        if (f.count) e["count"] = f.count;
        j["findings"].push_back(e);
    }
    j["measured"] = nlohmann::ordered_json::object();
    for (const auto& m : r.measured) j["measured"][m.name] = m.value;
    j["notChecked"] = r.notChecked;
    j["variants"] = r.variants;
    return j;
}

CheckReport checkShot(const std::filesystem::path& shot, const std::function<bool(int)>& goOn) {
    return ShotCheck(shot).run(goOn);
}

}  // namespace aa
