// Frames of an engine become a shot: EXR files, one for each pass and frame or one multilayer file for each frame, read
// by the conventions that a layout states (engine_layout.h). Like importBlender it keeps what is finished and never
// touches a foreign folder.
#pragma once
#include "shot/import/engine_layout.h"
#include "shot/import/import.h"

namespace aa {

struct EngineImportOptions {
    std::filesystem::path from, layout, out;
    std::string name;  // empty: the layout's
};
// goOn as in importBlender. Throws UsageError, InputError.
ImportReport importEngine(const EngineImportOptions& options, const std::function<bool(int)>& goOn = {});
// Frames that the layout's colour files give; for progress.
size_t engineFrames(const EngineImportOptions& options);

}  // namespace aa
