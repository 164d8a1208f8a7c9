// Test support: the methods that the tests run over. Those of the registry, and the skeletons, which are in no registry
// so that no user meets them.
#pragma once
#include "methods/method.h"
#include "methods/spatial/skeleton.h"
#include "methods/spec.h"
#include "methods/temporal/skeleton.h"

namespace aa::testing {

inline const std::vector<MethodDescriptor>& methodsUnderTest() {
    static const std::vector<MethodDescriptor> all = [] {
        std::vector<MethodDescriptor> methods = registry();
        methods.push_back(spatialSkeletonDescriptor());
        methods.push_back(temporalSkeletonDescriptor());
        return methods;
    }();
    return all;
}
inline MethodSpec specUnderTest(std::string_view text) { return parseMethod(text, methodsUnderTest()); }

}  // namespace aa::testing
