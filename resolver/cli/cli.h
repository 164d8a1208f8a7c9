// The command line: one file per subcommand, each adding itself to the application.
//
// Exit codes: 0 ok, 1 a check failed or a difference was found, 2 wrong usage, 3 bad input. UsageError and InputError
// are caught once, in main.
#pragma once
#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "kernels/dispatch.h"

namespace aa {

struct Context {
    int exitCode = 0;  // set by a command's callback
};

// Work options shared by every command that computes.
struct WorkOptions {
    int threads = 0;  // 0: all processors
    std::string isa = "auto", precision = "fast";
    Exec exec() const;  // throws UsageError when this processor lacks the instruction set
};
void addWorkOptions(CLI::App& command, WorkOptions& work);
// Runs `body` in an arena of the asked number of threads.
void withThreads(int threads, const std::function<void()>& body);

// One line per subcommand here and in main's list.
void addList(CLI::App& app, Context& context);
void addPlan(CLI::App& app, Context& context);
void addRun(CLI::App& app, Context& context);
void addBench(CLI::App& app, Context& context);
void addFilter(CLI::App& app, Context& context);
void addSheet(CLI::App& app, Context& context);
void addCompare(CLI::App& app, Context& context);
void addReport(CLI::App& app, Context& context);
void addLearnRsaa(CLI::App& app, Context& context);
void addSynth(CLI::App& app, Context& context);
void addCheck(CLI::App& app, Context& context);
void addImport(CLI::App& app, Context& context);
void addSweep(CLI::App& app, Context& context);
void addAngles(CLI::App& app, Context& context);

}  // namespace aa
