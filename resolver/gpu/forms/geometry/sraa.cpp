#include "gpu/forms.h"

namespace aa::gpu {

std::vector<Form> sraaForms() { return {}; }

}  // namespace aa::gpu
