// Which methods a text on the command line chooses, as in "noaa,spatial,uncharted:kmin=0.9,clipTarget=mean".
//
// A comma stands between methods and between the parameters of one. What follows it is a parameter of the method before
// when it reads NAME=VALUE, that is, when '=' comes before any ':', '+' or ','; otherwise a method begins there. That
// leaves no doubt: every parameter has its '=' there, and no method's id has one.
//
// Beside methods there are sets: `all`, the name of a family, and, where there is a shot, `runnable` (all that it can
// serve) and `runnable:FAMILY`. What sets name is taken at its defaults, and once.
#pragma once
#include "methods/spec.h"

namespace aa {

// The methods and sets of a text, as written. Spaces separate like commas.
std::vector<std::string> splitMethods(std::string_view text);
bool isMethodSet(std::string_view text);
// Every set by name with what it is, in the order of the help; `withShot`: those that need a shot, too.
struct MethodSet {
    std::string name, meaning;
};
std::vector<MethodSet> methodSets(bool withShot);

// What a shot cannot serve of the methods that sets name.
using WhyNot = std::function<std::string(const MethodSpec&)>;  // empty: it can
struct ChosenMethods {
    std::vector<MethodSpec> methods;
    std::vector<std::string> leftOut;  // which `runnable` does not hold
};
// Throws UsageError: unknown method, a set with parameters, a method that is given twice, `runnable` without
// `whyNot`; InputError: `all` or a family names a method that the shot cannot serve.
ChosenMethods chooseMethods(const std::vector<std::string>& texts, const WhyNot& whyNot = {});

// Methods for which somebody may have written this word: methods/family.h.
std::vector<const MethodDescriptor*> methodsLike(std::string_view word);

}  // namespace aa
