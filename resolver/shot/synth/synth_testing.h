// What tests of synthetic scenes share.
#pragma once
#include <gtest/gtest.h>

#include "shot/synth/synth.h"

namespace aa {

// Runs the suite, a test with a scene's name as parameter, over all scenes.
#define AA_OVER_ALL_SCENES(suite)                                                  \
    INSTANTIATE_TEST_SUITE_P(All, suite, ::testing::ValuesIn(aa::namesOfScenes()), \
                             [](const auto& info) { return std::string(info.param); })

inline std::vector<std::string_view> namesOfScenes() {
    std::vector<std::string_view> names;
    for (const auto& s : synthScenes()) names.push_back(s.name);
    return names;
}

}  // namespace aa
