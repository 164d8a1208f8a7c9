#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <system_error>

#include "cli/cli.h"
#include "cli/completion.h"
#include "cli/one_line.h"
#include "image/inputs.h"
#include "image/output_error.h"

namespace {
// What was printed may still lie in a buffer, or have been refused on the way: a full disk, a closed pipe.
void flushOutput() {
    errno = 0;
    std::cout.flush();
    if (std::fflush(stdout) == 0 && !std::ferror(stdout) && std::cout) return;
    const std::string why = errno ? " (" + std::generic_category().message(errno) + ")" : "";  // 0: it failed before
    throw aa::OutputError("standard output cannot be written" + why + "; check free disk space, or where a pipe ends");
}
}  // namespace

int main(int argc, char** argv) {
    aa::CommandLine line(
        "aaresolve: runs every anti-aliasing method on a shot and measures it against ground truth.\n"
        "Exit codes: 0 ok, 1 a check failed, a difference was found or the output could not be written, 2 wrong usage, "
        "3 bad input.",
        AA_VERSION);
    aa::Context context{.exitCode = 0, .arguments = {argv, argv + argc}};
    const auto commands = {
        aa::addList,       aa::addPlan,   aa::addCheck,     aa::addRun,     aa::addFilter,    aa::addBench,
        aa::addSheet,      aa::addReport, aa::addCompare,   aa::addSynth,   aa::addLearnRsaa, aa::addImport,
        aa::addSweep,      aa::addAngles, aa::addSurvey,    aa::addDevices, aa::addVerify,    aa::addHelp,
        aa::addCompletion, aa::addGate,   aa::addStability,
    };
    for (const auto add : commands) add(line, context);
    aa::protectInputs();
    try {
        if (aa::answersShell(line, argc, argv)) {
            flushOutput();
            return 0;
        }
        if (argc > 1 && argv[1][0] != '-') {
            const aa::CommandInfo program = line.describe();
            std::vector<std::string_view> known;
            for (const auto& c : program.commands) known.push_back(c.name);
            const std::string near = aa::suggestion(argv[1], known);
            if (std::find(known.begin(), known.end(), argv[1]) == known.end())
                throw aa::UsageError("unknown command '" + std::string(argv[1]) + "'" +
                                     (near.empty() ? "; see aaresolve --help" : "; did you mean '" + near + "'?"));
        }
        if (const int code = line.parse(argc, argv)) return code;
        flushOutput();
    } catch (const aa::UsageError& e) {
        std::cerr << "aaresolve: " << aa::onOneLine(e.what()) << "\n";
        return 2;
    } catch (const aa::OutputError& e) {
        std::cerr << "aaresolve: " << aa::onOneLine(e.what()) << "\n";
        return 1;
    } catch (const aa::InputError& e) {
        std::cerr << "aaresolve: " << aa::onOneLine(e.what()) << "\n";
        return 3;
    } catch (const std::filesystem::filesystem_error& e) {  // a name too long, a loop of links, a folder without rights
        std::cerr << "aaresolve: " << aa::onOneLine(e.path1().string() + ": " + e.code().message())
                  << "; check the path and its permissions\n";
        return 3;
    } catch (const std::bad_alloc&) {
        std::cerr << "aaresolve: out of memory; use fewer methods or threads, or a smaller resolution\n";
        return 3;
    } catch (const std::system_error& e) {  // no thread could be started
        std::cerr << "aaresolve: the system refuses (" << aa::onOneLine(e.what())
                  << "); allow this user more processes, or use -j 1 where the command has it\n";
        return 3;
    } catch (const std::exception& e) {
        std::cerr << "aaresolve: " << aa::onOneLine(e.what()) << "\n";
        return 3;
    }
    return context.exitCode;
}
