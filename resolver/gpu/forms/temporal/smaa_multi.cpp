#include "gpu/forms.h"

namespace aa::gpu {

std::vector<Form> smaaMultiForms() { return {}; }

}  // namespace aa::gpu
