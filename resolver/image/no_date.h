// OpenImageIO would stamp the time of day into files: the same image must give the same file.
#pragma once

namespace aa {
inline constexpr const char* kNoDate = "2000:01:01 00:00:00";
}
