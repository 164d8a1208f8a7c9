#include "image/folder_claim.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

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

}  // namespace
}  // namespace aa
