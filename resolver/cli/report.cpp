#include <cstdio>

#include "cli/cli.h"
#include "image/error.h"
#include "image/io.h"
#include "report/angles.h"
#include "report/html.h"

namespace aa {
namespace {
namespace fs = std::filesystem;
struct Options {
    std::string run, out, embed = "full";
    double limitMb = 40;
    bool hdr = false;
    WorkOptions work;
};

std::string framesInWords(const std::vector<int>& frames) {
    const auto first = std::to_string(frames.front());
    return frames.size() == 1 ? "frame " + first : "frames " + first + " to " + std::to_string(frames.back());
}

void writeReport(const Options& o) {
    const Exec exec = o.work.exec();
    if (const fs::path folder = o.run; !fs::exists(folder / "results.json") && fs::exists(folder / "angles.json"))
        throw InputError(o.run +
                         ": holds a study of angles and no run; give `aaresolve angles` the -o of a run, whose " +
                         "report then shows it, or open " + (folder / "angles.svg").string());
    const RunResults run = readResults(o.run);
    const std::filesystem::path out =
        o.out.empty() ? std::filesystem::path(o.run) / "report.html" : std::filesystem::path(o.out);
    const EmbedOptions embed{.what = o.embed == "full"    ? Embed::full
                                     : o.embed == "crops" ? Embed::crops
                                                          : Embed::none,
                             .floats = o.hdr,
                             .limitBytes = size_t(o.limitMb * 1e6)};
    withThreads(o.work.threads, [&] {
        const ViewerData viewer = viewerData(run, o.run, embed, exec);
        const std::string page = reportHtml(run, viewer, anglesForReport(o.run));
        writeText(out, page);
        std::printf("%s: %.1f MB, of which pictures %.1f MB", out.c_str(), double(page.size()) / 1e6,
                    double(viewer.textBytes()) / 1e6);
        if (!viewer.views.empty()) {
            const auto& v = viewer.views[0];
            std::printf(" (%s, %d x %d px%s)", framesInWords(v.frames).c_str(), v.window.width, v.window.height,
                        viewer.views.size() > 1 ? " each" : "");
        }
        if (!viewer.leftOut.empty())
            std::printf("; %s left out by --embed-limit %g", framesInWords(viewer.leftOut).c_str(), o.limitMb);
        std::printf("\n");
    });
}
}  // namespace

void addReport(CommandLine& line, Context&) {
    auto o = std::make_shared<Options>();
    Command c = line.command("report", "A run as one HTML file: pictures, figures, charts; needs no network");
    c.option("RUN", o->run, "output folder of `aaresolve run`").required().typeName("RUN");
    c.option("-o,--out", o->out, "the HTML file; default RUN/report.html").typeName("FILE");
    c.option(
         "--embed", o->embed,
         "pictures in the file: full (whole), crops (three parts of 128 x 128 px, where the methods differ most) or "
         "none; of 42 methods at 480 x 270 a frame takes 1 to 4 MB whole and 0.6 MB as crops, all else 1 MB")
        .oneOf({"full", "crops", "none"});
    c.option("--embed-limit", o->limitMb,
             "MB of pictures at most, 0 for no limit: the last frames that fit, and of larger pictures a part")
        .notNegative()
        .typeName("MB");
    c.flag("--hdr", o->hdr,
           "embed linear light as the EXR files hold it, 32-bit floats, instead of the displayed 8-bit codes: exposure "
           "shows what lies beyond white; 4 to 8 times as large");
    addWorkOptions(c, o->work);
    c.run([o] { writeReport(*o); });
}

}  // namespace aa
