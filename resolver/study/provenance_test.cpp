#include "study/provenance.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "image/error.h"
#include "image/io.h"
#include "shot/synth/synth.h"
#include "study/results.h"

namespace aa {
namespace {
namespace fs = std::filesystem;

TEST(Provenance, TheCommandIsWhatAShellReadsBack) {
    const Provenance p = provenanceOf({"aaresolve", "run", "my shot", "-m", "noaa", "-ms", "-o", "out", "--method=x",
                                       "--frames", "1-4", "--out=b", "--json"},
                                      {"-m", "--method", "-o", "--out"}, {"--json"});
    EXPECT_EQ(p.command, "aaresolve run 'my shot' -m noaa -ms -o out --method=x --frames 1-4 --out=b --json");
    EXPECT_EQ(p.rerun, "aaresolve run 'my shot' --frames 1-4");
    RunResults run;
    run.provenance = p;
    MethodResult m;
    m.id = "uncharted", m.text = "uncharted:kmin=1+sharpen=norm", m.folder = "uncharted_kmin=1+sharpen=norm";
    EXPECT_EQ(rerunLine(run, m), p.rerun + " -m uncharted:kmin=1+sharpen=norm -o uncharted_kmin=1+sharpen=norm_again");
    m.family = "external", m.id = m.text = m.folder = "dlss", m.source = "my frames";
    EXPECT_EQ(rerunLine(run, m), p.rerun + " --external 'dlss=my frames' -o dlss_again");
    EXPECT_EQ(rerunLine({}, m), "");
    EXPECT_EQ(shellQuoted("it's"), "'it'\\''s'");
    EXPECT_EQ(shellQuoted(""), "''");
    ASSERT_EQ(p.date.size(), 20u);
    EXPECT_EQ(p.date.back(), 'Z');
    EXPECT_GT(p.machine.cores, 0);
    EXPECT_FALSE(p.machine.instructionSets.empty());
}
TEST(Provenance, TheHashIsOfTheContentAlone) {
    SynthOptions o;
    o.scene = "moving", o.width = 24, o.height = 16, o.frames = 3, o.period = 2;
    const fs::path folder = fs::temp_directory_path() / ("aaresolve_provenance_" + std::to_string(::getpid()));
    fs::remove_all(folder);
    writeSynth(o, folder / "a");
    writeSynth(o, folder / "b");
    const auto hash = [](const fs::path& shot, std::vector<size_t> frames = {0, 1, 2}) {
        return contentHash(readManifest(shot), frames);
    };
    const std::string first = hash(folder / "a");
    EXPECT_EQ(first.size(), 32u);
    EXPECT_EQ(hash(folder / "b"), first) << "the same shot elsewhere";
    EXPECT_NE(hash(folder / "a", {0, 1}), first);
    Manifest timed = readManifest(folder / "b");
    timed.frames[1].renderSeconds["color"] = 4;
    timed.extra["producer"] = {{"name", "another"}};
    writeManifest(timed);
    EXPECT_EQ(hash(folder / "b"), first) << "who wrote it, and how long it took, is not content";
    Manifest moved = timed;
    moved.frames[1].jitterPx.x = -moved.frames[1].jitterPx.x;
    writeManifest(moved);
    EXPECT_NE(hash(folder / "b"), first);
    writeManifest(timed);
    const fs::path picture = folder / "b" / timed.frames[2].file;
    std::fstream file(picture, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(-1, std::ios::end);
    const int last = file.peek();
    file.put(char(last ^ 1));
    file.close();
    EXPECT_NE(hash(folder / "b"), first);
    EXPECT_EQ(hash(folder / "b", {0, 1}), hash(folder / "a", {0, 1})) << "of these frames alone";
    fs::remove(picture);
    EXPECT_THROW(hash(folder / "b"), InputError);
    fs::remove_all(folder);
}

}  // namespace
}  // namespace aa
