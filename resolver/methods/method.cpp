#include "methods/method.h"

#include <algorithm>

#include "image/error.h"
#include "methods/family.h"

namespace aa {

PassSet passesOf(const MethodDescriptor& method, const Params& params) {
    return method.morePasses ? method.passes | method.morePasses(params) : method.passes;
}

const MethodDescriptor& findMethod(std::string_view id, const std::vector<MethodDescriptor>& among) {
    std::vector<std::string_view> known;
    for (const auto& m : among) {
        if (m.id == id) return m;
        known.push_back(m.id);
    }
    const std::string unknown = "unknown method '" + std::string(id) + "'";
    if (id.find('=') != std::string_view::npos)
        throw UsageError(unknown + "; parameters stand behind METHOD: as NAME=VALUE");
    constexpr size_t kMostNames = 6;  // of a message that one still reads
    std::vector<std::string_view> like;
    for (const auto& m : among)
        if (isSearchedBy(id, m.id, m.title, m.family)) like.push_back(m.id);
    std::string names;
    for (size_t i = 0; i < std::min(like.size(), kMostNames); i++) names += (i ? ", " : "") + std::string(like[i]);
    if (like.size() > kMostNames) names += " and " + std::to_string(like.size() - kMostNames) + " more";
    if (like.size() > 1)
        throw UsageError(unknown + "; there are " + names + " (`aaresolve list " + std::string(id) + "`)");
    const std::string near = like.size() == 1 ? std::string(like[0]) : suggestion(id, known);
    throw UsageError(unknown + (near.empty() ? "; `aaresolve list` shows all" : "; did you mean '" + near + "'?"));
}

ParamSpec averagedSpaceParam() {
    return choiceParam("space", "linear", {"linear", "encoded"},
                       "values that are averaged: light, or display values as a GL accumulation buffer held",
                       "conventions 4");
}
Space averagedSpace(const Params& p) { return p.choice("space") == "encoded" ? Space::encoded : Space::linear; }

}  // namespace aa
