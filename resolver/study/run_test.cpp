#include "study/run.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <thread>

#include "image/error.h"
#include "image/io.h"
#include "image/json_text.h"
#include "image/png.h"
#include "shot/synth/synth.h"
#include "study/prepare.h"
#include "study/sweep.h"
#include "study/warm_up.h"

namespace aa {
namespace {
namespace fs = std::filesystem;

// A shot of a few small frames, made once.
const ShotReader& shot(const std::string& scene) {
    static std::map<std::string, ShotReader> made;
    if (const auto found = made.find(scene); found != made.end()) return found->second;
    SynthOptions o;
    o.scene = scene, o.width = 48, o.height = 32, o.frames = 4, o.period = 4;
    const fs::path folder = fs::temp_directory_path() / ("aaresolve_study_" + scene + "_" + std::to_string(::getpid()));
    writeSynth(o, folder);
    return made.emplace(scene, ShotReader(folder)).first->second;
}
RunOptions optionsFor(const std::string& scene, std::initializer_list<std::string> methods) {
    RunOptions o;
    for (const auto& m : methods) o.methods.push_back(parseMethod(m));
    o.frames = selectFrames(shot(scene).manifest(), "");
    o.out = fs::temp_directory_path() / ("aaresolve_study_out_" + std::to_string(::getpid()));
    o.writeExr = false;
    return o;
}

TEST(Study, ARunTellsEveryStepAndJudgesAStaticShotAtItsLastFrame) {
    const RunOptions o = optionsFor("half_planes", {"noaa", "accum", "taaSimplest"});
    std::vector<std::string> notes;
    const RunResults r = run(shot("half_planes"), o, {[&](const std::string& note) { notes.push_back(note); }});
    EXPECT_EQ(notes.size(), stepsOf(o, shot("half_planes").manifest()));
    EXPECT_EQ(notes.back(), "frame 4");
    ASSERT_EQ(r.methods.size(), 3u);
    for (const auto& m : r.methods) {
        ASSERT_EQ(m.frames.size(), 4u);
        EXPECT_FALSE(m.frames[2].judged);
        EXPECT_TRUE(m.frames[3].judged);
        EXPECT_EQ(m.pooled->frames, 1);
        EXPECT_EQ(m.pooled->mean.mse, m.frames[3].metrics->mse);
    }
    EXPECT_GT(*r.methods[1].pooled->gainDb, 0);
    EXPECT_TRUE(fs::exists(o.out / "results.json"));
}
TEST(Study, AnInterruptedRunHoldsTheFramesThatWereFinished) {
    const RunOptions o = optionsFor("moving", {"noaa", "uncharted"});
    int steps = 0;
    const RunResults r = run(shot("moving"), o, {[&](const std::string&) { steps++; }, [&] { return steps >= 2; }});
    EXPECT_EQ(r.methods[0].frames.size(), 2u);
    EXPECT_EQ(r.methods[1].frames.size(), 2u);
}
// Side by side or one after the other, with a method that others are held against, a mask that a peer reads, and
// pictures.
TEST(Study, MethodsSideBySideGiveWhatTheyGiveAlone) {
    for (const std::string reference : {"", "smaa1x"}) {
        RunOptions o = optionsFor("moving", {"noaa", "accumReject", "accumReject+fill=fxaa311", "smaa1x", "inside",
                                             "karis", "taaSimplest+sharpen=norm", "fxaa311"});
        o.protocol.reference = reference;
        o.writePng = true;
        o.writeAllFrames = true;
        std::map<std::string, std::string> figures[2], pictures[2];
        for (const bool parallel : {false, true}) {
            o.exec.parallel = parallel;
            fs::remove_all(o.out);
            for (const auto& m : run(shot("moving"), o, {}).methods) {
                std::string& all = figures[parallel][m.text];
                for (const auto& f : m.frames) {
                    if (f.metrics) all += std::to_string(f.metrics->mse) + " " + std::to_string(f.metrics->psnr) + " ";
                    for (const auto& [name, value] : f.metrics ? f.metrics->others : FrameMetrics().others)
                        all += std::string(name) + " " + std::to_string(value) + " ";
                    all += std::to_string(f.rejected ? f.rejected->sum : -1) + "\n";
                    pictures[parallel][f.image] = *textOf(o.out / f.image);
                }
            }
        }
        EXPECT_EQ(figures[0], figures[1]) << reference;
        EXPECT_EQ(pictures[0].size(), 8 * 4) << reference;
        EXPECT_TRUE(pictures[0] == pictures[1]) << reference;
        EXPECT_TRUE(fs::remove_all(o.out));
    }
}
TEST(Study, TimesAreOfTheProcessorAndRepeated) {
    const RunResults r = run(shot("moving"), optionsFor("moving", {"noaa", "fxaa311", "taaSimplest"}), {});
    ASSERT_TRUE(r.load);
    EXPECT_GE(r.load->processors, 1);
    EXPECT_EQ(r.methods[1].timings, 3 + 4) << "four frames, resolved twice, the first one of all left out";
    EXPECT_EQ(r.methods[2].timings, 3) << "what keeps a history is resolved once a frame";
    for (const auto& m : r.methods) {
        EXPECT_GT(m.secondsLow, 0);
        EXPECT_LE(m.secondsMin, m.secondsLow);
        EXPECT_LE(m.secondsLow, m.secondsMedian);
        EXPECT_LE(m.secondsMedian, m.secondsHigh);
        EXPECT_GT(m.wallMedian, 0);
        EXPECT_DOUBLE_EQ(m.nsPerPixel, m.secondsMedian * 1e9 / (48 * 32));
    }
    MachineLoad quiet{.before = 0.2, .processors = 8}, full{.before = 6, .processors = 8},
        waiting{.before = 0.2, .processors = 8, .waited = 0.3};
    EXPECT_FALSE(quiet.busy());
    EXPECT_TRUE(full.busy());
    EXPECT_TRUE(waiting.busy());
}
// A sum that other threads run counts; what the thread itself does not run (a sleep) does not.
TEST(Study, ProcessorTimeCountsTheThreadsThatHelp) {
    std::atomic<double> sink = 0;
    const auto work = [&] {
        const ProcessorTime time;
        parallelRows(64, 1, [&](int y0, int y1) {
            double sum = 0;
            for (int i = 0; i < 200'000 * (y1 - y0); i++) sum += std::sqrt(double(i + y0));
            sink = sum;
        });
        return time.seconds();
    };
    work();
    const ProcessorTime alone;
    double sum = 0;
    for (int i = 0; i < 200'000 * 64; i++) sum += std::sqrt(double(i));
    sink = sum;
    const double one = alone.seconds();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    EXPECT_LT(alone.seconds() - one, 0.05);
    const double shared = work();
    EXPECT_GT(shared, 0.5 * one);
    EXPECT_LT(shared, 3 * one);
}
TEST(Study, AFullHistoryRunsTenPeriodsBefore) {
    RunOptions o = optionsFor("half_planes", {"noaa", "uncharted"});
    o.protocol.history = History::full;
    EXPECT_EQ(stepsOf(o, shot("half_planes").manifest()), 4u * (1 + 10));
    EXPECT_EQ(run(shot("half_planes"), o, {}).warmUpFrames, 40u);
    o.methods = {parseMethod("noaa")};  // nothing accumulates
    EXPECT_EQ(stepsOf(o, shot("half_planes").manifest()), 4u);
    RunOptions moving = optionsFor("moving", {"uncharted"});
    moving.protocol.history = History::full;
    EXPECT_THROW(applyHistory(moving, shot("moving").manifest()), UsageError);
}
TEST(Study, AWarmUpIsTheSameWhetherItsFramesAreKeptOrReadAgain) {
    for (const bool identity : {false, true}) {
        RunOptions o = optionsFor("half_planes", {"uncharted", "master:historyBits=8,dither=on", "inside"});
        o.protocol.history = History::full;
        if (identity) o.protocol.display.transfer = Transfer::identity;
        std::vector<std::vector<Rgb>> last;
        for (const size_t mostBytes : {size_t(0), kMostBytesOfWarmUp}) {
            std::vector<RunningMethod> methods = startMethods(shot("half_planes"), o);
            warmUp(shot("half_planes"), o, methods, 10, {}, mostBytes);
            last.emplace_back();
            for (auto& m : methods) last.back().push_back(std::move(m.out));
        }
        for (size_t m = 0; m < last[0].size(); m++)
            for (size_t c = 0; c < 3; c++)
                for (int y = 0; y < last[0][m].height(); y++)
                    for (int x = 0; x < last[0][m].width(); x++)
                        ASSERT_EQ(last[0][m].c[c].at(x, y), last[1][m].c[c].at(x, y)) << o.methods[m].text;
    }
}
TEST(Study, FiguresThatAreAskedForAreMeasured) {
    RunOptions o = optionsFor("half_planes", {"noaa"});
    const RunResults byDefault = run(shot("half_planes"), o, {});
    for (const char* name : {"flip", "flipFirstQuartile", "flipMedian", "flipThirdQuartile", "ssimRgb"})
        EXPECT_GT(byDefault.methods[0].pooled->mean.figure(name).value(), 0) << name;
    EXPECT_FALSE(byDefault.methods[0].frames[2].metrics->figure("flip")) << "of a static shot the last frame is judged";
    EXPECT_FALSE(byDefault.methods[0].pooled->mean.figure("fmagMse"));
    o.measure = measureOptions({"flip", "fmagMse"});
    const RunResults asked = run(shot("half_planes"), o, {});
    EXPECT_GT(asked.methods[0].frames[2].metrics->figure("flip").value(), 0);
    EXPECT_GT(asked.methods[0].pooled->mean.figure("fmagMse").value(), 0);
    EXPECT_EQ(asked.methods[0].pooled->mean.figure("flip"), byDefault.methods[0].pooled->mean.figure("flip"));
    // Long runs do without what was not asked for.
    EXPECT_TRUE(defaultMetrics({}, 480.0 * 270 * 16 * 42).fit());
    EXPECT_FALSE(defaultMetrics({}, 1920.0 * 1080 * 16 * 20).fit());
    EXPECT_TRUE(defaultMetrics(measureOptions({"flip", "ssimRgb"}), 1e9).fit()) << "nothing is left to add";
    EXPECT_THROW(measureOptions({"flop"}), UsageError);
}
// What a run wrote of a method, or of what it was held against, as it was compared.
Rgb encodedImage(const fs::path& file) {
    Rgb encoded;
    encode(readImage(file).rgb, {}, {}, encoded);
    return encoded;
}
TEST(Study, FiguresOfARegionAreThoseOfItsPixelsAsAPicture) {
    RunOptions o = optionsFor("moving", {"noaa", "taaSimplest"});
    const Window region{9, 5, 35, 20};
    o.writeExr = true;
    o.measure = measureOptions({"fmagMse", "flip"});
    const RunResults whole = run(shot("moving"), o, {});
    o.protocol.region = region;
    const RunResults part = run(shot("moving"), o, {});
    for (size_t k = 0; k < 2; k++) {
        const MethodResult &m = part.methods[k], &all = whole.methods[k];
        EXPECT_NE(m.frames[3].metrics->mse, all.frames[3].metrics->mse);
        const Rgb test = cropped(encodedImage(o.out / m.frames[3].image), region),
                  truth = cropped(encodedImage(o.out / part.truthImages.at(4)), region);
        Reference reference;
        reference.encoded = truth;
        TileErrors tiles;
        const FrameMetrics expected = measure({test}, reference, o.measure, {}, tiles);
        for (const char* figure : {"mse", "psnr", "snr", "ssimLuma", "fmagMse", "flip"})
            EXPECT_EQ(*m.frames[3].metrics->figure(figure), *expected.figure(figure)) << figure;
        EXPECT_EQ(m.tileSquares.size(), 2u);  // 35 x 20 px in tiles of 32
        EXPECT_NE(*m.temporal->tPsnr, *all.temporal->tPsnr);
    }
    o.protocol.region = Window{0, 0, 48, 32};
    EXPECT_EQ(run(shot("moving"), o, {}).methods[1].pooled->mean.mse, whole.methods[1].pooled->mean.mse);
}
TEST(Study, MapsAreWrittenOfWhatIsJudged) {
    RunOptions o = optionsFor("half_planes", {"noaa", "accum"});
    o.out += "_maps";
    fs::remove_all(o.out);
    o.writeExr = true;
    for (const MapKind& kind : mapKinds()) o.maps.push_back(&kind);
    o.protocol.region = Window{9, 5, 35, 20};
    const RunResults r = run(shot("half_planes"), o, {});
    EXPECT_EQ(r.maps.size(), mapKinds().size());
    for (const MapKind& kind : mapKinds()) {
        EXPECT_EQ(r.maps.at(std::string(kind.name)), kind.scale);
        const Rgb map = readImage(o.out / "maps" / kind.name / "noaa/000004.png").rgb;
        if (kind.drawValues) {  // of the whole sequence, which its own tests know: here that it is of this region
            EXPECT_EQ(map.width(), 35);
            EXPECT_NE(codesOf(map), codesOf(Rgb(35, 20)));
            EXPECT_TRUE(r.methods[0].pooled->mean.figure(kind.sequenceFigure)) << "its figures come with it";
            continue;
        }
        const Rgb expected = kind.draw(cropped(encodedImage(o.out / "noaa/000004.exr"), *o.protocol.region),
                                       cropped(encodedImage(o.out / "truth/000004.exr"), *o.protocol.region), {});
        EXPECT_EQ(codesOf(map), codesOf(expected)) << kind.name;
        EXPECT_TRUE(fs::exists(o.out / "maps" / kind.name / "accum/000004.png"));
        EXPECT_FALSE(fs::exists(o.out / "maps" / kind.name / "noaa/000003.png")) << "of a static shot the last alone";
    }
}
TEST(Study, AMethodStandsInForTheTruth) {
    RunOptions o = optionsFor("half_planes", {"noaa", "taaSimplest"});
    o.out += "_stands_in";
    o.writeExr = true;
    judgeAgainst(o, "accum");
    ASSERT_EQ(o.methods.size(), 3u);
    const RunResults r = run(shot("half_planes"), o, {});
    const MethodResult& reference = r.methods[2];
    EXPECT_TRUE(r.isReference(reference));
    EXPECT_FALSE(reference.pooled);
    EXPECT_FALSE(reference.temporal);
    EXPECT_EQ(r.truthNoise, 0.0);
    EXPECT_EQ(r.truthImages, (std::map<int, std::string>{{4, "accum/000004.exr"}}));
    EXPECT_FALSE(fs::exists(o.out / "truth"));
    for (size_t k = 0; k < 2; k++)
        EXPECT_EQ(r.methods[k].pooled->mean.mse, squaredError(encodedImage(o.out / r.methods[k].frames[3].image),
                                                              encodedImage(o.out / "accum/000004.exr"), {})
                                                     .mse);
    EXPECT_EQ(r.pairs.size(), 1u);
    // One that is there already is not run twice, wherever it stands.
    RunOptions first = optionsFor("half_planes", {"accum", "noaa", "taaSimplest"});
    judgeAgainst(first, "accum");
    ASSERT_EQ(first.methods.size(), 3u);
    const RunResults same = run(shot("half_planes"), first, {});
    EXPECT_EQ(same.methods[1].pooled->mean.mse, r.methods[0].pooled->mean.mse);
    RunOptions alone = optionsFor("half_planes", {"noaa"});
    EXPECT_THROW(judgeAgainst(alone, "noaa"), UsageError);
}
// By hand from the pass table (conventions 13.7): 4 bytes a channel, 8 sub-samples.
TEST(Study, MemoryCountsPassesTargetAndState) {
    SynthOptions o;
    o.scene = "moving", o.width = 40, o.height = 24, o.frames = 2, o.period = 4;
    o.subsamples = "d3d8", o.subsampleColor = true;
    const fs::path folder = fs::temp_directory_path() / ("aaresolve_study_memory_" + std::to_string(::getpid()));
    writeSynth(o, folder);
    const ShotReader shot(folder);
    RunOptions r;
    for (const char* m : {"noaa", "taaSimplest", "msaa"}) r.methods.push_back(parseMethod(m));
    r.frames = {0, 1}, r.out = folder / "out", r.writeExr = false;
    const RunResults results = run(shot, r, {});
    const size_t pixels = 40 * 24;
    for (const auto& m : results.methods) EXPECT_EQ(m.targetBytes, pixels * 12);
    EXPECT_EQ(results.methods[0].inputBytes, pixels * 12);
    EXPECT_EQ(results.methods[0].stateBytes, 0u);
    EXPECT_EQ(results.methods[1].inputBytes, pixels * (12 + 8)) << "colour and motion";
    EXPECT_GT(results.methods[1].stateBytes, 0u);
    EXPECT_EQ(results.methods[2].inputBytes, pixels * (12 + 4 + 12 + 4 + 8 * 20 + 8 * 12))
        << "colour, depth, normal, object; of each sub-sample depth, normal, id and colour";
    EXPECT_EQ(results.methods[2].bytes(), results.methods[2].inputBytes + pixels * 12 + results.methods[2].stateBytes);
    fs::remove_all(folder);
}
TEST(Study, FramesAreChosenByNumber) {
    const Manifest& m = shot("moving").manifest();
    EXPECT_EQ(selectFrames(m, ""), (std::vector<size_t>{0, 1, 2, 3}));
    EXPECT_EQ(selectFrames(m, "4,1-2"), (std::vector<size_t>{0, 1, 3}));
    EXPECT_THROW(selectFrames(m, "2-1"), UsageError);
    EXPECT_THROW(selectFrames(m, "9"), InputError);
}
std::string complaint(const ShotReader& shot, std::initializer_list<const char*> methods) {
    std::vector<MethodSpec> specs;
    for (const char* m : methods) specs.push_back(parseMethod(m));
    try {
        requirePasses(shot, specs);
    } catch (const InputError& e) {
        return e.what();
    }
    return "";
}
TEST(Study, MissingPassesAreNamedWithThePicturesThatLackThemAndWhatAddsThem) {
    SynthOptions o;
    o.scene = "moving", o.width = 16, o.height = 12, o.frames = 2, o.period = 4;
    o.wanted = PassSet(Pass::color) | Pass::depth | Pass::normal | Pass::object;
    o.centreWanted = PassSet(Pass::color);
    const fs::path folder = fs::temp_directory_path() / ("aaresolve_study_split_" + std::to_string(::getpid()));
    writeSynth(o, folder);
    const ShotReader split(folder);
    EXPECT_EQ(complaint(split, {"noaa", "fxaa311"}), "");
    const std::string jittered = complaint(split, {"fxaa311", "taaSimplest"});
    EXPECT_NE(jittered.find("'taaSimplest' reads the frames, which lack motion"), std::string::npos) << jittered;
    EXPECT_NE(jittered.find("export with --for taaSimplest,"), std::string::npos) << jittered;
    // The jittered frames have depth, which does not serve a method that reads the pixel centres.
    const std::string centre = complaint(split, {"rsaa:sadpFloor=0.3+sharpen=norm", "noaa", "msaa"});
    EXPECT_NE(centre.find("reads the pictures at the pixel centres, which lack"), std::string::npos) << centre;
    for (const char* pass : {"depth", "subsamples"}) EXPECT_NE(centre.find(pass), std::string::npos) << centre;
    EXPECT_NE(centre.find("--for rsaa:sadpFloor=0.3,msaa,"), std::string::npos) << centre;
    fs::remove_all(folder);
}
TEST(Sweep, ParametersGoBeforeTheStages) {
    EXPECT_EQ(withParameters("uncharted", "kmin=1"), "uncharted:kmin=1");
    EXPECT_EQ(withParameters("uncharted:kmax=1+sharpen=norm", "kmin=1"), "uncharted:kmax=1,kmin=1+sharpen=norm");
    // An exponent starts no stage.
    EXPECT_EQ(withParameters("accumReject:nMaxMoving=1e+1", "nMaxStatic=8"),
              "accumReject:nMaxMoving=1e+1,nMaxStatic=8");
    EXPECT_EQ(withoutStages("accumReject:nMaxMoving=1e+1+sharpen=norm"), "accumReject:nMaxMoving=1e+1");
}
TEST(Sweep, EveryCombinationIsAVariantAndPartsGiveTheSameFigures) {
    SweepOptions o;
    o.methods = {"accumReject:nMaxMoving=1e+1"};
    o.vary = {"nMaxStatic=8,16", "depthTest=window,point"};
    RunOptions run = optionsFor("moving", {});
    run.methods = variantsOf(o);
    ASSERT_EQ(run.methods.size(), 1u + 4);
    EXPECT_EQ(run.methods[4].text, "accumReject:nMaxMoving=1e+1,nMaxStatic=16,depthTest=point");
    Sweep together(shot("moving"), run, o);
    EXPECT_EQ(together.passes(), 1u);
    const RunResults once = together.run({});
    o.memoryMb = 1e-3;  // room for one
    Sweep apart(shot("moving"), run, o);
    EXPECT_EQ(apart.passes(), 5u);
    const RunResults parts = apart.run({});
    ASSERT_EQ(parts.methods.size(), 5u);
    for (size_t k = 0; k < 5; k++) EXPECT_EQ(parts.methods[k].pooled->mean.mse, once.methods[k].pooled->mean.mse);
    EXPECT_EQ(parts.pairs.size(), once.pairs.size());
    judgeAgainst(run, "taaSimplest");
    Sweep against(shot("moving"), run, o);
    EXPECT_EQ(against.passes(), 5u);
    const RunResults held = against.run({});
    ASSERT_EQ(held.methods.size(), 6u);
    EXPECT_TRUE(held.isReference(held.methods[5]));
    for (size_t k = 0; k < 5; k++) EXPECT_NE(held.methods[k].pooled->mean.mse, once.methods[k].pooled->mean.mse);
    o.vary = {"nMaxStatic=8,8"};
    EXPECT_THROW(variantsOf(o), UsageError);
    o.vary = {"nMaxStatic=8", "nMaxStatic=16"};
    EXPECT_THROW(variantsOf(o), UsageError);
}

}  // namespace
}  // namespace aa
