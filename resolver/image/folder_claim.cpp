#include "image/folder_claim.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "image/error.h"
#include "image/io.h"
#include "image/output_error.h"

namespace aa {
namespace fs = std::filesystem;

namespace {
// Whoever may write into the folder may claim it, though the file be another user's, which only the owner may write:
// a run that was killed leaves it. Writing is asked for first because NFS grants no exclusive lock without it.
int openClaim(const fs::path& file) {
    const int opened = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    return opened < 0 && (errno == EACCES || errno == EPERM) ? ::open(file.c_str(), O_RDONLY | O_CLOEXEC) : opened;
}
// The one who held the lock before may have removed its file since we opened it.
bool isStillThere(int file, const fs::path& path) {
    struct stat opened = {}, named = {};
    return ::fstat(file, &opened) == 0 && ::stat(path.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
           opened.st_dev == named.st_dev;
}
}  // namespace

bool holdsOnly(const fs::path& folder, const std::function<bool(const std::string& name)>& isOurs) {
    std::error_code failed;
    for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed))
        if (!isOurs(it->path().filename().string())) return false;
    return !failed;
}

FolderClaim::FolderClaim(const fs::path& folder)
    : folder_(folder), lock_(folder / kClaimFile), isNew_(!fs::exists(folder)) {
    makeWritableFolder(folder);
    while (true) {
        file_ = openClaim(lock_);
        if (file_ < 0) {
            const std::string why = std::generic_category().message(errno);
            std::error_code ignored;
            if (fs::exists(lock_, ignored))
                throw OutputError(lock_.string() + ": another user's claim, which cannot be opened (" + why +
                                  "); delete it if no run of theirs works there, or choose another output folder");
            throw OutputError(folder.string() + ": not a writable folder (" + why +
                              "); choose another output folder or change its permissions");
        }
        // A file system without locks has no claims either; temporary names are unique all the same.
        if (::flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
            ::close(file_);
            throw InputError(folder.string() +
                             ": another process writes there; wait for its end or choose another output folder");
        }
        if (isStillThere(file_, lock_)) return;
        ::close(file_);
    }
}
FolderClaim::~FolderClaim() {
    ::unlink(lock_.c_str());
    ::close(file_);
    std::error_code isFull;
    if (isNew_) fs::remove(folder_, isFull);
}

}  // namespace aa
