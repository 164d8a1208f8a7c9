#include <cstdio>

#include "cli/cli.h"
#include "image/error.h"
#include "image/io.h"
#include "report/angles.h"
#include "report/html.h"
#include "report/stability.h"
#include "report/summary.h"
#include "study/megabyte.h"

namespace aa {
namespace {
namespace fs = std::filesystem;
struct ReportArguments {
    std::vector<std::string> runs;
    std::string out, embed = "full";
    double limitMb = double(EmbedOptions().limitBytes) / kMegabyte;
    bool hdr = false;
    WorkOptions work;
};

std::string framesInWords(const std::vector<int>& frames) {
    const auto first = std::to_string(frames.front());
    return frames.size() == 1 ? "frame " + first : "frames " + first + " to " + std::to_string(frames.back());
}

// Of several runs: methods over scenes.
void writeSummary(const ReportArguments& o) {
    if (const ReportArguments none; o.embed != none.embed || o.limitMb != none.limitMb || o.hdr)
        throw UsageError(
            "report: --embed, --embed-limit and --hdr have no effect on several runs, whose page has no "
            "pictures");
    std::vector<std::pair<std::string, RunResults>> runs;
    for (const std::string& folder : o.runs) {
        const fs::path place = fs::weakly_canonical(folder);
        for (const auto& [other, results] : runs)
            if (fs::weakly_canonical(other) == place) throw UsageError("report: " + folder + " is given twice");
        runs.emplace_back(folder, readResults(folder));
    }
    const fs::path out =
        o.out.empty() ? fs::weakly_canonical(o.runs[0]).parent_path() / "summary.html" : fs::path(o.out);
    writeText(out, summaryHtml(namedRuns(std::move(runs)), out));
    std::printf("%s\n", out.c_str());
}

void writeReport(const ReportArguments& o) {
    const Exec exec = o.work.exec();
    const std::string& given = o.runs[0];
    if (const fs::path folder = given; !fs::exists(folder / "results.json") && fs::exists(folder / "angles.json"))
        throw InputError(given +
                         ": holds a study of angles and no run; give `aaresolve angles` the -o of a run, whose " +
                         "report then shows it, or open " + (folder / "angles.svg").string());
    const RunResults run = readResults(given);
    const fs::path out = o.out.empty() ? fs::path(given) / "report.html" : fs::path(o.out);
    requireWritable(out);
    const EmbedOptions embed{.what = o.embed == "full"    ? Embed::full
                                     : o.embed == "crops" ? Embed::crops
                                                          : Embed::none,
                             .floats = o.hdr,
                             .limitBytes = size_t(o.limitMb * kMegabyte)};
    withThreads(o.work.threads, [&] {
        const ViewerData viewer = viewerData(run, given, embed, exec);
        const std::string page = reportHtml(run, viewer, stabilityForReport(given) + anglesForReport(given));
        writeText(out, page);
        std::printf("%s: %.1f MB, of which pictures %.1f MB", out.c_str(), double(page.size()) / kMegabyte,
                    double(viewer.textBytes()) / kMegabyte);
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
    auto o = std::make_shared<ReportArguments>();
    Command c =
        line.command("report",
                     "A run as one HTML file: pictures, figures, charts; several runs: methods over scenes, and "
                     "runs of one shot against each other; needs no network");
    c.option("RUN", o->runs, "output folder of `aaresolve run`; several for a page of them all")
        .required()
        .typeName("RUN");
    c.option("-o,--out", o->out,
             "the HTML file; default RUN/report.html, of several runs summary.html beside the first")
        .typeName("FILE");
    c.option(
         "--embed", o->embed,
         "pictures in the file: full (whole), crops (three parts of 128 x 128 px, where the methods differ most) or "
         "none; of 42 methods at 480 x 270 a frame takes 1 to 4 MB whole and 0.6 MB as crops, all else 1 MB")
        .oneOf({"full", "crops", "none"});
    c.option("--embed-limit", o->limitMb,
             "MB of pictures at most, 0 for no limit: the last frames that fit, and of larger pictures a part")
        .range(0.0, 1e6)
        .typeName("MB");
    c.flag("--hdr", o->hdr,
           "embed linear light as the EXR files hold it, 32-bit floats, instead of the displayed 8-bit codes: exposure "
           "shows what lies beyond white; about 10 times as large");
    addWorkOptions(c, o->work);
    c.run([o] { o->runs.size() > 1 ? writeSummary(*o) : writeReport(*o); });
}

}  // namespace aa
