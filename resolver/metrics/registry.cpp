// One line per metric; it then appears in `run --metrics`, `compare --metrics`, results, sheets and reports.
#include <algorithm>

#include "image/error.h"
#include "metrics/banding.h"
#include "metrics/cvvdp.h"
#include "metrics/differences.h"
#include "metrics/flip.h"
#include "metrics/fourier.h"
#include "metrics/hdr_flip.h"
#include "metrics/luma709.h"
#include "metrics/metric.h"
#include "metrics/metrics.h"

namespace aa {

const std::vector<Metric>& metrics() {
    static const std::vector<Metric> all = {
        squaredErrorMetric(), ssimLumaMetric(), ssimRgbMetric(),     ssimMatlab3DMetric(), ssimValidMetric(),
        luma709Metric(),      flipMetric(),     hdrFlipMetric(),     cvvdpMetric(),        relMseMetric(),
        linearMseMetric(),    absoluteMetric(), contrastSnrMetric(), fourierMetric(),      bandingMetric(),
    };
    return all;
}

const Figure* figureByName(std::string_view name) {
    for (const Metric& m : metrics())
        for (const Figure& f : m.figures)
            if (f.name == name) return &f;
    return nullptr;
}

FigureChoice findFigure(std::string_view given) {
    const std::string_view name = given == "ssim" ? "ssimLuma" : given;
    std::vector<std::string_view> names;
    for (const Metric& m : metrics())
        for (const Figure& f : m.figures) {
            if (f.name == name) return {&m, &f};
            names.push_back(f.name);
        }
    const std::string near = suggestion(name, names);
    throw UsageError("unknown metric '" + std::string(given) + "'" +
                     (near.empty() ? "" : "; did you mean '" + near + "'?") + " (see aaresolve compare --help)");
}

std::string listOfFigures(bool optionalAlone) {
    size_t width = 0;
    for (const Metric& m : metrics())
        for (const Figure& f : m.figures) width = std::max(width, f.name.size());
    std::string all;
    for (const Metric& m : metrics())
        if (!optionalAlone || !m.always)
            for (const Figure& f : m.figures)
                all += "\n  " + std::string(f.name) + std::string(width + 2 - f.name.size(), ' ') + std::string(f.help);
    return all;
}

}  // namespace aa
