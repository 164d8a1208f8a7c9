#include "gpu/forms.h"

namespace aa::gpu {

std::vector<Form> fxaaForms() { return {}; }

}  // namespace aa::gpu
