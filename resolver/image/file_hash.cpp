#include "image/file_hash.h"

#include <fstream>
#include <vector>

#include "image/error.h"
#include "image/readable.h"
#define XXH_INLINE_ALL  // nothing to link
#include <xxhash.h>

namespace aa {

struct Hash::State {
    XXH3_state_t* of = XXH3_createState();
    ~State() { XXH3_freeState(of); }
};
Hash::Hash() : state_(std::make_unique<State>()) { XXH3_128bits_reset(state_->of); }
Hash::~Hash() = default;
void Hash::add(const void* bytes, size_t size) { XXH3_128bits_update(state_->of, bytes, size); }
std::string Hash::digits() const {
    XXH128_canonical_t bytes;
    XXH128_canonicalFromHash(&bytes, XXH3_128bits_digest(state_->of));
    std::string text;
    for (const unsigned char b : bytes.digest)
        for (const int half : {b >> 4, b & 15}) text += "0123456789abcdef"[half];
    return text;
}

std::string hashOfFile(const std::filesystem::path& file) {
    requireReadable(file, "; export the frame again");
    std::ifstream in(file, std::ios::binary);
    if (!in) throw InputError(file.string() + ": cannot be read; export the frame again");
    Hash hash;
    std::vector<char> block(1 << 20);
    while (in.read(block.data(), std::streamsize(block.size())) || in.gcount() > 0)
        hash.add(block.data(), size_t(in.gcount()));
    if (in.bad()) throw InputError(file.string() + ": cannot be read to its end; export the frame again");
    return hash.digits();
}

}  // namespace aa
