// One line per method; it then appears in `list`, every property test, sweeps and reports.
#include "methods/method.h"
#include "methods/noaa.h"

namespace aa {

const std::vector<MethodDescriptor>& registry() {
    static const std::vector<MethodDescriptor> methods = {
        noaaDescriptor(),
    };
    return methods;
}

}  // namespace aa
