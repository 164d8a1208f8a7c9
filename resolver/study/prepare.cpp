#include "study/prepare.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "gpu/method.h"
#include "image/error.h"
#include "image/io.h"
#include "methods/spec.h"
#include "metrics/temporal.h"
#include "study/external.h"

namespace aa {
namespace {

// All of `asked`, or nothing: the figures along the motion need every one of them.
PassSet passesThatAreThere(PassSet asked, PassSet offered) {
    return asked.without(offered).empty() ? asked : PassSet{};
}
std::string listed(PassSet passes) {
    std::string text;
    for (const auto name : names(passes)) text += (text.empty() ? "" : ", ") + std::string(name);
    return text;
}
}  // namespace

std::vector<std::pair<int, int>> frameRanges(const std::string& list) {
    std::vector<std::pair<int, int>> ranges;
    std::istringstream parts(list);
    for (std::string part; std::getline(parts, part, ',');) {
        int first = 0, last = 0;
        const char* end = part.data() + part.size();
        auto [p, failed] = std::from_chars(part.data(), end, first);
        last = first;
        const std::string_view rest(p, size_t(end - p));
        if (failed == std::errc{} && !rest.empty() && (rest[0] == '-' || rest.starts_with(".."))) {
            const auto second = std::from_chars(p + (rest[0] == '-' ? 1 : 2), end, last);
            p = second.ptr;
            failed = second.ec;
        }
        if (failed != std::errc{} || p != end || last < first)
            throw UsageError("--frames: expected numbers and ranges like 1-16,20, found '" + part + "'");
        ranges.emplace_back(first, last);
    }
    return ranges;
}

std::vector<size_t> selectFrames(const Manifest& manifest, const std::string& list) {
    std::vector<size_t> chosen;
    if (list.empty()) {
        for (size_t i = 0; i < manifest.frames.size(); i++) chosen.push_back(i);
        return chosen;
    }
    std::vector<bool> wanted(manifest.frames.size());
    for (const auto& [first, last] : frameRanges(list)) {
        size_t found = 0;
        for (size_t i = 0; i < manifest.frames.size(); i++)
            if (manifest.frames[i].frame >= first && manifest.frames[i].frame <= last) wanted[i] = true, found++;
        if (found == 0)
            throw InputError("--frames " + std::to_string(first) + (last > first ? "-" + std::to_string(last) : "") +
                             ": the shot has no such frame (it has " + std::to_string(manifest.frames.front().frame) +
                             " to " + std::to_string(manifest.frames.back().frame) + ")");
    }
    for (size_t i = 0; i < wanted.size(); i++)
        if (wanted[i]) chosen.push_back(i);
    return chosen;
}

void requirePasses(const ShotReader& shot, const std::vector<MethodSpec>& methods) {
    const PassSet jittered = shot.offered();
    const PassSet centre = shot.hasCentreFrames() ? shot.offered(Sampling::centre) : jittered;
    std::string first, unserved;
    for (const auto& m : methods) {
        const bool atCentres = shot.hasCentreFrames() && m.method->sampling() == Sampling::centre;
        const PassSet lacking = m.passes().without(atCentres ? centre : jittered);
        if (names(lacking).empty()) continue;
        unserved += (unserved.empty() ? "" : ",") + withoutStages(m.text);
        if (!first.empty()) continue;
        // What the shot has of jittered frames is no help to a method that reads the pixel centres.
        first = "method '" + m.text + "' reads the " + (atCentres ? "pictures at the pixel centres" : "frames") +
                ", which lack " + listed(lacking);
    }
    if (!first.empty())
        throw InputError(shot.manifest().folder.string() + ": " + first + "; export with --for " + unserved +
                         ", which adds to a shot of the add-on what it lacks");
}

std::vector<std::string> applyHistory(RunOptions& o, const Manifest& manifest) {
    if (o.protocol.history == History::full && !manifest.isStatic)
        throw UsageError("--history full: '" + manifest.name +
                         "' moves, and only the frames of a static shot can be repeated; choose first or ramp");
    std::vector<std::string> without;
    if (o.protocol.history != History::ramp) return without;
    for (auto& spec : o.methods) {
        const auto& table = spec.method->params;
        const auto named = [](const auto& p) { return p.first == "warmup"; };
        if (std::none_of(table.begin(), table.end(), [](const auto& p) { return p.name == "warmup"; })) {
            if (spec.method->temporal && !isExternal(spec)) without.push_back(spec.text);
        } else if (std::none_of(spec.given.begin(), spec.given.end(), named)) {
            spec.given.emplace_back("warmup", "ramp");
        }
    }
    return without;
}

void judgeAgainst(RunOptions& o, const std::string& method) {
    const auto external = std::find_if(o.methods.begin(), o.methods.end(),
                                       [&](const auto& m) { return isExternal(m) && m.text == method; });
    const MethodSpec reference = external == o.methods.end() ? parseMethod(method) : *external;
    const auto same = std::find_if(o.methods.begin(), o.methods.end(),
                                   [&](const auto& m) { return m.folderName() == reference.folderName(); });
    o.protocol.reference = same == o.methods.end() ? reference.text : same->text;
    if (same == o.methods.end()) o.methods.push_back(reference);
    if (o.methods.size() < 2)
        throw UsageError("--reference " + method + ": no other method is there to be judged against it; add one by -m");
}

void requireSequence(const RunOptions& o, const Manifest& manifest) {
    const std::vector<const Metric*> watching = watchingMetrics(o);
    if (watching.empty()) return;
    const std::string metric = "--metrics " + std::string(watching.front()->figures[0].name);
    if (o.measure.viewing.display->isHdr && o.protocol.display.transfer == Transfer::identity)
        throw UsageError(metric + " --metric-display " + std::string(o.measure.viewing.display->name) +
                         ": it is fed linear light, which --display identity has none of");
    if (!o.protocol.reference.empty()) return;
    for (const size_t i : o.frames)
        if (manifest.frames[i].truth.empty())
            throw UsageError(metric + ": it watches the whole sequence, and frame " +
                             std::to_string(manifest.frames[i].frame) +
                             " has no truth; choose frames that have one by --frames, or judge by --reference METHOD");
}

InputPlan planInput(const ShotReader& shot, const RunOptions& o) {
    InputPlan plan;
    plan.split = shot.hasCentreFrames();
    plan.jittered = plan.split ? passesOf(o.every(), Sampling::jittered) : passesOf(o.every());
    if (plan.split) plan.centre = passesOf(o.every(), Sampling::centre);
    const auto accumulates = [](const MethodSpec& m) { return m.method->sampling() == Sampling::jittered; };
    plan.overTime = o.frames.size() > 1 && std::any_of(o.every().begin(), o.every().end(), accumulates);
    if (plan.overTime) plan.jittered |= Pass::color;
    if (plan.overTime && !shot.manifest().isStatic)
        plan.jittered |= passesThatAreThere(temporalMetricPasses(), shot.offered());
    return plan;
}

std::optional<std::filesystem::path> firstBelow(const std::filesystem::path& folder, const std::filesystem::path& p) {
    const std::filesystem::path below = p.lexically_relative(folder);
    if (below.empty() || *below.begin() == "..") return {};
    return *below.begin();
}

void requireOwnFolder(const RunOptions& o, const Manifest& m) {
    namespace fs = std::filesystem;
    const auto refuse = [&](const std::string& why) {
        throw UsageError("--out: " + o.out.string() + " " + why + "; give the run a folder of its own");
    };
    std::error_code ignored;
    if (fs::exists(o.out / "shot.json", ignored)) refuse("holds a shot");
    std::set<fs::path> ofFrames;
    for (const FrameEntry& f : m.frames)
        for (const std::string& file : {f.file, f.centre, f.truth})
            if (!file.empty()) ofFrames.insert((m.folder / file).parent_path());
    std::set<fs::path> written = {"truth", "maps"};
    for (const MethodSpec& spec : o.methods) written.insert(spec.folderName());
    const fs::path out = fs::weakly_canonical(o.out);
    for (const fs::path& folder : ofFrames) {
        const fs::path frames = fs::weakly_canonical(folder);
        if (firstBelow(frames, out)) refuse("lies where the shot keeps its frames");
        if (const auto first = firstBelow(out, frames); first && written.contains(*first))
            refuse("would write over the shot's " + folder.string());
    }
}

std::vector<RunningMethod> startMethods(const ShotReader& shot, const RunOptions& o) {
    requirePasses(shot, o.methods);
    std::vector<RunningMethod> methods;
    for (const auto& spec : o.methods) {
        const ShotInfo info = shotInfo(shot.manifest());
        methods.emplace_back(spec, o.device && !o.timeOnly && !isExternal(spec) ? gpu::create(*o.device, spec, info)
                                                                                : spec.create(info));
        methods.back().method->keepDebugLayers = o.debugLayers;
    }
    makeWritableFolder(o.out);
    if (o.device && !o.timeOnly && o.debugLayers)
        throw UsageError("--debug-layers: the shaders keep none; use --device cpu");
    for (const auto& m : methods) makeWritableFolder(o.out / m.spec.folderName());
    if (o.protocol.reference.empty()) makeWritableFolder(o.out / "truth");
    return methods;
}

namespace {
std::string asked(const RunOptions& o) {
    std::string metrics;
    for (const Metric* m : o.measure.metrics)
        metrics += (metrics.empty() ? "metrics=" : ",") + std::string(m->figures[0].name);
    std::string maps;
    for (const MapKind* kind : o.maps) maps += (maps.empty() ? " maps=" : ",") + std::string(kind->name);
    if (!watchingMetrics(o).empty()) {
        char fps[32];
        std::snprintf(fps, sizeof fps, "%g", o.measure.viewing.framesPerSecond);
        maps += " seen=" + std::string(o.measure.viewing.display->name) + "," + fps;
    }
    if (o.measure.flipPixelsPerDegree != kFlipPixelsPerDegree)
        maps += " flipPpd=" + std::to_string(o.measure.flipPixelsPerDegree);
    return metrics + maps + (metrics.empty() && maps.empty() ? "" : " ") + "write=" +
           (o.writeExr && o.writePng ? "exr,png"
            : o.writeExr             ? "exr"
            : o.writePng             ? "png"
                                     : "none") +
           " frames=" + (o.writeAllFrames ? "all" : "truth") + (o.debugLayers ? " layers" : "") +
           (o.dither ? " dither" : "");
}
}  // namespace

RunResults describeRun(const Manifest& m, const RunOptions& o) {
    RunResults r;
    r.shot = m.name;
    r.width = m.width;
    r.height = m.height;
    r.isStatic = m.isStatic;
    r.jitterSequence = m.jitterSequence;
    r.jitterStart = m.jitterStart;
    r.jitterPeriod = m.jitterPeriod;
    const size_t period = std::min(m.frames.size(), size_t(std::max(m.jitterPeriod, 1)));
    for (size_t i = 0; i < period; i++) {
        r.jitterMeanPx[0] += m.frames[i].jitterPx.x / double(period);
        r.jitterMeanPx[1] += m.frames[i].jitterPx.y / double(period);
    }
    r.subSamples = int(m.subsamplePositionsPx.size());
    r.truthSamplesPerHalf = m.truthSamplesPerHalf;
    r.truthFilter = m.truthFilter;
    r.truthFilterWidthPx = m.truthFilterWidthPx;
    r.programVersion = AA_VERSION;
    r.isa = name(o.exec.isa);
    r.precision = o.exec.precision == Precision::fast     ? "fast"
                  : o.exec.precision == Precision::scalar ? "scalar"
                                                          : "double";
    r.provenance = o.provenance;
    if (r.provenance.machine.processor.empty()) r.provenance = provenanceOf({}, {});
    r.provenance.shotPath = std::filesystem::weakly_canonical(m.folder).string();
    r.machine = r.provenance.machine.processor;
    r.shotHash = contentHash(m, o.frames);
    r.framesAsked = o.frames.size();
    r.asked = asked(o);
    if (o.device) {
        const gpu::DeviceInfo& d = o.device->device().info();
        r.device = {d.name, d.kind, d.driver, o.device->fast() ? "fast" : "exact", !o.timeOnly};
    }
    r.threads =
        o.exec.parallel ? int(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)) : 1;
    r.protocol = o.protocol;
    if (!watchingMetrics(o).empty()) {
        const Viewing& v = o.measure.viewing;
        r.shownOn = {std::string(v.display->name), inWords(*v.display), v.display->pixelsPerDegree(),
                     v.framesPerSecond};
    }
    if (o.measure.flipPixelsPerDegree != kFlipPixelsPerDegree) r.flipPixelsPerDegree = o.measure.flipPixelsPerDegree;
    for (const MapKind* kind : o.maps) r.maps.emplace(kind->name, kind->scale);
    std::map<std::string, int> counted;
    for (const auto& f : m.frames)
        for (const auto& [group, seconds] : f.renderSeconds) r.renderSeconds[group] += seconds, counted[group]++;
    for (auto& [group, seconds] : r.renderSeconds) seconds /= counted[group];
    const bool unjittered =
        std::all_of(m.frames.begin(), m.frames.end(), [](const auto& f) { return f.jitterPx == glm::dvec2(0.0); });
    for (const auto& spec : o.methods) {
        MethodResult result;
        result.id = spec.method->id;
        result.text = spec.text;
        result.title = spec.method->title;
        result.family = spec.method->family;
        result.source = spec.method->source;
        result.folder = spec.folderName();
        const bool centre = unjittered || (spec.method->sampling() == Sampling::centre && !m.frames[0].centre.empty());
        result.sampling = centre ? "centre" : "jittered";
        const Params params = spec.params();
        result.parameters.insert(params.all().begin(), params.all().end());
        for (auto n : names(spec.passes())) result.passes.emplace_back(n);
        result.frames.reserve(o.frames.size());
        r.methods.push_back(std::move(result));
    }
    return r;
}

}  // namespace aa
