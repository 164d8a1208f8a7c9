#include "gpu/forms.h"

namespace aa::gpu {

std::vector<Form> deaaForms() { return {}; }

}  // namespace aa::gpu
