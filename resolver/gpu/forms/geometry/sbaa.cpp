#include "gpu/forms.h"

namespace aa::gpu {

std::vector<Form> sbaaForms() { return {}; }

}  // namespace aa::gpu
