#include <cmath>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/cli.h"
#include "image/error.h"
#include "image/io.h"
#include "image/json_text.h"
#include "methods/geometry/rsaa_lut_data.h"

namespace aa {
namespace {

struct Learned {
    size_t samples, trained;
    RsaaErrors errors;
    double gainDb(double mse) const { return 10 * std::log10(errors.noaa / mse); }
};
Learned learn(size_t samples, RsaaTraining training) {
    const auto positionsPx = d3dPattern(samples);
    const auto entries = learnRsaa(positionsPx, training);
    return {samples, entries.size(), halfPlaneErrors(positionsPx, rsaaTable(samples, entries))};
}
}  // namespace

void addLearnRsaa(CommandLine& line, Context&) {
    struct Options {
        bool json = false;
        std::string training = "all", source;
    };
    auto o = std::make_shared<Options>();
    Command c = line.command("learn-rsaa", "Learns RSAA's offsets for 4, 8 and 16 sub-samples and measures them");
    c.option("--training", o->training, "classes of training pictures").oneOf({"all", "halfPlanes"});
    c.option("-o,--out", o->source, "write the offsets of --training all as C++ source here")
        .defaultText("")
        .typeName("FILE");
    line.renamed("learn-rsaa", "--output", "--out");
    c.flag("--json", o->json, "as JSON");
    c.run([o] {
        const auto training = o->training == "all" ? RsaaTraining::all : RsaaTraining::halfPlanes;
        if (!o->source.empty()) {
            if (training != RsaaTraining::all)
                throw UsageError("learn-rsaa: -o writes the shipped offsets, which need --training all");
            writeText(o->source, learnedRsaaSource());
        }
        nlohmann::ordered_json all = nlohmann::ordered_json::array();
        if (!o->json)
            std::puts("sub-samples  masks  learned  gain over noaa on half-planes: resampled  sub-sample mean");
        for (const size_t samples : {4u, 8u, 16u}) {
            const Learned l = learn(samples, training);
            if (o->json)
                all.push_back({{"samples", l.samples},
                               {"learnedMasks", l.trained},
                               {"noaaMse", l.errors.noaa},
                               {"rsaaMse", l.errors.rsaa},
                               {"msaaMse", l.errors.msaa},
                               {"rsaaGainDb", l.gainDb(l.errors.rsaa)},
                               {"msaaGainDb", l.gainDb(l.errors.msaa)}});
            else
                std::printf("%11zu  %5d  %7zu  %34.2f dB  %12.2f dB\n", l.samples, 1 << l.samples, l.trained,
                            l.gainDb(l.errors.rsaa), l.gainDb(l.errors.msaa));
        }
        if (o->json) std::cout << jsonText(all) << "\n";
    });
}

}  // namespace aa
