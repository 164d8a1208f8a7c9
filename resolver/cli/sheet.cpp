#include "report/sheet.h"

#include <algorithm>
#include <cstdio>
#include <limits>

#include "cli/cli.h"
#include "image/error.h"
#include "image/io.h"
#include "report/document.h"
#include "study/prepare.h"

namespace aa {
namespace {
constexpr int kNewest = std::numeric_limits<int>::min();  // no frame has this number
struct SheetArguments {
    std::string run, out, frames, arrangement = "rows", page = "free", loop;
    std::vector<std::string> methods, crops, columns;
    int frame = kNewest, zoom = 0;
    double framesPerSecond = 0;
    bool light = false, dark = false;
    WorkOptions work;
};

// Of those that there are, "1-16,20" or "1..16".
std::vector<int> framesOf(const SheetArguments& o, const std::vector<int>& there) {
    std::string has = " (it has pictures of " + std::to_string(there.front());
    has += (there.size() > 1 ? " to " + std::to_string(there.back()) : "") + ")";
    std::vector<int> chosen;
    for (const auto& [first, last] : frameRanges(o.frames)) {
        const size_t before = chosen.size();
        for (const int frame : there)
            if (frame >= first && frame <= last) chosen.push_back(frame);
        if (chosen.size() == before)
            throw InputError(o.run + ": --frames " + o.frames + ": no picture of frame " + std::to_string(first) +
                             (last > first ? " to " + std::to_string(last) : "") + has +
                             "; run with --write-frames all for every frame");
    }
    std::sort(chosen.begin(), chosen.end());
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    return chosen;
}

SheetOptions sheetOptions(const SheetArguments& o, const RunResults& run) {
    SheetOptions s;
    s.page = pageSizeByName(o.page);
    for (const auto& text : o.crops) s.crops.push_back(cropFrom(text, run));
    chooseColumns(s, o.columns);
    s.arrangement = o.arrangement == "grid" ? Arrangement::grid : Arrangement::rows;
    // Paper is light.
    s.light = o.light || (!o.dark && (s.page == PageSize::a4 || s.page == PageSize::a4Portrait));
    s.zoom = o.zoom;
    return s;
}

void draw(const SheetArguments& o) {
    const Exec exec = o.work.exec();
    const RunResults run = readResults(o.run);
    const std::filesystem::path out =
        o.out.empty() ? std::filesystem::path(o.run) / "sheet.png" : std::filesystem::path(o.out);
    const DocumentKind kind = documentKindOf(out, "-o");
    requireWritable(out);
    const SheetOptions options = sheetOptions(o, run);
    const bool loop = !o.loop.empty() || !holdsPages(kind);
    if (loop && !holdsLoops(kind))
        throw UsageError("--loop: expected -o NAME.gif, NAME.apng or NAME.webp, found " + out.string());
    if (loop && options.page != PageSize::free) throw UsageError("--page: no effect on a loop; leave it out");
    const std::vector<size_t> order = chosenMethods(run, o.methods);
    const RunResults few = onlyMethods(run, order);
    const auto there = framesWithPictures(few);
    if (there.empty()) throw InputError(o.run + ": no frame of which every method has an image; " + howToWriteAll(few));
    const auto frames = o.frames.empty() ? std::vector<int>() : framesOf(o, there);
    const int frame = !frames.empty() ? frames.back() : o.frame == kNewest ? there.back() : o.frame;
    const Shown shown{run, order, [&](int number) { return loadPictures(few, o.run, number, exec); }};
    const bool overFrames = loop ? o.loop == "frames" || (o.loop.empty() && frames.size() > 1) : !frames.empty();
    if (overFrames && frames.empty())
        throw UsageError("--loop frames: expected --frames with the frames to play, as in --frames 1-16");
    std::vector<std::filesystem::path> written;
    withThreads(o.work.threads, [&] {
        if (loop) {
            const auto pictures =
                overFrames ? loopOfFrames(shown, frames, options) : loopOfMethods(shown, frame, options);
            const double perSecond = o.framesPerSecond > 0 ? o.framesPerSecond : overFrames ? 8 : 1.25;
            writeLoop(pictures, std::clamp(int(1000 / perSecond + 0.5), 20, 60000), out);
            written = {out};
        } else {
            const auto pages = overFrames ? strips(shown, frames, options) : sheet(shown, frame, options, exec);
            written = writePages(pages, out, "AA Resolve: " + run.shot, options.page == PageSize::free);
        }
    });
    for (const auto& file : written) std::printf("%s\n", file.c_str());
}
}  // namespace

void addSheet(CommandLine& line, Context&) {
    auto o = std::make_shared<SheetArguments>();
    std::string maps;
    for (const MapKind& kind : mapKinds()) maps += ", " + std::string(kind.name);
    Command c =
        line.command("sheet", "A contact sheet of a run, for paper, slide or screen; strips and loops over time");
    c.option("RUN", o->run, "output folder of `aaresolve run`").required().typeName("RUN");
    c.option("-o,--out", o->out,
             "the file, by its ending: .png, .webp (lossless), .pdf; .gif (256 colours), .apng or .webp for a loop; "
             "default RUN/sheet.png")
        .typeName("FILE");
    c.option("-m,--method,--methods", o->methods,
             "methods of the run to show, by text, id or family, comma-separated; default all")
        .oneEach()
        .typeName("METHOD");
    c.option("--crop", o->crops,
             "X,Y,WIDTH,HEIGHT or X,Y,WIDTH,HEIGHT:LABEL, a part to magnify; repeat for more; default where the "
             "methods differ most and not in the same way: three of a sheet, one of strips and loops")
        .oneEach();
    c.option("--columns", o->columns,
             "what a row shows, comma-separated: frame, crops" + maps + "; default frame,crops,error")
        .separatedBy(',');
    c.option("--arrange", o->arrangement, "rows = a row per method; grid = methods side by side, a row per crop")
        .oneOf({"rows", "grid"});
    c.option("--frame", o->frame, "frame to show; default the last that every method wrote").defaultText("");
    c.option("--frames", o->frames, "frames, as 1-16,20: a strip over time per method, or what a loop plays")
        .excludes("--frame");
    c.option("--loop", o->loop, "methods = flip from method to method; frames = play --frames; default what is given")
        .oneOf({"methods", "frames"});
    c.option("--fps", o->framesPerSecond, "pictures a second of a loop; default 8 of frames, 1.25 of methods")
        .range(0.02, 50.0)
        .defaultText("");
    c.option("--zoom", o->zoom, "pixels per pixel of a crop; default what fits").range(1, 64).defaultText("");
    c.option("--page", o->page, "free, a4, a4-portrait or slide (16:9): as many pages as needed")
        .oneOf({"free", "a4", "a4-portrait", "slide"});
    c.flag("--light", o->light, "on white; default for a4");
    c.flag("--dark", o->dark, "on dark grey; default for the others").excludes("--light");
    addWorkOptions(c, o->work);
    c.run([o] { draw(*o); });
}

}  // namespace aa
