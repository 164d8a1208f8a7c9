#include "shot/import/import.h"

#include <cstdio>
#include <iostream>
#include <map>

#include "cli/cli.h"
#include "cli/one_line.h"
#include "cli/progress.h"
#include "image/error.h"
#include "image/folder_claim.h"
#include "image/json_text.h"
#include "methods/method.h"
#include "methods/spec.h"
#include "shot/import/engine.h"
#include "shot/import/folder.h"
#include "shot/manifest.h"

namespace aa {
namespace {
struct ImportArguments {
    ImportOptions import;
    std::string from, out, layout, jitter = "none", camera;
    std::vector<std::string> truth;
    std::string truthFilter = "unknown";
    bool json = false, quiet = false;
    int threads = 0;
};

// "29 of 31 temporal, 4 of 12 geometry": what a pass keeps from running, by family; empty when nothing reads it.
std::string familiesThatNeed(Pass pass) {
    std::map<std::string_view, std::pair<int, int>> families;  // methods that need it, all
    for (const auto& m : registry()) {
        auto& [needing, all] = families[m.family];
        needing += parseMethod(m.id).passes().hasAnyOf(pass);
        all++;
    }
    std::string s;
    for (const auto& [family, count] : families)
        if (count.first > 0)
            s += (s.empty() ? "" : ", ") + std::to_string(count.first) + " of " + std::to_string(count.second) + " " +
                 std::string(family);
    return s;
}

void print(const ImportReport& r, const ImportArguments& o) {
    for (const auto& m : r.missing) {
        const std::string families = familiesThatNeed(m.pass);
        std::printf("no %s (%s): %s\n", std::string(name(m.pass)).c_str(), m.advice.c_str(),
                    families.empty() ? "no method needs it by default" : (families + " methods will not run").c_str());
    }
    for (const auto& n : r.notes) std::printf("note: %s\n", onOneLine(n).c_str());
    const Manifest& m = r.manifest;
    std::printf("%s: %zu frames of %s, %dx%d, %s, passes: %s (%zu imported, %zu kept) -> %s\n",
                r.complete ? "done" : "stopped", m.frames.size(), onOneLine(m.name).c_str(), m.width, m.height,
                m.isStatic ? "static" : "moving", listOf(r.passes).c_str(), r.imported, r.kept, o.out.c_str());
}
nlohmann::ordered_json toJson(const ImportReport& r) {
    nlohmann::ordered_json j = {{"shot", r.manifest.name},   {"frames", r.manifest.frames.size()},
                                {"imported", r.imported},    {"kept", r.kept},
                                {"complete", r.complete},    {"static", r.manifest.isStatic},
                                {"passes", names(r.passes)}, {"missing", nlohmann::ordered_json::array()},
                                {"notes", r.notes},          {"warnings", r.warnings}};
    for (const auto& m : r.missing)
        j["missing"].push_back({{"pass", name(m.pass)}, {"advice", m.advice}, {"needed_by", familiesThatNeed(m.pass)}});
    return j;
}

int import(ImportArguments& o) {
    o.import.from = o.from;
    o.import.out = o.out;
    o.import.jitter = o.jitter == "none" ? "" : o.jitter;
    o.import.camera = o.camera;
    o.import.truth.assign(o.truth.begin(), o.truth.end());
    const size_t colon = o.truthFilter.find(':');
    o.import.truthFilter = o.truthFilter.substr(0, colon);
    if (colon != std::string::npos) {
        char* end = nullptr;
        o.import.truthFilterWidthPx = std::strtod(o.truthFilter.c_str() + colon + 1, &end);
        if (*end || !(o.import.truthFilterWidthPx > 0 && kTruthFilterWidthPx.contains(o.import.truthFilterWidthPx)))
            throw UsageError("--truth-filter: expected NAME:WIDTH with a width in px, found '" + o.truthFilter + "'");
    }
    const FolderClaim claim(o.import.out);
    ImportReport report;
    bool interrupted = false;
    const EngineImportOptions engine{o.from, o.layout, o.out, o.import.name};
    withThreads(o.threads, [&] {
        const size_t files = o.layout.empty() ? renderedFrames(o.import.from).size() : engineFrames(engine);
        TerminalProgress progress("import", files, o.quiet);
        const auto goOn = [&](int frame) {
            progress.step("frame " + std::to_string(frame));
            interrupted = progress.interrupted();
            return !interrupted;
        };
        report = o.layout.empty() ? importBlender(o.import, goOn) : importEngine(engine, goOn);
    });
    for (const auto& w : report.warnings) std::fprintf(stderr, "warning: %s\n", onOneLine(w).c_str());
    if (o.json)
        std::cout << jsonText(toJson(report)) << "\n";
    else
        print(report, o);
    return interrupted ? 130 : 0;
}
}  // namespace

void addImport(CommandLine& line, Context& context) {
    auto o = std::make_shared<ImportArguments>();
    Command c =
        line.command("import", "A folder of Blender's own multilayer EXRs, or of an engine's frames, to a shot");
    c.option("DIR", o->from,
             "folder of rendered frames: OpenEXR MultiLayer, the last number of a name is its frame; or what --layout "
             "describes")
        .required()
        .typeName("FOLDER");
    c.option("-o,--out", o->out, "folder of the shot; an interrupted import goes on there")
        .required()
        .typeName("FOLDER");
    c.option("--view-layer", o->import.viewLayer, "which view layer, where there are several");
    c.option("--view", o->import.view, "which view of a multi-view render (stereo, sub-samples)");
    c.option("--truth", o->truth,
             "one or two folders of the same frames rendered with many samples: independent halves, of which the "
             "second gives the error bar")
        .values(1, 2);
    c.option("--truth-filter", o->truthFilter,
             "pixel filter of the truth, NAME:WIDTH in px; Blender does not record it (box:1 is ideal)");
    c.option("--jitter", o->jitter,
             "JSON with the jitter of every frame, {\"frames\": [{\"frame\": 1, \"jitter\": [x, y]}]}, px, y down; "
             "a shot.json serves; none = samples at the pixel centres");
    c.option("--camera", o->camera,
             "JSON with the matrices of every frame, as in shot.json: background motion and zooms need them");
    c.option("--ids", o->import.ids, "object ids: from the pass index, Cryptomatte, or the better of them")
        .oneOf({"auto", "index", "cryptomatte"});
    c.flag("--static", o->import.isStatic, "camera and objects rest; without it, the pixels tell");
    c.option("--fps", o->import.fps, "frames per second").range(kFps.min, kFps.max);
    Option layout = c.option("--layout", o->layout,
                             "JSON that says how an engine writes its frames: files, channels, units and signs "
                             "(docs/format.md); it takes the place of all options but --name");
    layout.typeName("FILE");
    for (const char* other :
         {"--view-layer", "--view", "--truth", "--truth-filter", "--jitter", "--camera", "--ids", "--static", "--fps"})
        layout.excludes(other);
    c.option("--name", o->import.name, "of the shot; default the folder's, or the layout's");
    c.option("-j,--threads", o->threads, "threads; 0 = all processors").range(0, 1024);
    c.flag("--json", o->json, "the summary as JSON");
    c.flag("-q,--quiet", o->quiet, "no progress");
    c.run([o, &context] { context.exitCode = import(*o); });
}

}  // namespace aa
