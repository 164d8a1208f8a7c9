// `gate`: what got worse from one run to another.
#include "study/gate.h"

#include <cstdio>
#include <filesystem>
#include <iostream>

#include "cli/cli.h"
#include "cli/one_line.h"
#include "image/error.h"
#include "image/io.h"

namespace aa {
namespace {
struct GateArguments {
    std::string base, now, junit;
    std::vector<std::string> tolerances;
    bool allowMissing = false, json = false, all = false;
};

void print(const GateReport& report, bool all) {
    const auto shown = [&](Verdict v) { return all || (v != Verdict::same && v != Verdict::within); };
    size_t width = 0;
    for (const GateRow& r : report.rows)
        if (shown(r.verdict)) width = std::max(width, r.method.size());
    // What fails stands first, and below it all that only needs to be known.
    for (const Verdict v : {Verdict::worse, Verdict::missing, Verdict::unresolved, Verdict::better, Verdict::added,
                            Verdict::within, Verdict::same})
        for (auto r = report.rows.begin(); r != report.rows.end(); ++r) {
            if (r->verdict != v || !shown(v)) continue;
            std::printf("%-10s %-*s  %s\n", name(v), int(width), onOneLine(r->method).c_str(), r->inWords().c_str());
            const bool more = std::any_of(r + 1, report.rows.end(), [&](const GateRow& other) {
                return other.verdict == v && other.method == r->method;
            });
            if (v == Verdict::worse && !more && !r->rerun.empty())
                std::printf("%-10s again: %s\n", "", onOneLine(r->rerun).c_str());
        }
    for (const auto& note : report.notes) std::printf("note: %s\n", onOneLine(note).c_str());
    std::printf("%s: %s, %zu rows: %zu worse, %zu missing, %zu unresolved, %zu better, %zu as before, %zu new\n",
                report.passed() ? "passed" : "FAILED", onOneLine(report.shot).c_str(), report.rows.size(),
                report.count(Verdict::worse), report.count(Verdict::missing), report.count(Verdict::unresolved),
                report.count(Verdict::better), report.count(Verdict::same) + report.count(Verdict::within),
                report.count(Verdict::added));
}

void execute(const GateArguments& o, Context& context) {
    GateOptions options;
    options.allowMissing = o.allowMissing;
    for (const auto& text : o.tolerances) addTolerance(options, text);
    const GateReport report = gate(readResults(o.base), readResults(o.now), options);
    if (!o.junit.empty()) writeText(o.junit, toJunitText(report));
    if (o.json)
        std::cout << toJsonText(report);
    else
        print(report, o.all);
    if (!report.passed()) context.exitCode = 1;
}
}  // namespace

void addGate(CommandLine& line, Context& context) {
    auto o = std::make_shared<GateArguments>();
    Command c = line.command("gate", "Exit 1 when a run is worse than an earlier one of the same methods and frames");
    c.option("BASE", o->base, "the earlier run: its folder, or its results.json under any name")
        .required()
        .typeName("RUN");
    c.option("NEW", o->now, "the run that is judged").required().typeName("RUN");
    c.option("--tol", o->tolerances,
             "comma-separated FIGURE=NUMBER or FIGURE=NUMBER%: how much worse a figure may get. A row fails when it is "
             "worse by more, and by more than its 95 % interval. Without it:" +
                 listOfTolerances())
        .separatedBy(',');
    c.flag("--allow-missing", o->allowMissing, "methods and figures that NEW lacks are named and do not fail");
    c.option("--junit", o->junit, "also write this JUnit file: a suite per method, a case per figure").typeName("FILE");
    c.flag("--all", o->all, "print every row, not only what changed");
    c.flag("--json", o->json, "as JSON");
    c.run([o, &context] { execute(*o, context); });
}

}  // namespace aa
