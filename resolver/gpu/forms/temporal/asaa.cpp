#include "gpu/forms.h"

namespace aa::gpu {

std::vector<Form> asaaForms() { return {}; }

}  // namespace aa::gpu
