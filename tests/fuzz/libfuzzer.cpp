// A target under libFuzzer (clang -fsanitize=fuzzer): fuzz_target TARGET [options of libFuzzer] [corpus folders]; or
// fuzz_target --seeds FOLDER, which adds the whole inputs that are made here to those of fuzz.py.
#include <tbb/global_control.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "targets.h"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t maxSize);

namespace {
const aa::fuzz::Target* chosen = nullptr;
}

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    static tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
    if (*argc == 3 && std::string_view((*argv)[1]) == "--seeds") {
        for (const auto& target : aa::fuzz::targets())
            for (const auto& seed : aa::fuzz::pictureSeeds(target.name)) {
                const auto file = std::filesystem::path((*argv)[2]) / target.name / seed.name;
                std::filesystem::create_directories(file.parent_path());
                std::ofstream(file, std::ios::binary)
                    .write(reinterpret_cast<const char*>(seed.bytes.data()), std::streamsize(seed.bytes.size()));
            }
        std::exit(0);
    }
    chosen = *argc > 1 ? aa::fuzz::find((*argv)[1]) : nullptr;
    if (!chosen) {
        std::fprintf(stderr, "usage: fuzz_target TARGET [libFuzzer's options] [CORPUS...]; TARGET:");
        for (const auto& t : aa::fuzz::targets()) std::fprintf(stderr, " %.*s", int(t.name.size()), t.name.data());
        std::fprintf(stderr, "\n");
        std::exit(2);
    }
    std::memmove(*argv + 1, *argv + 2, sizeof(char*) * size_t(*argc - 1));  // with the null at the end
    --*argc;
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    aa::fuzz::readOrAbort(*chosen, {data, size});
    return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t maxSize, unsigned int) {
    const size_t now = LLVMFuzzerMutate(data, size, maxSize);
    return chosen->mend ? chosen->mend(data, now) : now;
}
