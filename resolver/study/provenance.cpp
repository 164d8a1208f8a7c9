#include "study/provenance.h"

#include <sched.h>
#include <sys/utsname.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <utility>

#include "commit.h"
#include "image/file_hash.h"
#include "image/json_text.h"
#include "kernels/dispatch.h"

namespace aa {
namespace fs = std::filesystem;
namespace {

std::string utcNow() {
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    gmtime_r(&now, &parts);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text;
}
std::string processorName() {
    std::ifstream cpus("/proc/cpuinfo");
    for (std::string line; std::getline(cpus, line);)
        if (line.starts_with("model name"))
            if (const size_t colon = line.find(':'); colon != std::string::npos)
                return line.substr(std::min(line.size(), colon + 2));
    return "unknown processor";
}
int usableCores() {
    cpu_set_t set;
    return sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 0;
}
std::string joined(const std::vector<std::string>& words) {
    std::string line;
    for (const auto& word : words) line += (line.empty() ? "" : " ") + shellQuoted(word);
    return line;
}

// shot.json on one line with these frames alone and without what two renders of one shot may differ in; a frame at a
// time.
void addDocument(Hash& hash, const Manifest& manifest, const std::vector<size_t>& frames) {
    nlohmann::json document = toJsonWithoutFrames(manifest);
    document.erase("producer");
    document["frames"] = nullptr;  // in its place among the members
    const char* between = "{";
    for (const auto& [name, value] : document.items()) {
        hash.add(std::exchange(between, ",") + jsonText(nlohmann::json(name), -1) + ":");
        if (name != "frames") {
            hash.add(jsonText(value, -1));
            continue;
        }
        const char* betweenFrames = "[";
        for (const size_t i : frames) {
            nlohmann::json frame = toJson(manifest.frames.at(i));
            frame.erase("render_seconds");
            hash.add(std::exchange(betweenFrames, ",") + jsonText(frame, -1));
        }
        hash.add(frames.empty() ? "[]" : "]");
    }
    hash.add("}");
}
}  // namespace

Machine thisMachine() {
    Machine m;
    m.processor = processorName();
    m.cores = usableCores();
    for (const Isa isa : kIsas)
        if (isaSupported(isa)) m.instructionSets.emplace_back(name(isa));
    utsname system{};
    if (uname(&system) == 0) m.system = std::string(system.sysname) + " " + system.release + " " + system.machine;
    return m;
}

std::string shellQuoted(const std::string& word) {
    const auto plain = [](unsigned char c) {
        return std::isalnum(c) || std::string_view("_@%+=:,./-").find(char(c)) != std::string_view::npos;
    };
    if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

Provenance provenanceOf(const std::vector<std::string>& arguments, const std::set<std::string>& unlike,
                        const std::set<std::string>& flags) {
    Provenance p;
    p.command = joined(arguments);
    std::vector<std::string> kept;
    for (size_t i = 0; i < arguments.size(); i++) {
        const std::string& word = arguments[i];
        const std::string name = word.substr(0, word.starts_with("--") ? word.find('=') : 2);
        if (flags.contains(word)) continue;
        if (unlike.contains(name)) {
            if (name == word) i++;  // the value is the next word
            continue;
        }
        kept.push_back(word);
    }
    p.rerun = joined(kept);
    std::error_code ignored;
    p.folder = fs::current_path(ignored).string();
    p.date = utcNow();
    p.commit = programCommit();
    p.machine = thisMachine();
    return p;
}
std::string programCommit() { return AA_COMMIT; }

std::string contentHash(const Manifest& manifest, const std::vector<size_t>& frames) {
    std::map<std::string, std::string> files;  // in the order of their names, each once
    for (const size_t i : frames) {
        const FrameEntry& f = manifest.frames.at(i);
        for (const auto& file : {f.file, f.centre, f.truth})
            if (!file.empty()) files[file];
    }
    std::vector<std::pair<const std::string, std::string>*> all;
    for (auto& file : files) all.push_back(&file);
    tbb::parallel_for(size_t(0), all.size(),
                      [&](size_t i) { all[i]->second = hashOfFile(manifest.folder / all[i]->first); });
    Hash hash;
    addDocument(hash, manifest, frames);
    for (const auto& [file, digits] : files) hash.add(digits);
    return hash.digits();
}

}  // namespace aa
