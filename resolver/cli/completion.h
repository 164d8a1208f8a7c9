// Completion in shells. A shell's script, which `aaresolve completion SHELL` prints, asks the program itself by
// `aaresolve completion words -- WORD...`, so that commands, options, methods and parameters are those of this program.
#pragma once
#include "cli/command.h"

namespace aa {

struct Candidate {
    std::string text, help;
};
// What may stand in place of the last of `words`, which follow the program's name. Empty: a file, or anything.
std::vector<Candidate> candidatesFor(const CommandInfo& program, const std::vector<std::string>& words);
// Prints the candidates, "TEXT<tab>HELP" each, when the arguments are such a question.
bool answersShell(const CommandLine& line, int argc, char** argv);

}  // namespace aa
