// Pictures that were made elsewhere (an engine's own anti-aliasing, a vendor's library) as one more method of a run: it
// is held against the same truth, over time and in pictures, by the same protocol. What only a run of ours can say,
// time and memory, it has not.
#pragma once
#include <filesystem>
#include <string>

#include "methods/spec.h"

namespace aa {

inline constexpr std::string_view kExternalFamily = "external";
inline bool isExternal(const MethodSpec& spec) { return spec.method->family == kExternalFamily; }

// `folder` holds one picture for each frame: EXR (linear, as the shot's colour) or PNG (display-encoded: what the
// protocol's exposure and tone map would have given). The last number in a file's name is its frame. `chain` is the
// protocol's. Throws UsageError: a name that is taken or cannot be a folder; InputError: no such folder, no pictures,
// two pictures of one frame, both kinds. While it runs: a frame is missing, of another size or kind, or holds NaN or
// Inf.
MethodSpec externalMethod(const std::string& name, const std::filesystem::path& folder, const DisplayChain& chain);
// "dlss=frames/dlss". Throws UsageError.
MethodSpec externalMethod(const std::string& nameAndFolder, const DisplayChain& chain);

}  // namespace aa
