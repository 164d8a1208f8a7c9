#include "cli/bench_frames.h"

#include <algorithm>
#include <cmath>

#include "image/error.h"
#include "methods/driver.h"
#include "shot/reader.h"
#include "shot/synth/synth.h"
#include "study/synthetic_frames.h"

namespace aa {
namespace {

Frames shotFrames(const BenchFrames& o, const std::vector<MethodSpec>& methods) {
    const PassSet wanted = passesOf(methods, Sampling::jittered), wantedOfCentre = passesOf(methods, Sampling::centre);
    const ShotReader reader(o.shot, o.policy);
    Frames r;
    r.info = shotInfo(reader.manifest());
    const size_t count = std::min(size_t(o.frames), reader.manifest().frames.size());
    for (size_t i = 0; i < count; i++) {
        if (!wanted.empty()) r.jittered.push_back(reader.read(i, wanted, &r.counts));
        if (wantedOfCentre.empty()) continue;
        r.centre.push_back(reader.hasCentreFrames() ? reader.readCentre(i, wantedOfCentre, &r.counts)
                                                    : reader.read(i, wantedOfCentre, &r.counts));
    }
    return r;
}
Frames synthFrames(const BenchFrames& o, const std::vector<MethodSpec>& methods, const std::string& scene,
                   const std::string& pattern) {
    const PassSet wanted = passesOf(methods, Sampling::jittered), wantedOfCentre = passesOf(methods, Sampling::centre);
    SynthOptions synth;
    synth.scene = scene;
    synth.width = o.width, synth.height = o.height;
    synth.frames = o.frames;
    synth.subsamples = pattern;
    synth.subsampleColor = !pattern.empty() && passesOf(methods).has(Pass::subsampleColor);
    const SynthShot shot(synth);
    synth.jitter = "none";
    const SynthShot still(synth);
    Frames r;
    r.info = shotInfo(shot.manifest());
    r.info.isStatic = true;  // so that accum is timed as well; no method's speed depends on it
    r.scene = scene, r.subsamples = pattern;
    for (size_t i = 0; i < size_t(o.frames); i++) {
        if (!wanted.empty()) r.jittered.push_back(shot.frame(i));
        if (!wantedOfCentre.empty()) r.centre.push_back(still.frame(i));
    }
    return r;
}
// Share of the pixels whose encoded luma differs by 0.1 or more (SMAA's threshold at HIGH) from the pixel to the left
// or above.
double edgeShare(const std::vector<Frame>& frames) {
    double edges = 0, pixels = 0;
    for (const auto& f : frames) {
        if (f.colorEncoded.empty()) continue;  // of a shot of sub-samples alone
        const auto luma = [&](int x, int y) {
            const auto& c = f.colorEncoded.c;
            return 0.2126f * c[0].at(x, y) + 0.7152f * c[1].at(x, y) + 0.0722f * c[2].at(x, y);
        };
        for (int y = 0; y < f.height; y++)
            for (int x = 0; x < f.width; x++, pixels++) {
                const float l = luma(x, y);
                edges += std::abs(l - luma(x - 1, y)) >= 0.1f || std::abs(l - luma(x, y - 1)) >= 0.1f;
            }
    }
    return edges / std::max(pixels, 1.0);
}

}  // namespace

void framesFor(std::optional<Frames>& frames, const BenchFrames& o, const MethodSpec& method,
               const std::vector<MethodSpec>& methods, const Exec& exec) {
    const bool synthetic = o.shot.empty();
    const std::string pattern = synthetic ? subSamplePatternFor(method) : "",
                      scene = synthetic ? synthSceneFor(method, o.scene) : "";
    if (frames && (!synthetic || (frames->subsamples == pattern && frames->scene == scene))) return;
    frames.reset();  // frames with many sub-samples are large: one pattern's are in memory at a time
    frames = synthetic ? synthFrames(o, methods, scene, pattern) : shotFrames(o, methods);
    for (auto* sampled : {&frames->jittered, &frames->centre})
        for (auto& f : *sampled) encodeFrame(f, {}, exec);
    frames->edgeShare = edgeShare(frames->centre.empty() ? frames->jittered : frames->centre);
}

}  // namespace aa
