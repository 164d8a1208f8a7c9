#include "shot/check/check.h"

#include <cstdio>
#include <iostream>

#include "cli/cli.h"
#include "cli/one_line.h"
#include "cli/progress.h"
#include "image/json_text.h"
#include "shot/manifest.h"

namespace aa {
namespace {
void print(const CheckReport& r) {
    for (const auto& f : r.findings) std::printf("%s\n", onOneLine(f.line()).c_str());
    for (const auto& m : r.measured) std::printf("  %-32s %.4g\n", m.name.c_str(), m.value);
    for (const auto& v : r.variants) std::printf("  labelled variant: %s\n", v.c_str());
    for (const auto& n : r.notChecked) std::printf("  not checked: %s\n", n.c_str());
    const std::string centre = r.centrePasses.empty() ? "" : "; at the pixel centres: " + listOf(r.centrePasses);
    std::printf("%s: %s; %zu frames; passes: %s%s\n", onOneLine(r.name).c_str(),
                r.clean()
                    ? (r.variants.empty() ? "clean" : "clean as the labelled variant that it is")
                    : (std::to_string(r.findings.size()) + (r.findings.size() == 1 ? " finding" : " findings")).c_str(),
                r.frames, listOf(r.passes).c_str(), centre.c_str());
}
}  // namespace

void addCheck(CommandLine& line, Context& context) {
    struct Options {
        std::string shot;
        bool json = false, quiet = false;
        int threads = 0;
    };
    auto o = std::make_shared<Options>();
    Command c = line.command("check", "Is the shot what its manifest claims? Exit code 1 when something is found");
    c.option("SHOT", o->shot, "folder of the shot").required().typeName("SHOT");
    c.option("-j,--threads", o->threads, "threads; 0 = all processors").range(0, 1024);
    c.flag("--json", o->json, "as JSON");
    c.flag("-q,--quiet", o->quiet, "no progress");
    c.run([o, &context] {
        CheckReport report;
        bool interrupted = false;
        withThreads(o->threads, [&] {
            const size_t frames = readManifest(o->shot).frames.size();
            TerminalProgress progress("check", frames, o->quiet || o->json);
            report = checkShot(o->shot, [&](int frame) {
                progress.step("frame " + std::to_string(frame));
                interrupted = progress.interrupted();
                return !interrupted;
            });
        });
        if (o->json)
            std::cout << jsonText(toJson(report)) << "\n";
        else
            print(report);
        context.exitCode = interrupted ? 130 : report.clean() ? 0 : 1;
    });
}

}  // namespace aa
