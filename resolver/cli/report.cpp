#include <cstdio>

#include "cli/cli.h"
#include "image/io.h"
#include "report/angles.h"
#include "report/html.h"

namespace aa {
namespace {
struct Options {
    std::string run, out;
    WorkOptions work;
};

void writeReport(const Options& o) {
    const Exec exec = o.work.exec();
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
    c.option("RUN", o->run, "output folder of `aaresolve run`").required();
    c.option("-o,--out", o->out, "the HTML file; default RUN/report.html");
    addWorkOptions(c, o->work);
    c.run([o] { writeReport(*o); });
}

}  // namespace aa
