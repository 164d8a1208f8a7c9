#include "gpu/forms.h"

namespace aa::gpu {

std::vector<Form> raptorForms() { return {}; }

}  // namespace aa::gpu
