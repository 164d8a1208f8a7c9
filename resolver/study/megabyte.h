// What MB means wherever users read it: 10^6 bytes, in tables and reports of memory as of files.
#pragma once

namespace aa {

inline constexpr double kMegabyte = 1e6;

}  // namespace aa
