// The command line: one file per subcommand, each adding itself to the application.
//
// Exit codes: 0 ok, 1 a check failed, a difference was found or the output could not be written, 2 wrong usage, 3 bad
// input. UsageError, InputError and OutputError are caught once, in main.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "cli/command.h"
#include "kernels/table.h"

namespace aa {
namespace gpu {
class Session;
}

struct Context {
    int exitCode = 0;                    // set by a command's callback
    std::vector<std::string> arguments;  // of the program, its name first
};

// Work options shared by every command that computes.
struct WorkOptions {
    int threads = 0;  // 0: all processors
    std::string isa = "auto", precision = "fast";
    std::string device = "cpu", gpuPrecision = "exact", gpuShaders = {};
    bool gpuValidate = false;
    Exec exec() const;  // throws UsageError when this processor lacks the instruction set
    // The graphics device that was asked for, opened; null: none was. Throws UsageError, gpu::DeviceError.
    std::shared_ptr<gpu::Session> session() const;
};
void addWorkOptions(Command& command, WorkOptions& work);
// --device and what goes with it.
void addDeviceOptions(Command& command, WorkOptions& work);
// --non-finite, of every command that reads pictures; `whatSanitiseDoes` is its word in the help.
void addNonFinite(Command& command, std::string& policy, const std::string& whatSanitiseDoes = "replace and count");
// Width and height of an option's "480x270"; one number is a square. Throws UsageError.
std::pair<int, int> sizeOf(const std::string& option, const std::string& text);
// Runs `body` in an arena of the asked number of threads.
void withThreads(int threads, const std::function<void()>& body);

// One line per subcommand here and in main's list.
void addList(CommandLine& line, Context& context);
void addPlan(CommandLine& line, Context& context);
void addRun(CommandLine& line, Context& context);
void addBench(CommandLine& line, Context& context);
void addFilter(CommandLine& line, Context& context);
void addSheet(CommandLine& line, Context& context);
void addCompare(CommandLine& line, Context& context);
void addReport(CommandLine& line, Context& context);
void addLearnRsaa(CommandLine& line, Context& context);
void addSynth(CommandLine& line, Context& context);
void addCheck(CommandLine& line, Context& context);
void addImport(CommandLine& line, Context& context);
void addSweep(CommandLine& line, Context& context);
void addAngles(CommandLine& line, Context& context);
void addDevices(CommandLine& line, Context& context);
void addSurvey(CommandLine& line, Context& context);
void addGate(CommandLine& line, Context& context);
void addVerify(CommandLine& line, Context& context);
void addStability(CommandLine& line, Context& context);
void addHelp(CommandLine& line, Context& context);
void addCompletion(CommandLine& line, Context& context);

}  // namespace aa
