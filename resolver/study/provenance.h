// Where a run's figures come from, so that they can be made again: the line that made them, when, of which shot, by
// which program and on what machine. Nothing here decides a figure: two runs of one shot differ in these members and in
// their times alone.
#pragma once
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "shot/manifest.h"

namespace aa {

struct Machine {
    std::string processor;                     // as the system names it
    int cores = 0;                             // that this process may use
    std::vector<std::string> instructionSets;  // of those that the kernels are built for, what the processor has
    std::string system;                        // Linux 6.1.0-18-amd64 x86_64
};
Machine thisMachine();

struct Provenance {
    std::string command;  // as it was typed, quoted for a POSIX shell; empty where no command line made the run
    std::string
        rerun;  // the same without its methods and folder: `-m METHOD -o DIR` behind it makes one row again (rerunLine)
    std::string folder;  // in which it was typed
    std::string date;    // UTC, 2026-11-29T10:55:17Z, when the run began
    std::string shotPath;
    std::string commit;  // of the source that the program was built from; empty where it is not known
    Machine machine;
};
// `arguments` begin with the program's name. `unlike` are the options that differ from row to row or say where to
// write: left out of `rerun` with their values; of `flags` there are none.
Provenance provenanceOf(const std::vector<std::string>& arguments, const std::set<std::string>& unlike,
                        const std::set<std::string>& flags = {});
// A word as a POSIX shell reads it back.
std::string shellQuoted(const std::string& word);
std::string programCommit();  // empty: not known

// XXH3, 128 bits, of these frames' files and of what shot.json says but for times and who wrote it: the same for the
// same content, wherever it lies. 32 hexadecimal digits. Throws InputError where a file cannot be read.
std::string contentHash(const Manifest& manifest, const std::vector<size_t>& frames);

}  // namespace aa
