#include "gpu/forms.h"

namespace aa::gpu {

std::vector<Form> dmsaaForms() { return {}; }

}  // namespace aa::gpu
