// The parsers of everything that comes from outside, one target each: bytes in, an error of one line or a value out.
// libfuzzer.cpp searches for inputs that break them, replay.cpp walks through a fixed set in every `make test`.
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aa::fuzz {

using Bytes = std::span<const uint8_t>;

struct Target {
    std::string_view name;
    // Reads the input as the program would. Throws what the program turns into its one line and exit code: InputError,
    // UsageError; anything else is a fault.
    void (*read)(Bytes input);
    bool isText = false;
    // Makes checksums right again after a mutation, so that what lies behind them is reached; null: there are none.
    size_t (*mend)(uint8_t* bytes, size_t size) = nullptr;
    bool refuses = true;  // some inputs; else what is damaged counts as not there
};
const std::vector<Target>& targets();
const Target* find(std::string_view name);  // null: no such target

// Whether the input was accepted; aborts the process with a message when it was neither accepted nor refused with
// words.
bool readOrAbort(const Target& target, Bytes input);

// Whole inputs to start from that are made here; the others are the program's own output (fuzz.py --seeds).
struct Seed {
    std::string name;
    std::vector<uint8_t> bytes;
};
std::vector<Seed> pictureSeeds(std::string_view target);

}  // namespace aa::fuzz
