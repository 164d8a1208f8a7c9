#include "gpu/forms.h"

namespace aa::gpu {

std::vector<Form> edgeBlurForms() { return {}; }

}  // namespace aa::gpu
