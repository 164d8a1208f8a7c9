#include "shot/synth/synth.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "image/error.h"
#include "image/io.h"
#include "image/json_text.h"
#include "kernels/dispatch.h"
#include "shot/manifest.h"
#include "shot/patterns.h"
#include "shot/synth/placed.h"
#include "shot/synth/sampler.h"
#include "shot/synth/scenes.h"
#include "shot/synth/truth.h"
#include "shot/writer.h"

namespace aa {
using glm::dvec2;
using glm::dvec3;

namespace {
dvec2 turned(dvec2 p, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * p.x - s * p.y, s * p.x + c * p.y};
}
bool polygonsOnly(const std::vector<SynthShape>& shapes) {
    return std::all_of(shapes.begin(), shapes.end(),
                       [](const auto& s) { return std::holds_alternative<Polygon>(s.region); });
}

// [Stejmar n.d., 3.7.1]: the jitter's translation in clip space, multiplied to the wrong side of the projection, moves
// the geometry in view space instead. It is a translation parallel to the picture's plane, so every depth stays.
dvec3 premultipliedShift(dvec2 jitterPx, int width, int height) {
    return {-2 * jitterPx.x / width, 2 * jitterPx.y / height, 0.0};
}

// The same shapes, seen by a perspective camera after a movement by `shiftView` in view space.
void moveInView(std::vector<Placed>& placed, const Sampler& before, const Manifest& m, dvec3 shiftView) {
    const glm::dmat4& projection = m.frames[0].camera->projection;
    const dvec2 pxAtUnitDepth(shiftView.x * projection[0][0] * m.width / 2,
                              -shiftView.y * projection[1][1] * m.height / 2);
    for (Placed& shape : placed) {
        for (dvec2& corner : std::get<Polygon>(shape.region))
            corner += pxAtUnitDepth / double(before.depth(&shape, corner));
        shape.bounds = bounds(shape.region);
    }
}

// All edges of a polygon but its seams, hidden ones too.
void addSegments(const Placed& shape, const Sampler& sampler, std::vector<EdgeSegment>& to) {
    const auto& corners = std::get<Polygon>(shape.region);
    for (size_t i = 0; i < corners.size(); i++) {
        const dvec2 a = corners[i], b = corners[(i + 1) % corners.size()];
        if (a == b || isSeam(*shape.shape, i)) continue;
        to.push_back(
            {float(a.x), float(a.y), sampler.depth(&shape, a), float(b.x), float(b.y), sampler.depth(&shape, b)});
    }
}

// Planar z of each object's geometry, nearest and farthest: what `check` holds a scaled depth against.
nlohmann::json depthBounds(const SynthSceneContents& scene, int width, int height, double time) {
    std::map<uint32_t, std::pair<double, double>> range;
    const Sampler sampler(scene, width, height, time);
    for (const Placed& p : placedAt(scene.shapes, time)) {
        const auto add = [&](dvec2 corner) {
            const double z = sampler.depth(&p, corner);
            auto [it, isNew] = range.emplace(p.shape->object, std::pair(z, z));
            it->second = {std::min(it->second.first, z), std::max(it->second.second, z)};
        };
        if (const auto* polygon = std::get_if<Polygon>(&p.region))
            for (const dvec2& corner : *polygon) add(corner);
        else
            add(std::get<Disc>(p.region).centre);  // discs face the camera
    }
    nlohmann::json j = nlohmann::json::object();
    for (const auto& [id, z] : range) j[std::to_string(id)] = {z.first, z.second};
    return j;
}

// How far the samples of a pixel lie outside of it.
double reachOf(dvec2 samplePx, const std::vector<dvec2>& subSamplesPx) {
    const auto farthest = [](dvec2 p) { return std::max(std::abs(p.x), std::abs(p.y)); };
    double most = 0;
    for (const dvec2& p : subSamplesPx) most = std::max(most, farthest(samplePx + p));
    return std::max(0.0, std::max(most, farthest(samplePx)) - 0.5);
}
void putSample(Frame& f, int x, int y, const Sampler& sampler, const Placed* hit, dvec2 p) {
    put(f.colorLinear, x, y, sampler.color(hit, p));
    put(f.normalWorld, x, y, sampler.normal(hit));
    f.depthView.at(x, y) = sampler.depth(hit, p);
    f.objectId.at(x, y) = sampler.object(hit);
    const dvec2 motion = sampler.motionPx(hit, p);
    f.motionXPx.at(x, y) = float(motion.x);
    f.motionYPx.at(x, y) = float(motion.y);
}
void putSubSample(SubSample& s, int x, int y, const Sampler& sampler, const Placed* hit, dvec2 p) {
    s.depthView.at(x, y) = sampler.depth(hit, p);
    put(s.normalWorld, x, y, sampler.normal(hit));
    s.objectId.at(x, y) = sampler.object(hit);
    if (!s.colorLinear.empty()) put(s.colorLinear, x, y, sampler.color(hit, p));
}

std::string numbered(const char* folder, int frame) {
    char text[48];
    std::snprintf(text, sizeof text, "%s/%06d.exr", folder, frame);
    return text;
}
}  // namespace

dvec2 RigidMotion::apply(dvec2 p, double time) const {
    return pivotPx + turned(p - pivotPx, turn * time) + velocityPx * time;
}
dvec2 RigidMotion::invert(dvec2 p, double time) const {
    return pivotPx + turned(p - velocityPx * time - pivotPx, -turn * time);
}

struct SynthShot::Scene {
    SynthSceneContents contents;
};

SynthShot::SynthShot(const SynthOptions& o) {
    if (o.width < 1 || o.height < 1 || o.width > kLargestSide || o.height > kLargestSide)
        throw UsageError("synth: resolution " + std::to_string(o.width) + "x" + std::to_string(o.height) +
                         ": expected 1..16384 a side");
    if (o.frames < 1 || o.frames > 1000000)
        throw UsageError("synth: " + std::to_string(o.frames) + " frames: expected 1..1000000");
    if (o.subsampleColor && o.subsamples.empty())
        throw UsageError("synth: colour at sub-samples needs a sub-sample pattern");
    auto scene = std::make_shared<Scene>();
    scene->contents = makeScene(o);
    scene_ = scene;
    const bool canPremultiply = scene->contents.camera.kind == "perspective" && scene->contents.isStatic;
    if (o.premultiplied && (!canPremultiply || o.jitter == "none"))
        throw UsageError(
            "synth: premultiplied jitter errs with the depth, so it needs a jitter and a perspective scene at rest, "
            "such as two_planes");
    const JitterInfo& sequence = jitterSequence(o.jitter);
    const JitterSpec jitter{o.jitter, o.jitterStart, sequence.naturalPeriod ? sequence.naturalPeriod : o.period,
                            o.centred};

    passes_ = Pass::color | Pass::albedo | Pass::depth | Pass::normal | Pass::object | Pass::motion;
    if (!o.subsamples.empty()) passes_ |= Pass::subsamples;
    if (o.subsampleColor) passes_ |= Pass::subsampleColor;
    if (polygonsOnly(scene_->contents.shapes) && !scene_->contents.zonePlate) passes_ |= Pass::edges | Pass::segments;

    Manifest& m = manifest_;
    m.name = o.scene;
    m.width = o.width;
    m.height = o.height;
    m.jitterSequence = o.jitter;
    m.jitterStart = o.jitterStart >= 0 ? o.jitterStart : sequence.start;
    m.jitterPeriod = jitter.period;
    m.jitterPremultiplied = o.premultiplied;
    m.isStatic = scene_->contents.isStatic;
    m.objects = scene_->contents.objects;
    if (!o.subsamples.empty()) {
        m.subsamplePattern = o.subsamples;
        m.subsamplePositionsPx = patternPositionsPx(o.subsamples);
    }
    m.truthSamplesPerHalf = scene_->contents.zonePlate ? kZonePlateStrata * kZonePlateStrata : 0;
    m.extra["producer"] = {{"name", kSynthProducer}, {"version", AA_VERSION}};
    m.extra["jitter"]["centred"] = o.centred;
    m.extra["truth"]["exact"] = !scene_->contents.zonePlate;  // areas by formula: no samples, no error bar
    for (int i = 0; i < o.frames; i++) {
        FrameEntry f;
        f.frame = i + 1;
        f.file = numbered("frames", f.frame);
        f.truth = numbered("truth", m.isStatic ? 1 : f.frame);
        if (o.jitter != "none" && !(o.centreWanted && o.centreWanted->empty()))
            f.centre = numbered("centre", m.isStatic ? 1 : f.frame);
        f.reset = i == 0;
        f.jitterPx = jitterPx(jitter, uint64_t(i));
        f.camera = scene_->contents.camera;
        f.extra = jsonText(nlohmann::json{{"depth_bounds", depthBounds(scene_->contents, o.width, o.height, i)}}, -1);
        m.frames.push_back(std::move(f));
    }
}

const std::vector<SynthShape>& SynthShot::shapes() const { return scene_->contents.shapes; }

std::function<dvec3(dvec2)> SynthShot::picture(size_t index) const {
    return [this, index, placed = placedAt(shapes(), double(index))](dvec2 p) {
        const Sampler sampler(scene_->contents, manifest_.width, manifest_.height, double(index));
        return sampler.color(frontMost(placed, p), p);
    };
}

Frame SynthShot::frame(size_t index, Sampling sampling) const {
    const FrameEntry& entry = manifest_.frames.at(index);
    const int w = manifest_.width, h = manifest_.height;
    Frame f;
    f.number = entry.frame;
    f.width = w;
    f.height = h;
    f.reset = entry.reset;
    f.jitterPx = sampling == Sampling::centre ? dvec2(0.0) : entry.jitterPx;
    f.camera = entry.camera;
    if (index > 0 && !entry.reset) f.previousCamera = manifest_.frames[index - 1].camera;
    f.passes = passes_;
    f.colorLinear = f.normalWorld = Rgb(w, h);
    f.depthView = f.motionXPx = f.motionYPx = PlaneF(w, h);
    f.objectId = PlaneU(w, h);
    const bool edges = passes_.has(Pass::edges), subSamples = passes_.has(Pass::subsamples);
    if (edges) f.edgeXPx = f.edgeYPx = PlaneF(w, h, 0.5f);
    if (subSamples) {
        f.subSamplePositionsPx = manifest_.subsamplePositionsPx;
        f.subSampleMask = PlaneU(w, h);
        for (size_t k = 0; k < f.subSamplePositionsPx.size(); k++)
            f.subSamples.push_back(
                {PlaneF(w, h), Rgb(w, h), PlaneU(w, h), passes_.has(Pass::subsampleColor) ? Rgb(w, h) : Rgb()});
    }

    const double time = double(index);
    const auto atRest = placedAt(shapes(), time);
    const Sampler unmoved(scene_->contents, w, h, time);
    dvec2 samplePx = f.jitterPx;
    dvec3 shiftView(0.0);
    auto placed = atRest;
    if (manifest_.jitterPremultiplied) {
        shiftView = premultipliedShift(f.jitterPx, w, h);
        moveInView(placed, unmoved, manifest_, shiftView);
        samplePx = dvec2(0.0);
    }
    const Sampler sampler(scene_->contents, w, h, time, shiftView);
    const double reachPx = reachOf(samplePx, f.subSamplePositionsPx);
    const auto shapesByRow = shapesOfRows(placed, h, reachPx);
    forRows({}, h, [&](int y0, int y1) {
        for (int y = y0; y < y1; y++) {
            const PlacedRow row(shapesByRow[size_t(y)], y, w, reachPx);
            const Placed* hit = nullptr;
            for (int x = 0; x < w; x++) {
                const dvec2 p = dvec2(x + 0.5, y + 0.5) + samplePx;
                const bool isCrossed = row.isCrossed(x);
                if (isCrossed || x == 0 || row.isCrossed(x - 1)) hit = row.frontMost(x, p);
                putSample(f, x, y, sampler, hit, p);
                if (edges && hit) {
                    const dvec2 e = nearestEdgePx(*hit, p);
                    f.edgeXPx.at(x, y) = float(e.x);
                    f.edgeYPx.at(x, y) = float(e.y);
                }
                for (size_t k = 0; k < f.subSamples.size(); k++) {
                    const dvec2 q = p + f.subSamplePositionsPx[k];
                    const Placed* subHit = isCrossed ? row.frontMost(x, q) : hit;
                    putSubSample(f.subSamples[k], x, y, sampler, subHit, q);
                    if (k < 32 && sampler.object(subHit) == sampler.object(hit)) f.subSampleMask.at(x, y) |= 1u << k;
                }
            }
        }
    });
    if (passes_.has(Pass::segments))
        for (const Placed& shape : atRest) addSegments(shape, unmoved, f.segments);
    f.albedoLinear = f.colorLinear;  // nothing is lit
    f.colorLinear.fillBorder();
    f.albedoLinear.fillBorder();
    f.normalWorld.fillBorder();
    for (PlaneF* p : {&f.depthView, &f.motionXPx, &f.motionYPx, &f.edgeXPx, &f.edgeYPx}) p->fillBorder();
    f.objectId.fillBorder();
    f.subSampleMask.fillBorder();
    for (SubSample& s : f.subSamples) {
        s.depthView.fillBorder();
        s.normalWorld.fillBorder();
        s.objectId.fillBorder();
        if (!s.colorLinear.empty()) s.colorLinear.fillBorder();
    }
    return f;
}

Truth SynthShot::truth(size_t index) const {
    Truth t{Rgb(manifest_.width, manifest_.height), {}};
    if (scene_->contents.zonePlate) {
        t.b = t.a;
        zonePlateTruth(0, t.a);
        zonePlateTruth(1, t.b);
    } else {
        areaTruth(placedAt(shapes(), double(index)), scene_->contents.backgroundColor, t.a);
        t.b = t.a;
    }
    t.a.fillBorder();
    t.b.fillBorder();
    return t;
}

Manifest writeSynth(const SynthOptions& options, const std::filesystem::path& folder,
                    const std::function<bool(const FrameEntry&)>& goOn) {
    const SynthShot shot(options);
    Manifest m = shot.manifest();
    m.folder = folder;
    const PassSet wanted = options.wanted.value_or(shot.passes()),
                  centreWanted = options.centreWanted.value_or(shot.passes());
    for (const PassSet& p : {wanted, centreWanted})
        if (const auto missing = names(p.without(shot.passes())); !missing.empty())
            throw UsageError("synth: scene " + m.name + " has no pass '" + std::string(missing[0]) +
                             "'; choose another scene");
    if (const auto at = options.nanPixel; at && !(at->x >= 0 && at->y >= 0 && at->x < m.width && at->y < m.height))
        throw UsageError("synth: the pixel for the NaN lies outside of the picture");
    makeWritableFolder(folder / "frames");
    makeWritableFolder(folder / "truth");
    if (!m.frames[0].centre.empty()) makeWritableFolder(folder / "centre");
    // An older manifest would describe the files that now change; the new one comes last.
    std::filesystem::remove(folder / "shot.json");
    const auto write = [&](const std::string& file, Frame frame, PassSet passes) {
        frame.passes = passes;
        if (options.nanPixel)
            for (auto& plane : frame.colorLinear.c) plane.at(options.nanPixel->x, options.nanPixel->y) = NAN;
        writeFrame(folder / file, frame, !m.isStatic);
    };
    for (size_t i = 0; i < m.frames.size(); i++) {
        const bool shared = m.isStatic && i > 0;
        write(m.frames[i].file, shot.frame(i), wanted);
        if (!m.frames[i].centre.empty() && !shared)
            write(m.frames[i].centre, shot.frame(i, Sampling::centre), centreWanted);
        if (!shared) writeTruth(folder / m.frames[i].truth, shot.truth(i));
        if (goOn && !goOn(m.frames[i])) m.frames.resize(i + 1);
    }
    writeManifest(m);
    return m;
}

}  // namespace aa
