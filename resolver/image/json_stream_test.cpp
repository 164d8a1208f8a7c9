#include "image/json_stream.h"

#include <gtest/gtest.h>

#include <sstream>

namespace aa {
namespace {

TEST(JsonStream, LaysOutAsTheTreeWould) {
    std::ostringstream out;
    JsonStream::write(out, [](JsonStream& j) {
        j.value("text", "two\nlines, \"quoted\", \xff");
        j.value("list", {1, 2.5, nullptr});
        j.object("nothing", [] {});
        j.list("none", [] {});
        j.object("inner", [&] {
            j.value("tree", {{"a", {1, 2}}, {"b", nlohmann::ordered_json::object()}});
            j.list("each", [&] {
                j.element([&] { j.value("n", 1); });
                j.element([] {});
            });
        });
        j.value("last", true);
    });
    const nlohmann::ordered_json tree = {
        {"text", "two\nlines, \"quoted\", \xff"},
        {"list", {1, 2.5, nullptr}},
        {"nothing", nlohmann::ordered_json::object()},
        {"none", nlohmann::ordered_json::array()},
        {"inner",
         {{"tree", {{"a", {1, 2}}, {"b", nlohmann::ordered_json::object()}}},
          {"each", nlohmann::ordered_json::array({{{"n", 1}}, nlohmann::ordered_json::object()})}}},
        {"last", true},
    };
    EXPECT_EQ(out.str(), jsonText(tree));
}

}  // namespace
}  // namespace aa
