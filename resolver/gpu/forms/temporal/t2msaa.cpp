#include "gpu/forms.h"

namespace aa::gpu {

std::vector<Form> t2msaaForms() { return {}; }

}  // namespace aa::gpu
