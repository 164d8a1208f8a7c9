#include <algorithm>
#include <iostream>

#include "cli/cli.h"
#include "image/error.h"

int main(int argc, char** argv) {
    aa::CommandLine line(
        "aaresolve: runs every anti-aliasing method on a shot and measures it against ground truth.\n"
        "Exit codes: 0 ok, 1 a check failed or a difference was found, 2 wrong usage, 3 bad input.",
        AA_VERSION);
    aa::Context context;
    const auto commands = {
        aa::addList,  aa::addPlan,   aa::addCheck,   aa::addRun,     aa::addFilter,    aa::addBench,
        aa::addSheet, aa::addReport, aa::addCompare, aa::addSynth,   aa::addLearnRsaa, aa::addImport,
        aa::addSweep, aa::addAngles, aa::addSurvey,  aa::addDevices, aa::addVerify,
    };
    for (const auto add : commands) add(line, context);
    try {
        if (argc > 1 && argv[1][0] != '-') {
            const std::vector<std::string> names = line.commands();
            const std::vector<std::string_view> known(names.begin(), names.end());
            const std::string near = aa::suggestion(argv[1], known);
            if (std::find(known.begin(), known.end(), argv[1]) == known.end())
                throw aa::UsageError("unknown command '" + std::string(argv[1]) + "'" +
                                     (near.empty() ? "; see aaresolve --help" : "; did you mean '" + near + "'?"));
        }
        if (const int code = line.parse(argc, argv)) return code;
    } catch (const aa::UsageError& e) {
        std::cerr << "aaresolve: " << e.what() << "\n";
        return 2;
    } catch (const aa::InputError& e) {
        std::cerr << "aaresolve: " << e.what() << "\n";
        return 3;
    } catch (const std::bad_alloc&) {
        std::cerr << "aaresolve: out of memory; use fewer methods or threads, or a smaller resolution\n";
        return 3;
    }
    return context.exitCode;
}
