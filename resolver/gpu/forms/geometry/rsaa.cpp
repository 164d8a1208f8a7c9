#include "gpu/forms.h"

namespace aa::gpu {

std::vector<Form> rsaaForms() { return {}; }

}  // namespace aa::gpu
