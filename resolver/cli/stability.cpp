#include "study/stability.h"

#include <cstdio>
#include <iostream>

#include "cli/choose.h"
#include "cli/cli.h"
#include "cli/progress.h"
#include "gpu/method.h"
#include "image/error.h"
#include "image/inputs.h"
#include "image/io.h"

namespace aa {
namespace {

struct StabilityArguments {
    StabilityOptions study;
    std::string size = std::to_string(study.width) + "x" + std::to_string(study.height);
    std::string shot, out, device = "auto", nonFinite = "sanitise";
    std::vector<std::string> methods = {"all"};
    int threads = 0;
    bool json = false, markdown = false, quiet = false;
};

// The two forms of the shaders on one device, which must live as long as the study.
struct Sessions {
    std::unique_ptr<gpu::Session> exact, fast;
};
Sessions sessionsOn(const std::string& device) {
    const auto session = [&](gpu::Precision p) {
        return std::make_unique<gpu::Session>(gpu::Settings{.device = device, .precision = p});
    };
    return {session(gpu::Precision::exact), session(gpu::Precision::fast)};
}
// auto: whatever device there is, software too; without one the study says so and goes on.
Sessions sessionsFor(const StabilityArguments& o, std::string& whyNone) {
    if (o.device == "cpu") {
        whyNone = "--device cpu";
        return {};
    }
    if (o.device != "auto") return sessionsOn(o.device);
    try {
        return sessionsOn("vulkan");
    } catch (const gpu::DeviceError& e) {
        whyNone = e.what();
        return {};
    }
}

// Into the folder, except over a whole study where this one is not. Its file; empty: not written.
std::filesystem::path written(const StabilityResults& results, const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / "stability.json";
    if (!results.complete && holdsCompleteStability(file)) {
        std::fprintf(stderr, "%s: kept, for this study was interrupted and that one is complete\n", file.c_str());
        return {};
    }
    mayBeReplaced(file);
    writeText(file, toJsonText(results));
    return file;
}

void execute(StabilityArguments& o, Context& context) {
    if (o.json && o.markdown) throw UsageError("--json and --markdown: only one of them");
    StabilityOptions& s = o.study;
    s.shot = o.shot;
    s.policy = inputPolicyByName(o.nonFinite);
    // `all` of a shot means all that it serves.
    if (!o.shot.empty() && o.methods == StabilityArguments{}.methods) o.methods = {"runnable"};
    s.methods = o.shot.empty() ? chosen(o.methods) : chosenFor(o.shot, o.methods);
    std::tie(s.width, s.height) = sizeOf("--size", o.size);
    s.exec.parallel = o.threads != 1;
    if (!o.out.empty()) makeWritableFolder(o.out);  // before the minutes that the study takes
    const Sessions sessions = sessionsFor(o, s.noDevice);
    s.exact = sessions.exact.get(), s.fast = sessions.fast.get();
    StabilityResults results;
    bool interrupted = false;
    withThreads(o.threads, [&] {
        TerminalProgress progress("stability", s.methods.size(), o.quiet);
        results = measureStability(s, progress.callbacks());
        interrupted = progress.interrupted();
    });
    if (interrupted) context.exitCode = 130;
    const std::filesystem::path file = o.out.empty() ? "" : written(results, o.out);
    const std::string text = o.json ? toJsonText(results) : o.markdown ? toMarkdown(results) : toText(results);
    std::fwrite(text.data(), 1, text.size(), stdout);
    if (!o.json && !o.markdown && !file.empty()) std::printf("results: %s\n", file.c_str());
}
}  // namespace

void addStability(CommandLine& line, Context& context) {
    auto o = std::make_shared<StabilityArguments>();
    Command c = line.command("stability",
                             "The accuracy that speed costs: float, narrow histories and shaders against double, "
                             "small changes, long sequences, bright pixels");
    c.option("SHOT", o->shot, "measure errors and small changes on this shot's frames instead of synthetic ones")
        .typeName("SHOT");
    addMethodOption(c, o->methods, "a method (default: all, of a shot all that it serves)", true);
    c.option("-o,--out", o->out, "folder for stability.json; in that of a run, its report shows it, too")
        .typeName("FOLDER");
    c.option("--size", o->size, "size of the synthetic frames, px").typeName("WxH").excludes("SHOT");
    c.option("--frames", o->study.frames, "frames in motion, for methods that keep a history").range(2, 1024);
    c.option("--long-frames", o->study.longFrames, "frames at rest: drift, recovery").range(128, 1000000);
    c.option("--seed", o->study.seed, "of the synthetic frames' colours and grain, and of all chance");
    c.option("--device", o->device,
             "where shaders run: auto = a graphics device if there is one, software too; cpu = leave them out; vulkan, "
             "vulkan:NUMBER or vulkan:NAME (`aaresolve devices`)");
    c.flag("--json", o->json, "print stability.json instead of the tables");
    c.flag("--markdown", o->markdown, "print the page docs/results/stability.md instead of the tables");
    c.flag("-q,--quiet", o->quiet, "no progress");
    c.option("-j,--threads", o->threads, "threads; 0 = all processors").range(0, 1024);
    addNonFinite(c, o->nonFinite);
    c.run([o, &context] { execute(*o, context); });
}

}  // namespace aa
