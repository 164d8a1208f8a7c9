#include "cli/command.h"

#include <CLI/CLI.hpp>
#include <iostream>

#include "image/error.h"

namespace aa {

Option& Option::required() { return option_->required(), *this; }
Option& Option::range(int least, int most) { return option_->check(CLI::Range(least, most)), *this; }
Option& Option::range(double least, double most) { return option_->check(CLI::Range(least, most)), *this; }
Option& Option::notNegative() { return option_->check(CLI::NonNegativeNumber), *this; }
Option& Option::oneOf(std::initializer_list<std::string> texts) {
    return option_->check(CLI::IsMember(std::vector<std::string>(texts))), *this;
}
Option& Option::oneOf(std::initializer_list<int> numbers) {
    return option_->check(CLI::IsMember(std::vector<int>(numbers))), *this;
}
Option& Option::oneEach() { return option_->allow_extra_args(false), *this; }
Option& Option::separatedBy(char separator) { return option_->delimiter(separator), *this; }
Option& Option::values(int least, int most) {
    return least == most ? option_->expected(least) : option_->expected(least, most), *this;
}
Option& Option::excludes(std::string_view name) { return option_->excludes(std::string(name)), *this; }
Option& Option::defaultText(const std::string& text) { return option_->default_str(text), *this; }

Option Command::option(const std::string& names, std::string& to, const std::string& help) {
    return Option(app_->add_option(names, to, help));
}
Option Command::option(const std::string& names, std::vector<std::string>& to, const std::string& help) {
    return Option(app_->add_option(names, to, help));
}
Option Command::option(const std::string& names, std::vector<int>& to, const std::string& help) {
    return Option(app_->add_option(names, to, help));
}
Option Command::option(const std::string& names, int& to, const std::string& help) {
    return Option(app_->add_option(names, to, help));
}
Option Command::option(const std::string& names, uint32_t& to, const std::string& help) {
    return Option(app_->add_option(names, to, help));
}
Option Command::option(const std::string& names, double& to, const std::string& help) {
    return Option(app_->add_option(names, to, help));
}
Option Command::flag(const std::string& names, bool& to, const std::string& help) {
    return Option(app_->add_flag(names, to, help));
}
Command Command::command(const std::string& name, const std::string& help) {
    CLI::App* inner = app_->add_subcommand(name, help);
    inner->allow_extras(false);
    app_->require_subcommand(0);
    // CLI11 would say that a subcommand is missing, but neither which there are nor what was found.
    app_->allow_extras();
    app_->callback([app = app_] {
        if (!app->get_subcommands().empty()) return;
        std::string all;
        for (const auto* c : app->get_subcommands({})) all += (all.empty() ? "" : " or ") + c->get_name();
        const auto found = app->remaining();
        throw UsageError(app->get_name() + ": expected " + all + ", found " +
                         (found.empty() ? "nothing" : "'" + found[0] + "'") + "; see aaresolve " + app->get_name() +
                         " --help");
    });
    return Command(inner);
}
void Command::run(std::function<void()> body) { app_->callback(std::move(body)); }

CommandLine::CommandLine(const std::string& help, const std::string& version) : app_(std::make_unique<CLI::App>(help)) {
    app_->set_version_flag("--version", version);
    app_->require_subcommand(1);
    app_->fallthrough(false);
    app_->get_formatter()->column_width(34);
    app_->option_defaults()->always_capture_default();
}
CommandLine::~CommandLine() = default;

Command CommandLine::command(const std::string& name, const std::string& help) {
    return Command(app_->add_subcommand(name, help));
}
std::vector<std::string> CommandLine::commands() const {
    std::vector<std::string> names;
    for (const auto* c : app_->get_subcommands({})) names.push_back(c->get_name());
    return names;
}
int CommandLine::parse(int argc, char** argv) {
    try {
        app_->parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        if (e.get_exit_code() == 0) return app_->exit(e);  // --help, --version
        std::cerr << "aaresolve: " << e.what() << " (see aaresolve --help)\n";
        return 2;
    }
    return 0;
}

}  // namespace aa
