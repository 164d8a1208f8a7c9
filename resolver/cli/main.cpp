#include <algorithm>
#include <iostream>

#include "cli/cli.h"
#include "image/error.h"

int main(int argc, char** argv) {
    CLI::App app{
        "aaresolve: runs every anti-aliasing method on a shot and measures it against ground truth.\n"
        "Exit codes: 0 ok, 1 a check failed or a difference was found, 2 wrong usage, 3 bad input."};
    app.set_version_flag("--version", AA_VERSION);
    app.require_subcommand(1);
    app.fallthrough(false);
    app.get_formatter()->column_width(34);
    app.option_defaults()->always_capture_default();
    aa::Context context;
    const auto commands = {
        aa::addList,   aa::addPlan,    aa::addCheck, aa::addRun,       aa::addFilter, aa::addBench, aa::addSheet,
        aa::addReport, aa::addCompare, aa::addSynth, aa::addLearnRsaa, aa::addImport, aa::addSweep, aa::addAngles,
    };
    for (const auto add : commands) add(app, context);
    try {
        if (argc > 1 && argv[1][0] != '-') {
            std::vector<std::string_view> known;
            for (const auto* c : app.get_subcommands({})) known.push_back(c->get_name());
            const std::string near = aa::suggestion(argv[1], known);
            if (std::find(known.begin(), known.end(), argv[1]) == known.end())
                throw aa::UsageError("unknown command '" + std::string(argv[1]) + "'" +
                                     (near.empty() ? "; see aaresolve --help" : "; did you mean '" + near + "'?"));
        }
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
        std::cerr << "aaresolve: " << e.what() << " (see aaresolve --help)\n";
        return 2;
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
