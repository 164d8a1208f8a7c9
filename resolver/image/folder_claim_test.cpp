#include "image/folder_claim.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <optional>

#include "image/error.h"

namespace aa {
namespace {
namespace fs = std::filesystem;
using ::testing::HasSubstr;

class FolderClaims : public testing::Test {
  protected:
    void SetUp() override {
        folder = fs::path(testing::TempDir()) / ("aa_claim_" + std::to_string(::getpid()));
        fs::create_directories(folder);
    }
    void TearDown() override { fs::remove_all(folder); }
    fs::path folder;
};

TEST_F(FolderClaims, AreOfOneAtATimeAndLeaveNothing) {
    std::optional<FolderClaim> first(folder);
    try {
        FolderClaim second(folder);
        ADD_FAILURE() << "two claims of one folder";
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("another process writes there"));
    }
    first.reset();
    EXPECT_TRUE(fs::is_empty(folder));
    { FolderClaim third(folder / "new"); }
    EXPECT_FALSE(fs::exists(folder / "new"));
}

TEST_F(FolderClaims, EndWithTheProcess) {
    int ready[2];
    ASSERT_EQ(::pipe(ready), 0);
    const pid_t child = ::fork();
    if (child == 0) {
        FolderClaim claim(folder);
        if (::write(ready[1], "x", 1) != 1) ::_exit(1);
        ::pause();
    }
    char byte;
    ASSERT_EQ(::read(ready[0], &byte, 1), 1);
    EXPECT_THROW(FolderClaim{folder}, InputError);
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    FolderClaim ours(folder);
}

// What a killed run of another user leaves: a file that only its owner may write, in a folder that all may.
TEST_F(FolderClaims, StaleOnesOfOtherUsersAreTaken) {
    constexpr uid_t kNobody = 65534;
    const fs::path stale = folder / kClaimFile;
    std::ofstream(stale).close();
    fs::permissions(stale, fs::perms(0444));
    fs::permissions(folder, fs::perms::all);
    const pid_t child = ::fork();
    if (child == 0) {
        // From within: folders above it may be closed to others.
        if (::chdir(folder.c_str()) != 0 || (::geteuid() == 0 && ::setuid(kNobody) != 0)) ::_exit(2);
        try {
            FolderClaim ours(".");
            ::_exit(0);
        } catch (const std::exception&) {
            ::_exit(1);
        }
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
}

TEST_F(FolderClaims, HoldsOnlyWhatIsOurs) {
    const auto isOurs = [](const std::string& name) { return name == kClaimFile; };
    EXPECT_TRUE(holdsOnly(folder, isOurs));
    const FolderClaim claim(folder);
    EXPECT_TRUE(holdsOnly(folder, isOurs));
    std::ofstream(folder / "a").close();
    EXPECT_FALSE(holdsOnly(folder, isOurs));
    EXPECT_FALSE(holdsOnly(folder / "nowhere", isOurs));
}

}  // namespace
}  // namespace aa
