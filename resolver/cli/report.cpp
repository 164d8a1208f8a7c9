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
    std::string run, out;
    WorkOptions work;
};

void writeReport(const Options& o) {
    const Exec exec = o.work.exec();
    if (const fs::path folder = o.run; !fs::exists(folder / "results.json") && fs::exists(folder / "angles.json"))
        throw InputError(o.run +
                         ": holds a study of angles and no run; give `aaresolve angles` the -o of a run, whose " +
                         "report then shows it, or open " + (folder / "angles.svg").string());
    const RunResults run = readResults(o.run);
    const std::filesystem::path out =
        o.out.empty() ? std::filesystem::path(o.run) / "report.html" : std::filesystem::path(o.out);
    withThreads(o.work.threads, [&] {
        std::vector<Pictures> pictures;
        for (const int frame : framesToShow(framesWithPictures(run)))
            pictures.push_back(loadPictures(run, o.run, frame, exec));
        writeText(out, reportHtml(run, pictures, anglesForReport(o.run)));
    });
    std::printf("%s\n", out.c_str());
}
}  // namespace

void addReport(CommandLine& line, Context&) {
    auto o = std::make_shared<Options>();
    Command c =
        line.command("report", "A run as one HTML file: figures, charts, before/after slider; needs no network");
    c.option("RUN", o->run, "output folder of `aaresolve run`").required().typeName("RUN");
    c.option("-o,--out", o->out, "the HTML file; default RUN/report.html").typeName("FILE");
    addWorkOptions(c, o->work);
    c.run([o] { writeReport(*o); });
}

}  // namespace aa
