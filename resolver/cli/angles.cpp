#include "report/angles.h"

#include <algorithm>
#include <cstdio>
#include <iostream>

#include "cli/choose.h"
#include "cli/cli.h"
#include "image/error.h"
#include "image/io.h"

namespace aa {
namespace {
constexpr int kLeastSizePx = 16, kMostSizePx = 4096;
struct AnglesArguments {
    std::vector<std::string> methods;
    std::string out;
    AngleStudyOptions study;
    std::string size = std::to_string(study.sizePx) + "x" + std::to_string(study.sizePx);
    bool json = false;
    WorkOptions work;
};

void printTable(const AngleStudy& s) {
    size_t width = 6;
    for (const auto& m : s.methods) width = std::max(width, m.text.size());
    std::printf("%zu directions, %d offsets, PSNR gain over noaa in dB\n%-*s %8s %16s %16s %9s %9s  %s\n",
                s.degrees.size(), s.offsets, int(width), "method", "pooled", "least", "most", "mirrored", "turned",
                "sub-samples");
    for (size_t m = 0; m < s.methods.size(); m++) {
        size_t least = 0, most = 0;
        for (size_t k = 1; k < s.degrees.size(); k++) {
            if (s.gainDb(m, k) < s.gainDb(m, least)) least = k;
            if (s.gainDb(m, k) > s.gainDb(m, most)) most = k;
        }
        std::printf("%-*s %8.2f %8.2f at %4.0f %8.2f at %4.0f %9.3f %9.3f  %s\n", int(width), s.methods[m].text.c_str(),
                    s.pooledGainDb(m), s.gainDb(m, least), s.degrees[least], s.gainDb(m, most), s.degrees[most],
                    s.mirrorAsymmetryDb(m), s.turnAsymmetryDb(m),
                    s.methods[m].subsamples.empty() ? "-" : s.methods[m].subsamples.c_str());
    }
    std::printf(
        "mirrored, turned: largest difference of the gain between an edge and its mirror image or quarter turn\n");
}

void execute(AnglesArguments& o) {
    o.study.methods = chosen(o.methods);
    const auto [width, height] = sizeOf("--size", o.size);
    if (width != height || width < kLeastSizePx || width > kMostSizePx)
        throw UsageError("--size: expected a square of " + std::to_string(kLeastSizePx) + " to " +
                         std::to_string(kMostSizePx) + " px, found '" + o.size + "'");
    o.study.sizePx = width;
    if (!o.out.empty()) makeWritableFolder(o.out);  // before the minutes that the study takes
    AngleStudy study;
    withThreads(o.work.threads, [&] { study = studyAngles(o.study, o.work.exec()); });
    if (!o.out.empty()) {
        const std::filesystem::path folder = o.out;
        writeText(folder / "angles.json", toJsonText(study));
        writeText(folder / "angles.csv", toCsvText(study));
        writeText(folder / "angles.svg", toSvgText(study));
    }
    if (o.json)
        std::cout << toJsonText(study) << "\n";
    else
        printTable(study);
    if (!o.json && !o.out.empty()) std::printf("results: %s\n", (std::filesystem::path(o.out) / "angles.json").c_str());
}
}  // namespace

void addAngles(CommandLine& line, Context&) {
    auto o = std::make_shared<AnglesArguments>();
    Command c = line.command("angles", "What methods gain on a straight edge, by its direction");
    addMethodOption(c, o->methods, "a method", false).required();
    c.option("-o,--out", o->out,
             "folder for angles.json, angles.csv and angles.svg; in that of a run, its report shows them, too")
        .typeName("FOLDER");
    c.option("--angles", o->study.angles, "number of directions, a multiple of 4").range(4, 3600);
    c.option("--offsets", o->study.offsets, "sub-pixel offsets per direction").range(1, 256);
    c.option("--size", o->size, "size of a picture, a square, px").typeName("WxH");
    c.option("--frames", o->study.frames, "jittered frames for methods that accumulate").range(1, 1024);
    c.option("--jitter", o->study.jitter, "jitter sequence of those frames (`synth --list`)");
    c.flag("--json", o->json, "print angles.json instead of the table");
    addWorkOptions(c, o->work);
    c.run([o] { execute(*o); });
}

}  // namespace aa
