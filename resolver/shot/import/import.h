// A folder of Blender's own multilayer EXRs becomes a shot.
//
// What a plain render lacks is said, not invented: sub-samples and edge distances never exist, motion only with the
// Vector pass, and so on. Every conversion is that of the exporter (blender_addon): motion by blender_motion.h, albedo
// from the denoising albedo, ids from the pass index (or Cryptomatte), depth as it is.
//
//   OUT/.aa/import.json          the settings; another import into the same folder is refused
//   OUT/.aa/frames/000001.json   one record per finished frame, so that an interrupted import goes on where it stopped
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "shot/frame.h"
#include "shot/manifest.h"

namespace aa {

struct ImportOptions {
    std::filesystem::path from, out;
    std::string viewLayer, view;  // empty: the only one
    std::string name;             // empty: that of the folder
    double fps = 24;
    std::string ids = "auto";                  // "index", "cryptomatte"; auto: the index unless it is 0 everywhere
    std::vector<std::filesystem::path> truth;  // folders with the independent halves a and b; one: no error bar
    std::string truthFilter = "unknown";       // as rendered: Blender does not record it
    double truthFilterWidthPx = 0;
    std::filesystem::path jitter;  // FrameNotes with the jitter of every frame; empty: none
    std::filesystem::path camera;  // FrameNotes with matrices; empty: none
    bool isStatic = false;         // camera and objects rest; otherwise found in the pixels
};

struct ImportReport {
    Manifest manifest;
    PassSet passes;
    struct Missing {
        Pass pass;
        std::string advice;  // what to switch on in Blender
    };
    std::vector<Missing> missing;
    std::vector<std::string> notes;     // what was decided, replaced or left out
    std::vector<std::string> warnings;  // what looks wrong in the render, and what to do
    size_t imported = 0, kept = 0;      // frames converted now, frames of an earlier call
    bool complete = true;
};

// goOn(frame) is called after each frame; false ends the import there, and the shot is complete in itself. Throws
// UsageError (several view layers, a foreign folder, other settings than before) and InputError (one line).
ImportReport importBlender(const ImportOptions& options, const std::function<bool(int)>& goOn = {});

}  // namespace aa
