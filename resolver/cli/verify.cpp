#include "study/verify.h"

#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/choose.h"
#include "cli/cli.h"
#include "cli/progress.h"
#include "image/error.h"
#include "image/json_text.h"
#include "study/prepare.h"
#include "study/runnable.h"

namespace aa {
namespace {

struct VerifyArguments {
    std::string shot, frames;
    std::vector<std::string> methods;
    double limit = 0;
    bool json = false, quiet = false;
    WorkOptions work;
};

void print(const std::vector<VerifyResult>& results, const gpu::Session& session) {
    size_t width = 6;
    for (const auto& r : results) width = std::max(width, r.text.size());
    std::printf("%-*s %10s %10s %11s %9s  %s\n", int(width), "method", "most", "rms", "> 1/255", "not finite", "where");
    for (const auto& r : results)
        std::printf("%-*s %10.2g %10.2g %9.4f %% %9zu  frame %d (%d, %d)\n", int(width), r.text.c_str(), r.most, r.rms,
                    100 * r.shareAboveCode, r.notFinite, r.worstFrame, r.worstX, r.worstY);
    std::printf("%s, %s; differences by max(1, value), in each method's own space\n",
                session.device().info().name.c_str(), session.fast() ? "fast" : "exact");
}
nlohmann::ordered_json json(const std::vector<VerifyResult>& results, const gpu::Session& session,
                            const std::string& shot) {
    nlohmann::ordered_json all;
    all["device"] = session.device().info().name;
    all["deviceKind"] = session.device().info().kind;
    all["driver"] = session.device().info().driver;
    all["precision"] = session.fast() ? "fast" : "exact";
    all["shot"] = shot;
    for (const auto& r : results)
        all["methods"].push_back({{"method", r.text},
                                  {"family", r.family},
                                  {"max", r.most},
                                  {"rms", r.rms},
                                  {"shareAboveCode", r.shareAboveCode},
                                  {"notFinite", r.notFinite},
                                  {"worst", {{"frame", r.worstFrame}, {"x", r.worstX}, {"y", r.worstY}}},
                                  {"maxByFrame", r.mostByFrame},
                                  {"stateBytes", r.stateBytes},
                                  {"deviceStateBytes", r.deviceStateBytes}});
    return all;
}

void execute(const VerifyArguments& o, Context& context) {
    VerifyOptions options;
    if (o.work.device == "cpu") throw UsageError("verify: --device: expected a graphics device, found 'cpu'");
    const auto session = o.work.session();
    if (!o.methods.empty()) options.methods = chosenFor(o.shot, o.methods);
    options.exec = o.work.exec();
    const ShotReader shot(o.shot);
    options.frames = selectFrames(shot.manifest(), o.frames);
    if (options.methods.empty())
        for (const auto& m : registry())
            if (MethodSpec spec = parseMethod(m.id); gpu::hasForm(m.id) && Runnable(shot).whyNot(spec).empty())
                options.methods.push_back(std::move(spec));
    std::vector<VerifyResult> results;
    withThreads(o.work.threads, [&] {
        TerminalProgress progress(shot.manifest().name, options.frames.size(), o.quiet);
        results = verify(shot, options, *session, progress.callbacks());
        if (progress.interrupted()) context.exitCode = 130;
    });
    if (o.json)
        std::cout << jsonText(json(results, *session, shot.manifest().name)) << "\n";
    else
        print(results, *session);
    for (const auto& r : results)
        if (o.limit > 0 && !(r.most <= o.limit && r.notFinite == 0)) context.exitCode = 1;
}
}  // namespace

void addVerify(CommandLine& line, Context& context) {
    auto o = std::make_shared<VerifyArguments>();
    o->work.device = "vulkan";
    Command c = line.command("verify", "Compare the methods' shaders with their kernels on a shot, frame by frame");
    c.option("SHOT", o->shot, "the shot's folder").required().typeName("SHOT");
    addMethodOption(c, o->methods, "a method (default: every one that the shot serves)", true);
    c.option("--frames", o->frames, "frames, as 1-16,20; default all");
    c.option("--limit", o->limit, "exit code 1 where a difference exceeds it; 0: none does").notNegative();
    c.flag("--json", o->json, "print JSON");
    c.flag("-q,--quiet", o->quiet, "no progress");
    addWorkOptions(c, o->work);
    addDeviceOptions(c, o->work);
    c.run([o, &context] { execute(*o, context); });
}

}  // namespace aa
