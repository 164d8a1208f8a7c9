#include "gpu/forms.h"

namespace aa::gpu {

std::vector<Form> fsr2nForms() { return {}; }

}  // namespace aa::gpu
