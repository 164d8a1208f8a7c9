// Every target over its seeds, which must be accepted (those called bad-...: refused), and over a fixed number of
// damaged copies of each, which must be accepted or refused in one line: fuzz_replay SEEDS CASES. SEEDS holds a folder
// per target (fuzz.py --seeds); CASES are per seed and always the same.
#include <sys/resource.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>

#include "image/split_mix64.h"
#include "targets.h"

namespace {
using namespace aa::fuzz;
namespace fs = std::filesystem;

struct Random : aa::SplitMix64 {
    using SplitMix64::SplitMix64;
    size_t below(size_t n) { return size_t(next() % n); }
};

std::vector<uint8_t> damaged(std::vector<uint8_t> bytes, bool text, Random& random) {
    static constexpr std::string_view kWords[] = {"-1",  "1e999",       "null", "{}",  "[",   "\"",
                                                  "nan", "99999999999", ",",    "../", "\xff"};
    for (size_t edits = 1 + random.below(3); edits > 0; edits--) {
        const size_t at = random.below(bytes.size() + 1);
        switch (random.below(4)) {
            case 0:
                if (at < bytes.size()) bytes[at] ^= uint8_t(1u << random.below(8));
                break;
            case 1: {
                const size_t end = std::min(bytes.size(), at + 1 + random.below(text ? 12 : 64));
                bytes.erase(bytes.begin() + ptrdiff_t(at), bytes.begin() + ptrdiff_t(end));
                break;
            }
            case 2:
                if (text) {
                    const std::string_view word = kWords[random.below(std::size(kWords))];
                    bytes.insert(bytes.begin() + ptrdiff_t(at), word.begin(), word.end());
                } else {
                    for (size_t i = at; i < std::min(bytes.size(), at + 4); i++) bytes[i] = random.below(2) ? 0xff : 0;
                }
                break;
            case 3: {  // a piece of it again
                const size_t from = random.below(bytes.size() + 1);
                const size_t length = std::min(bytes.size() - from, 1 + random.below(40));
                const std::vector<uint8_t> piece(bytes.begin() + ptrdiff_t(from),
                                                 bytes.begin() + ptrdiff_t(from + length));
                bytes.insert(bytes.begin() + ptrdiff_t(at), piece.begin(), piece.end());
                break;
            }
        }
    }
    return bytes;
}

std::vector<Seed> seedsOf(const Target& target, const fs::path& folder) {
    std::vector<Seed> seeds = pictureSeeds(target.name);
    std::vector<fs::path> files;
    if (fs::is_directory(folder / target.name))
        for (const auto& entry : fs::directory_iterator(folder / target.name)) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) {
        std::ifstream in(file, std::ios::binary);
        seeds.push_back({file.filename().string(), {std::istreambuf_iterator<char>(in), {}}});
    }
    return seeds;
}
}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: fuzz_replay SEEDS CASES\n");
        return 2;
    }
    tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
    const int cases = std::stoi(argv[2]);
    bool ok = true;
    for (const Target& target : targets()) {
        const auto start = std::chrono::steady_clock::now();
        const std::vector<Seed> seeds = seedsOf(target, argv[1]);
        if (seeds.empty()) {
            std::printf("%s: no seeds in %s\n", std::string(target.name).c_str(), argv[1]);
            ok = false;
        }
        size_t accepted = 0, refused = 0;
        for (const Seed& seed : seeds) {
            std::string said;
            try {
                target.read(seed.bytes);
            } catch (const std::exception& e) {
                said = e.what();
            }
            if (said.empty() == seed.name.starts_with("bad-")) {
                std::printf("%s: the seed %s is %s\n", std::string(target.name).c_str(), seed.name.c_str(),
                            said.empty() ? "accepted" : ("refused: " + said).c_str());
                ok = false;
            }
            Random random(std::hash<std::string>()(seed.name) + seed.bytes.size());
            // What is refused anyway shows less.
            for (int i = 0; i < (said.empty() ? cases : cases / 10); i++) {
                std::vector<uint8_t> input = damaged(seed.bytes, target.isText, random);
                if (target.mend) input.resize(target.mend(input.data(), input.size()));
                (readOrAbort(target, input) ? accepted : refused)++;
            }
        }
        if (accepted == 0 || (target.refuses && refused == 0)) {
            std::printf("%s: %zu accepted, %zu refused; the cases test nothing\n", std::string(target.name).c_str(),
                        accepted, refused);
            ok = false;
        }
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        std::printf("%-9s %zu seeds, %zu accepted, %zu refused, %.1f s\n", std::string(target.name).c_str(),
                    seeds.size(), accepted, refused, seconds);
    }
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    constexpr long kMostKiB = 3 << 20;  // a damaged size must not take the machine's memory
    std::printf("peak memory %ld MiB\n", used.ru_maxrss >> 10);
    if (used.ru_maxrss > kMostKiB) {
        std::printf("peak memory above %ld MiB\n", kMostKiB >> 10);
        ok = false;
    }
    return ok ? 0 : 1;
}
