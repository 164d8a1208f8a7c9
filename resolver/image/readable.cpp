#include "image/readable.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "image/error.h"
#include "image/json_text.h"

namespace aa {
namespace fs = std::filesystem;

void requireReadable(const fs::path& file, const std::string& ifMissing) {
    struct stat about = {};
    const bool known = ::stat(file.c_str(), &about) == 0;
    if (known && ::access(file.c_str(), R_OK) == 0) return;
    const int why = errno;
    if (!known && why != EACCES) throw InputError(file.string() + ": no such file" + ifMissing);
    throw InputError(file.string() + ": cannot be read (" + std::generic_category().message(why) +
                     "); check its permissions" + (known ? "" : " and those of its folders"));
}

std::string requiredText(const fs::path& file, const std::string& ifMissing) {
    if (auto text = textOf(file)) return *std::move(text);
    requireReadable(file, ifMissing);
    throw InputError(file.string() + ": is a folder or a device; expected a file");
}

}  // namespace aa
