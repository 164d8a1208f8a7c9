#include "image/readable.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "image/error.h"
#include "image/json_text.h"

namespace aa {
namespace fs = std::filesystem;

namespace {
void require(const fs::path& path, int rights, bool isFolder, const std::string& ifMissing) {
    struct stat about = {};
    const bool known = ::stat(path.c_str(), &about) == 0;
    const bool isKind = known && (!isFolder || S_ISDIR(about.st_mode));
    if (isKind && ::access(path.c_str(), rights) == 0) return;
    const int why = errno;
    if (!isKind && (known || why != EACCES))
        throw InputError(path.string() + (isFolder ? ": no such folder" : ": no such file") + ifMissing);
    throw InputError(path.string() + ": cannot be read (" + std::generic_category().message(why) +
                     "); check its permissions" + (known ? "" : " and those of its folders"));
}
}  // namespace

void requireReadable(const fs::path& file, const std::string& ifMissing) { require(file, R_OK, false, ifMissing); }
void requireFolder(const fs::path& folder, const std::string& ifMissing) {
    require(folder, R_OK | X_OK, true, ifMissing);
}

std::string requiredText(const fs::path& file, const std::string& ifMissing) {
    if (auto text = textOf(file)) return *std::move(text);
    requireReadable(file, ifMissing);
    throw InputError(file.string() + ": is a folder or a device; expected a file");
}

}  // namespace aa
