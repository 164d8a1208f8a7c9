#include "methods/params.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "image/error.h"

namespace aa {
namespace {
using ::testing::AllOf;
using ::testing::HasSubstr;

enum class Shape { box, tent };
constexpr Choice<Shape> kShapes[] = {{"tent", Shape::tent}, {"box", Shape::box}};
const std::vector<ParamSpec> kTable = {choiceParam("shape", "tent", kShapes, "shape", "ours"),
                                       realParam("radius", "1.5", 0, 4, "px", "ours", "shape=tent"),
                                       intParam("taps", "3", 1, 9, "number", "ours"),
                                       flagParam("wide", false, "whether", "ours")};
template <class Call>
std::string faultOf(const Call& call) {
    try {
        call();
    } catch (const std::logic_error& e) {
        return e.what();
    }
    return "none";
}
std::string faultOfTable(const std::vector<ParamSpec>& table) {
    return faultOf([&] { Params("blur", table, {}); });
}

TEST(Params, ValuesAreThoseOfTheTableOrOfTheUser) {
    const Params p("blur", kTable, {{"radius", "2"}, {"wide", "yes"}});
    EXPECT_EQ(p.real("radius"), 2);
    EXPECT_EQ(p.integer("taps"), 3);
    EXPECT_TRUE(p.flag("wide"));
    EXPECT_TRUE(p.isGiven("wide"));
    EXPECT_FALSE(p.isGiven("taps"));
}
// A choice is read by its text, so the order of neither table nor enum matters.
TEST(Params, ChosenFollowsTheText) {
    EXPECT_EQ(Params("blur", kTable, {}).chosen("shape", kShapes), Shape::tent);
    EXPECT_EQ(Params("blur", kTable, {{"shape", "box"}}).chosen("shape", kShapes), Shape::box);
    EXPECT_EQ(Params("blur", kTable, {}).choiceIndex("shape"), 0u);
}
TEST(Params, WhatTheUserGivesWrongIsAUsageError) {
    for (const auto& [name, value] : {std::pair{"radios", "1"}, {"radius", "9"}, {"taps", "1.5"}, {"shape", "disc"}})
        EXPECT_THROW(Params("blur", kTable, {{name, value}}), UsageError) << name;
    EXPECT_THROW(Params("blur", kTable, {{"shape", "box"}, {"radius", "1"}}), UsageError);
}
// Errors of programming, in every build: method, parameter and file.
TEST(Params, WhatAMethodReadsWrongNamesMethodParameterAndFile) {
    const Params p("blur", kTable, {});
    const auto named = [](const char* parameter, const char* what) {
        return AllOf(HasSubstr("resolver/methods/params_test.cpp:"), HasSubstr("'blur'"), HasSubstr(parameter),
                     HasSubstr(what));
    };
    EXPECT_THAT(faultOf([&] { p.real("radios"); }), named("'radios'", "did you mean 'radius'?"));
    EXPECT_THAT(faultOf([&] { p.realf("radios"); }), named("'radios'", "did you mean 'radius'?"));
    EXPECT_THAT(faultOf([&] { p.real("taps"); }), named("'taps'", "as real, declared as integer"));
    EXPECT_THAT(faultOf([&] { p.integer("radius"); }), named("'radius'", "as integer, declared as real"));
    EXPECT_THAT(faultOf([&] { p.flag("shape"); }), named("'shape'", "as flag, declared as choice"));
    EXPECT_THAT(faultOf([&] { p.choice("wide"); }), named("'wide'", "as choice, declared as flag"));
    EXPECT_THAT(faultOf([&] { p.isGiven("nothing"); }), named("'nothing'", "not in the table"));
    constexpr Choice<int> kOther[] = {{"box", 1}};
    EXPECT_THAT(faultOf([&] { p.chosen("shape", kOther); }), named("'shape'", "lacks 'tent'"));
}
TEST(Params, ATableThatContradictsItselfNamesMethodParameterAndFile) {
    const auto named = [](const char* parameter, const char* what) {
        return AllOf(HasSubstr("resolver/methods/params_test.cpp:"), HasSubstr("'blur'"), HasSubstr(parameter),
                     HasSubstr(what));
    };
    EXPECT_EQ(faultOfTable(kTable), "none");
    EXPECT_THAT(faultOfTable({flagParam("a", true, "", ""), flagParam("a", true, "", "")}), named("'a'", "twice"));
    EXPECT_THAT(faultOfTable({realParam("a", "5", 0, 4, "", "")}), named("'a'", "out of range"));
    EXPECT_THAT(faultOfTable({realParam("a", "1,5", 0, 4, "", "")}), named("'a'", "expected a number"));
    EXPECT_THAT(faultOfTable({choiceParam("a", "boxes", kShapes, "", "")}), named("'a'", "none of its choices"));
    EXPECT_THAT(faultOfTable({flagParam("a", true, "", "", "b=on")}), named("'a'", "no other parameter"));
    EXPECT_THAT(faultOfTable({flagParam("a", true, "", "", "b=yes"), flagParam("b", true, "", "")}),
                named("'a'", "no value that 'b' has"));
}

}  // namespace
}  // namespace aa
