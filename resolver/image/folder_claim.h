// One writer per folder.
#pragma once
#include <filesystem>
#include <functional>
#include <string>

namespace aa {

// The file that a claim holds in its folder.
inline constexpr const char* kClaimFile = ".aaresolve.lock";
// Whether `isOurs` knows the name of every entry. False where the folder cannot be listed.
bool holdsOnly(const std::filesystem::path& folder, const std::function<bool(const std::string& name)>& isOurs);

// While it lives no other process of this program claims the folder. The claim ends with the process, however that
// ends.
class FolderClaim {
  public:
    // Makes the folder where there is none. Throws InputError: another process writes there;
    // OutputError: not a writable folder.
    explicit FolderClaim(const std::filesystem::path& folder);
    ~FolderClaim();  // a folder that it made and that nothing was written to is removed again
    FolderClaim(const FolderClaim&) = delete;
    FolderClaim& operator=(const FolderClaim&) = delete;

  private:
    std::filesystem::path folder_, lock_;
    bool isNew_;
    int file_ = -1;
};

}  // namespace aa
