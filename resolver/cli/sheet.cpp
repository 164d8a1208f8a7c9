#include "report/sheet.h"

#include <cstdio>

#include "cli/cli.h"
#include "image/error.h"

namespace aa {
namespace {
struct Options {
    std::string run, out;
    int frame = 0;
    WorkOptions work;
};

void drawSheet(const Options& o) {
    const Exec exec = o.work.exec();
    const RunResults run = readResults(o.run);
    const auto frames = framesWithPictures(run);
    if (frames.empty())
        throw InputError(o.run + ": no frame of which every method has an image; run again with --write exr");
    const int frame = o.frame == 0 ? frames.back() : o.frame;
    const std::filesystem::path out =
        o.out.empty() ? std::filesystem::path(o.run) / "sheet.png" : std::filesystem::path(o.out);
    withThreads(o.work.threads, [&] { writeSheet(run, loadPictures(run, o.run, frame, exec), out, exec); });
    std::printf("%s\n", out.c_str());
}
}  // namespace

void addSheet(CommandLine& line, Context&) {
    auto o = std::make_shared<Options>();
    Command c = line.command("sheet", "A contact sheet of a run: methods, magnified details, error maps, figures");
    c.option("RUN", o->run, "output folder of `aaresolve run`").required().typeName("RUN");
    c.option("-o,--out", o->out, "the PNG; default RUN/sheet.png").typeName("FILE");
    c.option("--frame", o->frame, "frame to show; 0 = the last that every method wrote").notNegative();
    addWorkOptions(c, o->work);
    c.run([o] { drawSheet(*o); });
}

}  // namespace aa
