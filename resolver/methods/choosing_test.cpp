#include "methods/choosing.h"

#include <gmock/gmock.h>

#include "image/error.h"

namespace aa {
namespace {
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::vector<std::string> textsOf(const ChosenMethods& chosen) {
    std::vector<std::string> texts;
    for (const auto& m : chosen.methods) texts.push_back(m.text);
    return texts;
}
template <class Error>
std::string refusal(const std::vector<std::string>& texts, const WhyNot& whyNot = {}) {
    try {
        chooseMethods(texts, whyNot);
    } catch (const Error& e) {
        return e.what();
    }
    return "nothing was refused";
}

TEST(Choosing, CommasSeparateMethodsAndTheirParameters) {
    EXPECT_THAT(splitMethods("noaa,fxaa311"), ElementsAre("noaa", "fxaa311"));
    EXPECT_THAT(splitMethods("uncharted:kmin=0.9,clipTarget=mean,noaa"),
                ElementsAre("uncharted:kmin=0.9,clipTarget=mean", "noaa"));
    EXPECT_THAT(splitMethods("a:x=1,b:y=2,z=3"), ElementsAre("a:x=1", "b:y=2,z=3"));
    EXPECT_THAT(splitMethods("a+sharpen=norm,b+fill=c:p=1,q=2,d"),
                ElementsAre("a+sharpen=norm", "b+fill=c:p=1,q=2", "d"));
    EXPECT_THAT(splitMethods("a:x=1e+3,y=2+sharpen=norm,b"), ElementsAre("a:x=1e+3,y=2+sharpen=norm", "b"));
    EXPECT_THAT(splitMethods("a, b  c,"), ElementsAre("a", "b", "c"));
    EXPECT_THAT(splitMethods(""), IsEmpty());
}

// A command line that was right before still means the same, for every parameter that there is.
TEST(Choosing, OneMethodWithAllItsParametersStaysOne) {
    for (const auto& m : registry()) {
        std::string text(m.id);
        for (size_t i = 0; i < m.params.size(); i++)
            text += (i ? "," : ":") + std::string(m.params[i].name) + "=" + std::string(m.params[i].defaultValue);
        EXPECT_THAT(splitMethods(text + ",noaa"), ElementsAre(text, "noaa"));
        EXPECT_EQ(m.id.find_first_of("=,:+ "), std::string_view::npos) << m.id;
        EXPECT_FALSE(isMethodSet(m.id)) << m.id << " is the name of a set as well";
    }
}

TEST(Choosing, SetsNameMethodsOnce) {
    EXPECT_EQ(chooseMethods({"all"}).methods.size(), registry().size());
    size_t together = 0;
    for (const char* family : {"reference", "spatial", "geometry", "temporal"}) {
        const auto methods = chooseMethods({family}).methods;
        for (const auto& m : methods) EXPECT_EQ(m.method->family, family);
        together += methods.size();
    }
    EXPECT_EQ(together, registry().size()) << "a family is missing in methods/family.cpp";
    EXPECT_EQ(chooseMethods({"all", "noaa,spatial"}).methods.size(), registry().size());
    EXPECT_EQ(chooseMethods({"all,fxaa311:preset=12"}).methods.size(), registry().size() + 1);
}

TEST(Choosing, RunnableAsksTheShotAndSetsAreWholeOrRefused) {
    const WhyNot noDepth = [](const MethodSpec& m) {
        return std::string(m.passes().has(Pass::depth) ? "no depth" : "");
    };
    const auto chosen = chooseMethods({"runnable:temporal"}, noDepth);
    EXPECT_THAT(textsOf(chosen), testing::Contains("taaSimplest"));
    EXPECT_THAT(textsOf(chosen), Not(testing::Contains("uncharted")));
    EXPECT_THAT(chosen.leftOut, testing::Contains("uncharted"));
    EXPECT_THAT(chosen.leftOut, Not(testing::Contains("msaa")));
    EXPECT_THAT(refusal<InputError>({"temporal"}, noDepth),
                AllOf(HasSubstr("uncharted"), HasSubstr("runnable:temporal")));
    EXPECT_THAT(textsOf(chooseMethods({"uncharted"}, noDepth)), ElementsAre("uncharted"));  // asked for by name
    EXPECT_THAT(refusal<UsageError>({"runnable"}), HasSubstr("there is none here"));
}

TEST(Choosing, WhatCannotBeMeantIsRefused) {
    EXPECT_THAT(refusal<UsageError>({"noaa", "noaa"}), HasSubstr("given twice"));
    EXPECT_THAT(refusal<UsageError>({"spatial:x=1"}), HasSubstr("is a set"));
    EXPECT_THAT(refusal<UsageError>({"all+sharpen=norm"}), HasSubstr("is a set"));
    EXPECT_THAT(refusal<UsageError>({"runnable:fast"}), HasSubstr("expected a family"));
    EXPECT_THAT(refusal<UsageError>({","}), HasSubstr("found nothing"));
    EXPECT_THAT(refusal<UsageError>({"kmin=1"}), HasSubstr("behind METHOD:"));
}

TEST(Choosing, ErrorsNameWhatWasProbablyMeant) {
    EXPECT_THAT(refusal<UsageError>({"fxaa"}), AllOf(HasSubstr("fxaa1, fxaa311"), HasSubstr("list fxaa")));
    EXPECT_THAT(refusal<UsageError>({"taa"}), AllOf(HasSubstr("taaSimplest"), HasSubstr("more")));
    EXPECT_THAT(refusal<UsageError>({"unchartd"}), HasSubstr("did you mean 'uncharted'"));
    EXPECT_THAT(refusal<UsageError>({"ssaax"}), HasSubstr("did you mean 'ssaa'"));
    for (const auto* m : methodsLike("TAA")) EXPECT_EQ(m->family, "temporal") << m->id;
    EXPECT_EQ(methodsLike("taa").size(), chooseMethods({"temporal"}).methods.size());
    EXPECT_THAT(methodsLike("a"), IsEmpty());
}

}  // namespace
}  // namespace aa
