#include "gpu/forms.h"

namespace aa::gpu {

std::vector<Form> smaaForms() { return {}; }

}  // namespace aa::gpu
