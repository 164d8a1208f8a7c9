#include "gpu/forms.h"

namespace aa::gpu {

std::vector<Form> mlaaForms() { return {}; }

}  // namespace aa::gpu
