// A command's options, declared where they are used. CLI11 stands behind command.cpp alone: its header costs each file
// that includes it four times as much to compile as all else.
#pragma once
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace aa {

// One option or argument. Each call narrows what is accepted; what is not ends the program with exit code 2.
class Option {
  public:
    explicit Option(CLI::Option* option) : option_(option) {}
    Option& required();
    Option& range(int least, int most);
    Option& range(double least, double most);
    Option& notNegative();
    Option& oneOf(std::initializer_list<std::string> texts);
    Option& oneOf(std::initializer_list<int> numbers);
    Option& oneEach();                    // repeated for several values, one behind each
    Option& separatedBy(char separator);  // several values behind one
    Option& values(int least, int most);  // behind one
    Option& excludes(std::string_view name);
    Option& defaultText(const std::string& text);  // that the help shows
    // What is expected, as the help names it and completion knows it: METHOD, SHOT, RUN, FILE, FOLDER, WxH ... A name
    // of a file or folder is not empty.
    Option& typeName(const std::string& name);

  private:
    CLI::Option* option_;
};

// A command line described: what completion and the manual page are made of.
struct OptionInfo {
    std::vector<std::string> names;  // "-o", "--out"; of an argument its name alone
    std::string type;                // "METHOD", "FILE"; empty: a flag
    std::vector<std::string> choices;
    std::string help, defaultText;
    bool isArgument = false, isRequired = false, isRepeatable = false;
};
struct CommandInfo {
    std::string name, help;
    std::vector<OptionInfo> options;
    std::vector<CommandInfo> commands;
    const CommandInfo* find(std::string_view command) const;  // null: none is called so
};

class Command {
  public:
    explicit Command(CLI::App* app) : app_(app) {}
    // "-o,--out" is an option, "SHOT" an argument by its place. The target's value is the default that the help shows.
    Option option(const std::string& names, std::string& to, const std::string& help);
    Option option(const std::string& names, std::vector<std::string>& to, const std::string& help);
    Option option(const std::string& names, std::vector<int>& to, const std::string& help);
    Option option(const std::string& names, int& to, const std::string& help);
    Option option(const std::string& names, uint32_t& to, const std::string& help);
    Option option(const std::string& names, double& to, const std::string& help);
    Option flag(const std::string& names, bool& to, const std::string& help);
    // A command of this command, one of which must then be given.
    Command command(const std::string& name, const std::string& help);
    // What it does once everything is read.
    void run(std::function<void()> body);

  private:
    CLI::App* app_;
};

// The whole command line: its commands, --help, --version and the errors of usage.
class CommandLine {
  public:
    CommandLine(const std::string& help, const std::string& version);
    ~CommandLine();
    Command command(const std::string& name, const std::string& help);
    // An option's former name: read as the present one, with a line on stderr that says so.
    void renamed(const std::string& command, const std::string& before, const std::string& now);
    CommandInfo describe() const;
    // Reads and runs; `help COMMAND` is read as `COMMAND --help`. Returns 2 where the usage is wrong (said on stderr),
    // 0 otherwise, also for help and version. Errors of the command itself pass through.
    int parse(int argc, char** argv);

  private:
    struct Renamed {
        std::string command, before, now;
    };
    void useNewNames(std::vector<std::string>& words) const;
    std::unique_ptr<CLI::App> app_;
    std::vector<Renamed> renamed_;
};

}  // namespace aa
