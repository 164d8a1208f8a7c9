#include "gpu/forms.h"

namespace aa::gpu {

std::vector<Form> cmaa2Forms() { return {}; }

}  // namespace aa::gpu
