// Facts about single frames that come from a file of their own: the jitter and the cameras of an import.
#pragma once
#include "shot/manifest.h"

namespace aa {

// What a file written like shot.json says of single frames: {"frames": [{"frame": 1, "jitter": [x, y], "camera": {...},
// "reset": true}]}; further members are ignored, so a shot.json serves, too. `jitter` of the document as well.
struct FrameNotes {
    struct Note {
        std::optional<glm::dvec2> jitterPx;
        std::optional<Camera> camera;
        bool reset = false;
    };
    std::map<int, Note> frames;
    std::string jitterSequence = "file";
    int jitterStart = 0, jitterPeriod = 1;
    bool jitterPremultiplied = false;
};
// The same from a document that is part of `file`, which errors name.
FrameNotes parseFrameNotes(const nlohmann::json& document, const std::filesystem::path& file);
FrameNotes readFrameNotes(const std::filesystem::path& file);  // throws InputError

}  // namespace aa
