#include "shot/synth/synth.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <tuple>

#include "cli/choose.h"
#include "cli/cli.h"
#include "cli/progress.h"
#include "image/error.h"
#include "image/folder_claim.h"
#include "methods/method.h"
#include "methods/spec.h"
#include "shot/manifest.h"
#include "shot/patterns.h"

namespace aa {
namespace {
struct SynthArguments {
    SynthOptions synth;
    std::string out;
    std::vector<std::string> methods;
    std::vector<int> nanPixel;
    std::string size = "480x270", jitterProjection = "post";
    int threads = 0;
    bool quiet = false, list = false;
};

void printScenes() {
    for (const auto& s : synthScenes())
        std::printf("%-12s %s\n", std::string(s.name).c_str(), std::string(s.meaning).c_str());
    std::puts("\njitter sequences:");
    for (const auto& s : jitterSequences())
        std::printf("%-16s %s\n", std::string(s.name).c_str(), std::string(s.meaning).c_str());
}

// The first sub-sample pattern that serves all of them.
std::string patternFor(const std::vector<MethodSpec>& jittered, const std::vector<MethodSpec>& centre) {
    std::vector<std::string_view> common;
    for (const auto* methods : {&jittered, &centre})
        for (const auto& m : *methods) {
            const auto& own = m.method->patterns;
            if (own.empty()) continue;
            if (common.empty()) common = own;
            std::erase_if(common, [&](auto p) { return std::find(own.begin(), own.end(), p) == own.end(); });
            if (common.empty())
                throw UsageError("synth: no sub-sample pattern serves '" + m.text +
                                 "' and the methods before it; make two shots");
        }
    return std::string(common.empty() ? "d3d8" : common[0]);
}

// The passes that these methods read, from jittered and from centre-sampled frames.
void planFor(const std::vector<std::string>& methods, SynthOptions& o) {
    std::vector<MethodSpec> jittered, centre;
    for (const MethodSpec& spec : chosen(methods)) {
        (spec.method->sampling() == Sampling::centre && o.jitter != "none" ? centre : jittered).push_back(spec);
    }
    o.wanted = passesOf(jittered) | Pass::color;
    o.centreWanted = passesOf(centre);
    const PassSet all = *o.wanted | *o.centreWanted;
    const bool colour = all.has(Pass::subsampleColor);
    if ((colour || all.hasAnyOf(Pass::subsamples)) && o.subsamples.empty()) o.subsamples = patternFor(jittered, centre);
    o.subsampleColor = o.subsampleColor || colour;
}

// What a run or another program made is not written over; an earlier shot of synth is.
void requireNobodyElses(const std::filesystem::path& out) {
    const auto refuse = [&](const std::string& holds) {
        throw UsageError("synth: " + out.string() + " holds " + holds + "; choose another folder, or delete this one");
    };
    std::error_code ignored;
    if (std::filesystem::exists(out / "results.json", ignored)) refuse("the results of a run");
    if (!std::filesystem::exists(out / "shot.json", ignored)) return;
    try {
        const Manifest before = readManifest(out);
        if (before.extra.value("/producer/name"_json_pointer, "") == kSynthProducer) return;
    } catch (const InputError&) {  // nobody knows whose
    }
    refuse("a shot that synth did not make");
}

int synth(SynthArguments& o) {
    if (o.list) return printScenes(), 0;
    if (o.synth.scene.empty() || o.out.empty())
        throw UsageError("synth: expected NAME -o SHOT; `aaresolve synth --list` shows the names");
    std::tie(o.synth.width, o.synth.height) = sizeOf("--size", o.size);
    if (!o.nanPixel.empty()) o.synth.nanPixel = glm::ivec2(o.nanPixel[0], o.nanPixel[1]);
    o.synth.premultiplied = o.jitterProjection == "pre";
    if (!o.methods.empty()) planFor(o.methods, o.synth);
    requireNobodyElses(o.out);
    const FolderClaim claim(o.out);
    Manifest m;
    bool stopped = false;
    withThreads(o.threads, [&] {
        TerminalProgress progress("synth " + o.synth.scene, size_t(std::max(o.synth.frames, 1)), o.quiet);
        m = writeSynth(o.synth, o.out, [&](const FrameEntry& f) {
            progress.step("frame " + std::to_string(f.frame));
            stopped = progress.interrupted();
            return !stopped;
        });
    });
    std::printf("%s: %zu frames of %s, %dx%d, jitter %s%s, %s -> %s\n", stopped ? "stopped" : "done", m.frames.size(),
                m.name.c_str(), m.width, m.height, m.jitterSequence.c_str(),
                m.jitterPremultiplied ? " (labelled variant: premultiplied)" : "", m.isStatic ? "static" : "moving",
                o.out.c_str());
    return stopped ? 130 : 0;
}
}  // namespace

void addSynth(CommandLine& line, Context& context) {
    auto o = std::make_shared<SynthArguments>();
    o->synth.scene.clear();
    Command c = line.command("synth", "Analytic shots with exact truth, without Blender");
    c.option("NAME", o->synth.scene, "scene; --list shows them").typeName("SCENE");
    c.option("-o,--out", o->out, "folder of the shot").typeName("FOLDER");
    c.option("--size", o->size, "width and height, px").typeName("WxH");
    line.renamed("synth", "--resolution", "--size");
    c.option("--for", o->methods,
             "only the passes that these methods read, methods and sets as for run; all passes without it")
        .typeName("METHOD")
        .oneEach();
    c.option("--frames", o->synth.frames, "number of frames");
    c.option("--jitter", o->synth.jitter, "sequence; `none` samples pixel centres");
    c.option("--start", o->synth.jitterStart, "index of the first point of halton23; -1 = its own")
        .range(-1, std::numeric_limits<int>::max());
    c.option("--period", o->synth.period, "frames after which the jitter repeats").range(1, 1 << 20);
    c.flag("--centre", o->synth.centred, "subtract the mean of one period from the jitter");
    c.option("--jitter-projection", o->jitterProjection,
             "post: samples move by the jitter; pre: labelled variant, the error of the T2MSAA/ASAA thesis, they "
             "move by jitter x focal length / depth (perspective scenes)")
        .oneOf({"post", "pre"});
    c.option("--subsamples", o->synth.subsamples,
             "pattern: d3d1, d3d2, d3d4, d3d8, d3d16, quincunx, grid1..grid8; empty = none");
    c.flag("--subsample-color", o->synth.subsampleColor, "colour at the sub-samples, too");
    c.option("--inject-nan", o->nanPixel, "x and y of a NaN in the colour of every frame").values(2, 2);
    c.option("--seed", o->synth.seed, "of the colours");
    c.option("--angle", o->synth.angleDegrees, "scene half_plane: direction of the edge's normal, degrees")
        .range(-360.0, 360.0);
    c.option("--offset", o->synth.offsetPx, "scene half_plane: distance of the edge from the middle, px")
        .range(-1e5, 1e5);
    c.option("-j,--threads", o->threads, "threads; 0 = all processors").range(0, 1024);
    c.flag("-q,--quiet", o->quiet, "no progress");
    c.flag("--list", o->list, "names of the scenes and jitter sequences");
    c.run([o, &context] { context.exitCode = synth(*o); });
}

}  // namespace aa
