// `help` and the manual page, which is the help of all commands once more.
#include <cstdio>
#include <sstream>

#include "cli/cli.h"
#include "methods/choosing.h"
#include "methods/stage.h"

namespace aa {
namespace {

// Text for troff: nothing in it is a command.
std::string escaped(const std::string& text) {
    std::string s;
    for (const char c : text) s += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
    if (!s.empty() && (s[0] == '.' || s[0] == '\'')) s.insert(0, "\\&");
    return s;
}
void printText(const std::string& text) {
    std::istringstream lines(text);
    bool first = true;
    for (std::string one; std::getline(lines, one); first = false) {
        if (!first) std::puts(".br");
        const size_t begin = one.find_first_not_of(' ');
        if (begin != std::string::npos) std::printf("%s\n", escaped(one.substr(begin)).c_str());
    }
}
void printOption(const OptionInfo& o) {
    std::string head;
    for (const auto& name : o.names)
        head += (head.empty() ? "" : ", ") + std::string(o.isArgument ? "\\fI" : "\\fB") + escaped(name) + "\\fR";
    if (!o.choices.empty() || (!o.type.empty() && !o.isArgument)) {
        std::string value;
        for (const auto& choice : o.choices) value += (value.empty() ? "" : "|") + choice;
        head += " \\fI" + escaped(value.empty() ? o.type : value) + "\\fR";
    }
    if (o.isRepeatable) head += " ...";
    std::printf(".TP\n%s\n", head.c_str());
    printText(o.help + (o.isRequired && !o.isArgument ? " (required)" : "") +
              (o.defaultText.empty() ? "" : " (default " + o.defaultText + ")"));
}
void printCommand(const CommandInfo& c, const std::string& before) {
    const std::string name = before + " " + c.name;
    std::string usage = name;
    if (c.options.size() > 1) usage += " [OPTION...]";  // beside --help
    for (const auto& o : c.options)
        if (o.isArgument) usage += " " + o.names[0] + (o.isRepeatable ? "..." : "");
    std::printf(".SS \"%s\"\n", escaped(usage).c_str());
    printText(c.help);
    for (const auto& o : c.options)
        if (o.names.back() != "--help") printOption(o);
    for (const auto& inner : c.commands) printCommand(inner, name);
}

void printManual(const CommandInfo& program) {
    std::printf(".TH AARESOLVE 1 \"\" \"aaresolve %s\" \"User Commands\"\n", AA_VERSION);
    std::puts(".SH NAME\naaresolve \\- run anti\\-aliasing methods on a shot and measure them against ground truth");
    std::puts(".SH SYNOPSIS\n.B aaresolve\n.I COMMAND\n[OPTION...]\n.br\n.B aaresolve help\n[\\fICOMMAND\\fR]");
    std::puts(".SH DESCRIPTION");
    printText(
        "A shot is a folder of frames with what a real-time renderer knows of each and with ground truth: exported "
        "by the Blender add-on, imported, or made by synth. run puts methods to work on it, and measures each "
        "against the truth and by its time; sheet and report show what came out.");
    std::puts(".SH COMMANDS");
    for (const auto& c : program.commands) printCommand(c, program.name);
    std::puts(".SH METHODS");
    printText(
        "Written ID or ID:NAME=VALUE,NAME=VALUE, with stages behind: ID+STAGE=VALUE. Several with commas; a comma is "
        "part of the method before it where NAME=VALUE follows. `aaresolve list METHOD` shows the parameters.");
    for (const auto& m : registry())
        std::printf(".TP\n\\fB%s\\fR (%s)\n%s. %s\n", escaped(std::string(m.id)).c_str(), std::string(m.family).c_str(),
                    escaped(std::string(m.title)).c_str(), escaped(std::string(m.summary)).c_str());
    for (const auto& s : stages())
        std::printf(".TP\n\\fB+%s\\fR\n%s\n", std::string(s.value.name).c_str(),
                    escaped(std::string(s.value.help)).c_str());
    std::puts(".PP\nSets of methods:");
    for (const MethodSet& set : methodSets(true))
        std::printf(".TP\n\\fB%s\\fR\n%s\n", set.name.c_str(), escaped(set.meaning).c_str());
    std::puts(
        ".SH EXIT STATUS\n.TP\n0\nall is well\n.TP\n1\na check failed, a difference was found, or the output could "
        "not be written\n.TP\n2\nwrong usage\n.TP\n3\nbad input");
    std::puts(
        ".SH EXAMPLE\n.nf\naaresolve synth moving \\-o shot \\-\\-frames 8\naaresolve run shot \\-m fxaa311,uncharted "
        "\\-o out\naaresolve report out\n.fi");
}
}  // namespace

void addHelp(CommandLine& line, Context&) {
    struct Options {
        bool manual = false;
        std::vector<std::string> command;
    };
    auto o = std::make_shared<Options>();
    Command c = line.command("help", "The help of a command, as COMMAND --help prints it");
    c.option("COMMAND", o->command, "the command; none = the list of all").typeName("COMMAND");
    c.flag("--man", o->manual, "the manual page of the whole program, for man(1)");
    c.run([o, &line] {
        if (o->manual) printManual(line.describe());
    });
}

}  // namespace aa
