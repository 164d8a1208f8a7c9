// `sweep`: every combination of some parameters' values.
#include "study/sweep.h"

#include <algorithm>
#include <cstdio>
#include <iostream>

#include "cli/choose.h"
#include "cli/run_arguments.h"
#include "image/folder_claim.h"
#include "image/io.h"
#include "report/sweep.h"
#include "study/prepare.h"

namespace aa {
namespace {
struct SweepArguments {
    RunArguments run;
    SweepOptions sweep;
};

void execute(const SweepArguments& o, Context& context) {
    RunOptions run;
    SweepOptions sweeping = o.sweep;
    const auto textsOf = [](const std::vector<MethodSpec>& methods) {
        std::vector<std::string> texts;
        for (const auto& m : methods) texts.push_back(m.text);
        return texts;
    };
    sweeping.methods = textsOf(chosenFor(o.run.shot, o.sweep.methods));
    if (o.sweep.with != std::vector<std::string>{"none"}) sweeping.with = textsOf(chosenFor(o.run.shot, o.sweep.with));
    run.methods = variantsOf(sweeping);
    const std::set<std::string> unlike = {"-m", "--method", "-o", "--out", "--vary", "--with", "--memory"};
    run.provenance = provenanceOf(context.arguments, unlike);
    std::vector<std::string> asRun = context.arguments;
    std::replace(asRun.begin(), asRun.end(), std::string("sweep"), std::string("run"));
    run.provenance.rerun = provenanceOf(asRun, unlike).rerun;
    const ShotReader shot = openShot(o.run, run);
    requireOwnFolder(run, shot.manifest());
    const FolderClaim claim(run.out);
    RunResults all;
    size_t passes = 0;
    withThreads(o.run.work.threads, [&] {
        Sweep sweep(shot, run, sweeping);
        passes = sweep.passes();
        TerminalProgress progress("sweep", sweep.steps(), o.run.quiet);
        all = sweep.run(progress.callbacks());
        if (progress.interrupted()) context.exitCode = 130;
    });
    printReplaced(all, run.out);
    const std::filesystem::path page = run.out / "sweep.html";
    writeText(page, sweepHtml(all, sweeping));
    if (o.run.json) {
        std::cout << toJsonText(all) << "\n";
        return;
    }
    printTable(all);
    for (const auto& sentence : sweepWords(all, sweeping)) std::printf("%s\n", sentence.c_str());
    std::printf("%zu variants in %zu pass%s over the frames\nresults: %s\ncurves: %s\n", all.methods.size(), passes,
                passes == 1 ? "" : "es", (run.out / "results.json").c_str(), page.c_str());
}
}  // namespace

void addSweep(CommandLine& line, Context& context) {
    auto o = std::make_shared<SweepArguments>();
    Command c = line.command(
        "sweep", "Run every combination of some parameters' values: the best in words, curves and heat maps");
    addMethodOption(c, o->sweep.methods, "the method, with what stays the same", true).required();
    c.option(
         "--vary", o->sweep.vary,
         "NAME=VALUE,VALUE,...: a parameter and its values, FIRST..LAST:STEP among them, as in 0.8..0.98:0.02; repeat "
         "for more parameters")
        .required()
        .oneEach();
    c.option("--with", o->sweep.with, "methods to compare with, as they are, with commas; none = without")
        .typeName("METHOD");
    c.option("--memory", o->sweep.memoryMb, "MB that all variants may hold at a time; more are run in another pass")
        .range(1.0, 1e7);
    addRunArguments(c, o->run);
    c.run([o, &context] { execute(*o, context); });
}

}  // namespace aa
