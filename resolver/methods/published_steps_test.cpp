// docs/published_steps.md says which options give each published step; what it says must be accepted.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "image/error.h"
#include "methods/method.h"
#include "methods/spec.h"

namespace aa {
namespace {

TEST(PublishedSteps, EveryOptionStringOfThePageIsAccepted) {
    const std::filesystem::path page = std::filesystem::path(AA_SOURCE_DIR) / "docs" / "published_steps.md";
    std::ifstream file(page);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    size_t count = 0;
    for (size_t from = 0; (from = text.find('`', from)) != std::string::npos;) {
        const size_t to = text.find('`', from + 1);
        ASSERT_NE(to, std::string::npos) << page << ": a back quote without its other";
        const std::string method = text.substr(from + 1, to - from - 1);
        EXPECT_NO_THROW(parseMethod(method)) << page << ": " << method;
        count++, from = to + 1;
    }
    EXPECT_GE(count, 60u) << page;
}

// What is published for one step acts in it alone: elsewhere it is refused, with the setting that it waits for.
TEST(PublishedSteps, AnOptionThatActsInNoOtherModeIsRefusedThere) {
    for (const char* method : {"salvi:neighbourhood=plus", "falcor:neighbourhood=plus", "donut:neighbourhood=plus",
                               "raptor:temporalFiltering=off"}) {
        try {
            parseMethod(method);
            ADD_FAILURE() << method;
        } catch (const UsageError& e) {
            EXPECT_NE(std::string(e.what()).find("has no effect unless"), std::string::npos) << e.what();
        }
    }
}

}  // namespace
}  // namespace aa
