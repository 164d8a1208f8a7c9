#include "methods/method.h"

#include "image/error.h"

namespace aa {

const MethodDescriptor& findMethod(std::string_view id, const std::vector<MethodDescriptor>& among) {
    std::vector<std::string_view> known;
    for (const auto& m : among) {
        if (m.id == id) return m;
        known.push_back(m.id);
    }
    const std::string near = suggestion(id, known);
    throw UsageError("unknown method '" + std::string(id) + "'" +
                     (near.empty() ? "; `aaresolve list` shows all" : "; did you mean '" + near + "'?"));
}

ParamSpec averagedSpaceParam() {
    return choiceParam("space", "linear", {"linear", "encoded"},
                       "values that are averaged: light, or display values as a GL accumulation buffer held",
                       "conventions 4");
}
Space averagedSpace(const Params& p) { return p.choice("space") == "encoded" ? Space::encoded : Space::linear; }

}  // namespace aa
