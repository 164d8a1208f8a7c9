#include "gpu/forms.h"

namespace aa::gpu {

std::vector<Form> resolveFiltersForms() { return {}; }

}  // namespace aa::gpu
