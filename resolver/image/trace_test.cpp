#include "image/trace.h"

#include <gtest/gtest.h>

#include "image/json_text.h"

namespace aa {
namespace {

TEST(Trace, SpansLieInEachOtherAndOnTheirThreads) {
    const auto file = std::filesystem::path(testing::TempDir()) / "aa_trace.json";
    Trace trace;
    {
        const Trace::Span outer(&trace, "frame", "1");
        const Trace::Span inner(&trace, "resolve", "\"noaa\"");
        std::thread([&] { const Trace::Span other(&trace, "decode"); }).join();
        const Trace::Span off(nullptr, "nothing");
    }
    trace.write(file);
    const auto all = parseJson(*textOf(file), "trace", "");
    std::map<std::string, nlohmann::json> named;
    for (const auto& e : all.at("traceEvents"))
        if (e.at("ph") == "X") named[e.at("name")] = e;
    ASSERT_EQ(named.size(), 3);
    const auto &outer = named.at("frame 1"), &inner = named.at("resolve \"noaa\""), &other = named.at("decode");
    EXPECT_EQ(outer.at("tid"), inner.at("tid"));
    EXPECT_NE(outer.at("tid"), other.at("tid"));
    EXPECT_EQ(inner.at("cat"), "resolve");
    const auto end = [](const nlohmann::json& e) { return e.at("ts").get<double>() + e.at("dur").get<double>(); };
    EXPECT_LE(outer.at("ts"), inner.at("ts"));
    EXPECT_LE(end(other), end(inner));
    EXPECT_LE(end(inner), end(outer));
    std::filesystem::remove(file);
}

}  // namespace
}  // namespace aa
