#include "image/inputs.h"

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <unordered_set>

#include "image/error.h"

namespace aa {
namespace fs = std::filesystem;
namespace {
// Of names, of which a run may read millions.
struct Inputs {
    std::atomic<bool> isOn{false};
    std::mutex mutex;
    std::unordered_set<size_t> names;
};
Inputs& inputs() {
    static Inputs all;
    return all;
}
size_t nameOf(const fs::path& file) {
    std::error_code failed;
    const fs::path whole = fs::canonical(file, failed);
    return failed ? 0 : std::hash<std::string>()(whole.string());
}
}  // namespace

void protectInputs() { inputs().isOn = true; }

void noteInput(const fs::path& file) {
    Inputs& all = inputs();
    if (!all.isOn) return;
    const size_t name = nameOf(file);
    const std::lock_guard one(all.mutex);
    if (name) all.names.insert(name);
}

void mayBeReplaced(const fs::path& file) {
    Inputs& all = inputs();
    if (!all.isOn) return;
    const size_t name = nameOf(file);
    const std::lock_guard one(all.mutex);
    all.names.erase(name);
}

void requireNoInput(const fs::path& file) {
    Inputs& all = inputs();
    if (!all.isOn) return;
    const size_t name = nameOf(file);
    const std::lock_guard one(all.mutex);
    if (name && all.names.contains(name))
        throw UsageError(file.string() + ": this command reads it; choose another name for what it writes");
}

}  // namespace aa
