#include "gpu/forms.h"

namespace aa::gpu {

std::vector<Form> msaaForms() { return {}; }

}  // namespace aa::gpu
