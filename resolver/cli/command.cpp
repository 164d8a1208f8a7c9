#include "cli/command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <set>
#include <sstream>

#include "cli/one_line.h"
#include "image/error.h"

namespace aa {

Option& Option::required() { return option_->required(), *this; }
Option& Option::range(int least, int most) { return option_->check(CLI::Range(least, most)), *this; }
Option& Option::range(double least, double most) { return option_->check(CLI::Range(least, most)), *this; }
Option& Option::notNegative() {
    const auto refusal = [](const std::string& text) {
        double value = 0;
        if (CLI::detail::lexical_cast(text, value) && value >= 0) return std::string();
        return "expected a number from 0 on, found '" + text + "'";
    };
    return option_->check(CLI::Validator([refusal](std::string& text) { return refusal(text); }, "NUMBER >= 0")), *this;
}
Option& Option::oneOf(std::initializer_list<std::string> texts) {
    return option_->check(CLI::IsMember(std::vector<std::string>(texts))), *this;
}
Option& Option::oneOf(std::initializer_list<int> numbers) {
    return option_->check(CLI::IsMember(std::vector<int>(numbers))), *this;
}
Option& Option::oneEach() { return option_->allow_extra_args(false), *this; }
// As many as the separators say, so that what follows is the command's own.
Option& Option::separatedBy(char separator) { return option_->delimiter(separator)->allow_extra_args(false), *this; }
Option& Option::values(int least, int most) {
    return least == most ? option_->expected(least) : option_->expected(least, most), *this;
}
Option& Option::excludes(std::string_view name) { return option_->excludes(std::string(name)), *this; }
Option& Option::typeName(const std::string& name) {
    option_->type_name(name);
    if (const std::set<std::string> ofFiles = {"FILE", "FOLDER", "RUN", "SHOT"}; ofFiles.contains(name)) {
        const auto refusal = [](std::string& text) { return text.empty() ? "found an empty name" : std::string(); };
        option_->check(CLI::Validator(refusal, ""));
    }
    return *this;
}
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
// NaN is refused here, before any range, in which it would lie.
Option Command::option(const std::string& names, double& to, const std::string& help) {
    const auto refusal = [](std::string& text) {
        double value = 0;
        const bool isNumber = CLI::detail::lexical_cast(text, value);  // what is none, CLI says in its own words
        return !isNumber || std::isfinite(value) ? std::string() : "expected a number, found '" + text + "'";
    };
    return Option(app_->add_option(names, to, help)->check(CLI::Validator(refusal, "")));
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

CommandLine::CommandLine(const std::string& help, const std::string& version)
    : app_(std::make_unique<CLI::App>(help, "aaresolve")) {
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
void CommandLine::renamed(const std::string& command, const std::string& before, const std::string& now) {
    renamed_.push_back({command, before, now});
}

namespace {
// CLI11 keeps what is allowed in the text of the type, "TEXT:{png,exr}".
std::vector<std::string> choicesOf(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    const size_t open = type.find('{'), close = type.find('}');
    std::vector<std::string> all;
    if (open == std::string::npos || close == std::string::npos) return all;
    std::istringstream inner(type.substr(open + 1, close - open - 1));
    for (std::string choice; std::getline(inner, choice, ',');) all.push_back(choice);
    return all;
}
OptionInfo describe(const CLI::Option& option) {
    OptionInfo info;
    info.isArgument = option.get_positional();
    if (info.isArgument)
        info.names = {option.get_name(true)};
    else {
        for (const auto& n : option.get_snames()) info.names.push_back("-" + n);
        for (const auto& n : option.get_lnames()) info.names.push_back("--" + n);
    }
    if (option.get_items_expected_max() > 0) {
        info.type = option.get_type_name();
        info.type = info.type.substr(0, info.type.find(':'));
        info.choices = choicesOf(option);
        info.defaultText = option.get_default_str();
        if (info.defaultText == "[]") info.defaultText.clear();
    }
    info.help = option.get_description();
    info.isRequired = option.get_required();
    info.isRepeatable = option.get_expected_max() > 1;
    return info;
}
CommandInfo describe(const CLI::App& app) {
    CommandInfo info{app.get_name(), app.get_description(), {}, {}};
    for (const auto* o : app.get_options()) info.options.push_back(describe(*o));
    for (const auto* c : app.get_subcommands({})) info.commands.push_back(describe(*c));
    return info;
}
// The command that was being read when the usage went wrong: "aaresolve survey make".
std::string commandBeingRead(const CLI::App& app) {
    std::string name = app.get_name();
    for (const CLI::App* at = &app; !at->get_subcommands().empty();) {
        at = at->get_subcommands().back();
        name += " " + at->get_name();
    }
    return name;
}
}  // namespace

const CommandInfo* CommandInfo::find(std::string_view command) const {
    for (const auto& c : commands)
        if (c.name == command) return &c;
    return nullptr;
}
CommandInfo CommandLine::describe() const { return aa::describe(*app_); }

void CommandLine::useNewNames(std::vector<std::string>& words) const {
    if (words.empty()) return;
    for (auto& word : words)
        for (const Renamed& r : renamed_)
            if (words[0] == r.command && (word == r.before || word.starts_with(r.before + "="))) {
                std::cerr << "aaresolve: note: " << r.before << " is called " << r.now << " now\n";
                word = r.now + word.substr(r.before.size());
            }
}

namespace {
// "help survey make" -> "survey make --help". Throws UsageError: no such command.
std::vector<std::string> helpWords(const std::vector<std::string>& words, const CommandInfo& program) {
    if (words.empty() || words[0] != "help" || (words.size() > 1 && words[1].starts_with('-'))) return words;
    std::vector<std::string> asked(words.begin() + 1, words.end());
    std::string name = program.name;
    const CommandInfo* at = &program;
    for (const auto& word : asked) {
        std::vector<std::string_view> known;
        for (const auto& c : at->commands) known.push_back(c.name);
        const std::string near = suggestion(word, known);
        at = at->find(word);
        if (!at)
            throw UsageError("help: " + name + " has no command '" + word + "'" +
                             (near.empty() ? "; see " + name + " --help" : "; did you mean '" + near + "'?"));
        name += " " + word;
    }
    asked.push_back("--help");
    return asked;
}
}  // namespace

int CommandLine::parse(int argc, char** argv) {
    std::vector<std::string> words = helpWords({argv + 1, argv + argc}, describe());
    useNewNames(words);
    std::reverse(words.begin(), words.end());  // as CLI11 takes them
    try {
        app_->parse(std::move(words));
    } catch (const CLI::ParseError& e) {
        if (e.get_exit_code() == 0) return app_->exit(e);  // --help, --version
        std::cerr << "aaresolve: " << onOneLine(e.what()) << " (see " << commandBeingRead(*app_) << " --help)\n";
        return 2;
    }
    return 0;
}

}  // namespace aa
