// The measures of kernels/sadp.h by name, for hosts and kernels.
#pragma once

namespace aa {
enum class Dissimilarity { sadp, depth, normal };
}
