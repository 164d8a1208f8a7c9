// Tests run beside each other, those of one file too: each process gets a folder of its own for what it writes, which
// goes with it.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <string>

namespace {
namespace fs = std::filesystem;

class OwnFolder : public testing::Environment {
    void SetUp() override {
        std::string name = fs::temp_directory_path() / "aaresolve_test_XXXXXX";
        ASSERT_NE(::mkdtemp(name.data()), nullptr) << name;
        folder_ = name;
        ::setenv("TMPDIR", name.c_str(), 1);       // std::filesystem's
        ::setenv("TEST_TMPDIR", name.c_str(), 1);  // GoogleTest's
    }
    void TearDown() override {
        std::error_code left;  // what a test made read-only
        fs::remove_all(folder_, left);
    }
    fs::path folder_;
};
[[maybe_unused]] const testing::Environment* const kOwnFolder = testing::AddGlobalTestEnvironment(new OwnFolder);
}  // namespace
