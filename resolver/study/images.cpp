#include "study/images.h"

#include <cstdio>

#include "image/io.h"

namespace aa {
namespace fs = std::filesystem;
namespace {

std::string frameName(int frame, const char* extension) {
    char text[32];
    std::snprintf(text, sizeof text, "%06d%s", frame, extension);
    return text;
}
}  // namespace

std::string writeImage(const RunningMethod& m, int frame, const RunOptions& o) {
    const fs::path folder = m.spec.folderName();
    std::string written;
    if (o.writePng) {
        written = (folder / frameName(frame, ".png")).string();
        if (o.dither) {
            Rgb dithered = m.shown();
            dither8(dithered, frame, o.exec);
            writePng(o.out / written, dithered);
        } else {
            writePng(o.out / written, m.shown());
        }
    }
    if (o.writeExr) {
        written = (folder / frameName(frame, ".exr")).string();
        const DisplayChain& display = o.protocol.display;
        if (m.spec.outputSpace() == Space::linear && display.transfer != Transfer::identity) {
            writeExr(o.out / written, m.out, false);
        } else {
            Rgb linear;
            decode(m.out, display, o.exec, linear);
            writeExr(o.out / written, linear, true);
        }
    }
    if (o.debugLayers)
        if (const auto layers = m.method->debugLayers(); !layers.empty())
            writeLayers(o.out / folder / frameName(frame, ".layers.exr"), layers);
    return written;
}

void writeMaps(const RunningMethod& m, const Reference& measured, int frame, const RunOptions& o,
               const std::function<PlaneF(const MapKind&)>& sequenceMap) {
    if (o.maps.empty()) return;
    const auto& region = o.protocol.region;
    const Rgb part = region ? cropped(m.shown(), *region) : Rgb();
    for (const MapKind* kind : o.maps) {
        const PlaneF values = kind->drawValues ? sequenceMap(*kind) : PlaneF();
        if (kind->drawValues && values.empty()) continue;
        const fs::path folder = o.out / "maps" / kind->name / m.spec.folderName();
        if (!fs::is_directory(folder)) makeWritableFolder(folder);
        writePng(folder / frameName(frame, ".png"),
                 kind->drawValues ? kind->drawValues(values)
                                  : kind->draw(region ? part : m.shown(), measured.encoded, o.exec));
    }
}

std::string writeTruthImage(const Reference& reference, int frame, const RunOptions& o) {
    std::string written;
    if (o.writePng) {
        written = (fs::path("truth") / frameName(frame, ".png")).string();
        writePng(o.out / written, reference.encoded);
    }
    if (o.writeExr) {
        written = (fs::path("truth") / frameName(frame, ".exr")).string();
        writeExr(o.out / written, reference.linear, o.protocol.display.transfer == Transfer::identity);
    }
    return written;
}

}  // namespace aa
