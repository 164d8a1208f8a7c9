#include "gpu/forms.h"

namespace aa::gpu {

std::vector<Form> accumRejectForms() { return {}; }

}  // namespace aa::gpu
