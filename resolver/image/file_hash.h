// XXH3's 128 bits of what a file or a text holds: which pictures a run was made from.
#pragma once
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

namespace aa {

class Hash {
  public:
    Hash();
    ~Hash();
    void add(const void* bytes, size_t size);
    void add(const std::string& text) { add(text.data(), text.size()); }
    std::string digits() const;  // 32, hexadecimal

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// Throws InputError: it cannot be read.
std::string hashOfFile(const std::filesystem::path& file);

}  // namespace aa
