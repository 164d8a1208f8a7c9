#include "study/gate.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "image/error.h"
#include "shot/pass_table.h"
#include "shot/synth/synth.h"
#include "shot/writer.h"
#include "study/prepare.h"
#include "study/run.h"

namespace aa {
namespace {
namespace fs = std::filesystem;
const std::vector<std::string> kMethods = {"noaa", "karis"};

fs::path workFolder() { return fs::temp_directory_path() / ("aaresolve_gate_" + std::to_string(::getpid())); }
// A shot with everything that these methods and the figures over time read; made once.
fs::path shotFolder(const std::string& scene) {
    const fs::path folder = workFolder() / scene;
    if (fs::exists(folder)) return folder;
    SynthOptions o;
    o.scene = scene, o.width = 160, o.height = 96, o.frames = 16, o.period = 8;
    o.wanted = passesOf({parseMethod("karis")}) | temporalMetricPasses();
    o.centreWanted = PassSet(Pass::color);
    writeSynth(o, folder);
    return folder;
}
RunResults runOf(const fs::path& folder, const std::vector<std::string>& methods, int threads = 0) {
    const ShotReader reader(folder);
    RunOptions o;
    for (const auto& m : methods) o.methods.push_back(parseMethod(m));
    o.frames = selectFrames(reader.manifest(), "");
    o.exec.parallel = threads != 1;
    o.measure = measureOptions({"flip"});
    o.out = workFolder() / "out";
    o.writeExr = false;
    return run(reader, o, {});
}
const RunResults& base(const std::string& scene = "moving") {
    static std::map<std::string, RunResults> made;
    if (!made.contains(scene)) made[scene] = runOf(shotFolder(scene), kMethods);
    return made[scene];
}
// As if the program's own method had changed.
RunResults regressed(const std::string& scene, const std::string& parameters) {
    RunResults r = runOf(shotFolder(scene), {"noaa", "karis:" + parameters});
    r.methods[1].text = "karis";
    return r;
}
// The shot, written again as `change` makes it.
template <class Change>
fs::path rewritten(const std::string& scene, const std::string& name, const Change& change) {
    const fs::path to = workFolder() / name;
    fs::remove_all(to);
    fs::copy(shotFolder(scene), to, fs::copy_options::recursive);
    Manifest m = readManifest(to);
    change(m);
    writeManifest(m);
    return to;
}
std::vector<std::string> worse(const GateReport& report) {
    std::vector<std::string> rows;
    for (const GateRow& r : report.rows)
        if (r.verdict == Verdict::worse) rows.push_back(r.method + " " + r.figure);
    return rows;
}
bool names(const GateReport& report, const std::string& row) {
    const auto rows = worse(report);
    return std::find(rows.begin(), rows.end(), row) != rows.end();
}
std::string refusal(const RunResults& before, const RunResults& now) {
    try {
        gate(before, now, {});
    } catch (const InputError& e) {
        return e.what();
    }
    return "";
}

TEST(Gate, ABaseWithoutFiguresHoldsNothing) {
    RunResults blind = base();
    for (MethodResult& m : blind.methods) m.pooled.reset(), m.temporal.reset();
    EXPECT_THROW(gate(blind, blind, {}), InputError);
    EXPECT_THROW(gate(blind, base(), {}), InputError) << "every figure is new";
    GateOptions times;
    addTolerance(times, "time=50%");
    EXPECT_TRUE(gate(blind, blind, times).passed()) << "times are there";
}
TEST(Gate, AnUnchangedRunIsTheSameToTheLastBit) {
    for (int k = 0; k < 20; k++) {
        const RunResults again = runOf(shotFolder("moving"), kMethods, k % 2);
        const GateReport report = gate(base(), again, {});
        EXPECT_TRUE(report.passed());
        EXPECT_EQ(report.count(Verdict::same), report.rows.size()) << "run " << k;
        EXPECT_TRUE(report.notes.empty()) << report.notes[0];
    }
    EXPECT_GE(gate(base(), base(), {}).rows.size(), 8u) << "PSNR, SSIM, FLIP, tPSNR, flicker, ghosts";
}
TEST(Gate, HistoryOffIsWorse) {
    const GateReport report = gate(base("half_planes"), regressed("half_planes", "alpha=1"), {});
    EXPECT_FALSE(report.passed());
    for (const char* row : {"karis psnr", "karis ssimLuma", "karis flip", "karis tPsnr", "karis flickerStatic"})
        EXPECT_TRUE(names(report, row)) << row;
    EXPECT_FALSE(names(report, "noaa psnr"));
    ASSERT_EQ(report.notes.size(), 1u);
    EXPECT_EQ(report.notes[0], "method karis: its parameters were alpha=0.04 and are alpha=1");
}
TEST(Gate, ClampOffIsWorse) {
    const GateReport report = gate(base(), regressed("moving", "box=variance,gamma=8"), {});
    for (const char* row : {"karis psnr", "karis ghostMse", "karis ssimLuma"}) EXPECT_TRUE(names(report, row)) << row;
}
TEST(Gate, MotionOfTheWrongSignIsWorse) {
    const fs::path turned = rewritten("moving", "motion", [](Manifest& m) {
        const ShotReader reader(shotFolder("moving"), InputPolicy::raw);
        for (size_t i = 0; i < m.frames.size(); i++) {
            Frame f = reader.read(i, reader.offered());
            for (PlaneF* plane : {&f.motionXPx, &f.motionYPx})
                for (int y = 0; y < f.height; y++)
                    for (int x = 0; x < f.width; x++)
                        if (std::abs(plane->at(x, y)) < kInvalidMotionPx) plane->at(x, y) = -plane->at(x, y);
            writeFrame(m.folder / m.frames[i].file, f, true);
        }
    });
    const GateReport report = gate(base(), runOf(turned, kMethods), {});
    EXPECT_TRUE(names(report, "karis psnr"));
    EXPECT_FALSE(names(report, "noaa psnr"));
    ASSERT_FALSE(report.notes.empty());
    EXPECT_NE(report.notes[0].find("is not the same: its content was"), std::string::npos) << report.notes[0];
}
TEST(Gate, JitterOfTheWrongSignIsWorse) {
    const fs::path turned = rewritten("half_planes", "jitter", [](Manifest& m) {
        for (auto& f : m.frames) f.jitterPx = -f.jitterPx;
    });
    const GateReport report = gate(base("half_planes"), runOf(turned, kMethods), {});
    EXPECT_TRUE(names(report, "karis psnr"));
    EXPECT_FALSE(names(report, "noaa psnr"));
}
TEST(Gate, ATruthThatLiesBesideIsWorseForEveryMethod) {
    const fs::path beside = rewritten("moving", "truth", [](Manifest& m) {
        for (size_t i = 0; i + 1 < m.frames.size(); i++) m.frames[i].truth = m.frames[i + 1].truth;
    });
    const GateReport report = gate(base(), runOf(beside, kMethods), {});
    for (const char* row : {"noaa psnr", "noaa ssimLuma", "noaa flip"}) EXPECT_TRUE(names(report, row)) << row;
}
TEST(Gate, BetterIsNoFailure) {
    const GateReport report = gate(regressed("half_planes", "alpha=1"), base("half_planes"), {});
    EXPECT_TRUE(report.passed());
    EXPECT_GT(report.count(Verdict::better), 0u);
}
TEST(Gate, ATolerableLossPasses) {
    GateOptions o;
    for (const char* t : {"psnr=60", "ssim=2", "flip=9999%", "tPsnr=60", "flickerStatic=9999%", "relMse=9999%",
                          "flipMedian=9999%", "flipFirstQuartile=9999%", "flipThirdQuartile=9999%", "ssimRgb=2"})
        addTolerance(o, t);
    EXPECT_TRUE(gate(base("half_planes"), regressed("half_planes", "alpha=1"), o).passed());
}
// Two runs of one method with figures made up.
// `apart`: by how much the error of every tile against one half of the truth exceeds that against the other.
RunResults made(std::vector<double> mse, std::vector<double> flip = {}, std::vector<double> tiles = {},
                double apart = 0) {
    RunResults run;
    run.shot = "made", run.width = 256, run.height = 128;
    MethodResult m;
    m.id = m.text = "noaa";
    for (size_t i = 0; i < mse.size(); i++) {
        FrameResult f;
        f.frame = int(i + 1), f.seconds = 1e-3;
        f.metrics = frameMetrics(SquaredError{mse[i], 0.25});
        if (!flip.empty()) f.metrics->others["flip"] = flip[i];
        m.frames.push_back(f);
    }
    run.methods = {m};
    std::vector<TileErrors> errors(1);
    errors[0].sum = tiles.empty() ? std::vector<double>(32, mse[0] * 3072 * double(mse.size())) : tiles;
    errors[0].values.assign(32, 3072.0 * double(mse.size()));
    errors[0].againstA = errors[0].againstB = errors[0].sum;
    for (size_t i = 0; i < 32; i++) {
        errors[0].againstA[i] += i / 2 % 2 ? apart / 2 : -apart / 2;
        errors[0].againstB[i] -= i / 2 % 2 ? apart / 2 : -apart / 2;
    }
    finish(run, errors);
    run.framesAsked = mse.size();
    return run;
}
TEST(Gate, AnIntervalThatHoldsZeroIsNamedAndPasses) {
    std::vector<double> quiet(32, 3072 * 0.01), lost = quiet;
    for (double& v : lost) v *= 1.26;  // 1 dB
    const RunResults a = made({0.01}, {}, quiet);
    // Against one half of the truth that much worse, against the other better: its noise may have done it.
    const RunResults b = made({0.0126}, {}, lost, 3072 * 0.02);
    const GateReport report = gate(a, b, {});
    EXPECT_TRUE(report.passed());
    EXPECT_EQ(report.count(Verdict::unresolved), 1u);
    std::vector<double> even = quiet;
    for (double& v : even) v *= 1.26;
    EXPECT_FALSE(gate(a, made({0.0126}, {}, even), {}).passed());
    // Frame by frame: one bad frame of eight against all eight a little worse.
    const std::vector<double> same(8, 0.01), flips(8, 0.1);
    std::vector<double> one = flips, all = flips;
    one[3] = 0.2;
    for (double& v : all) v = 0.11;
    EXPECT_EQ(gate(made(same, flips), made(same, one), {}).count(Verdict::unresolved), 1u);
    EXPECT_EQ(worse(gate(made(same, flips), made(same, all), {})), (std::vector<std::string>{"noaa flip"}));
    EXPECT_TRUE(gate(made(same, all), made(same, flips), {}).passed());
}
TEST(Gate, FiguresThatAreNotFinite) {
    const RunResults exact = made({0.0}), off = made({0.01});
    EXPECT_EQ(worse(gate(exact, off, {})), (std::vector<std::string>{"noaa psnr"}));
    EXPECT_TRUE(gate(off, exact, {}).passed());
    EXPECT_TRUE(gate(exact, exact, {}).passed());
    RunResults broken = made({0.01}, {0.1});
    broken.methods[0].pooled->mean.others["flip"] = NAN;
    EXPECT_EQ(worse(gate(made({0.01}, {0.1}), broken, {})), (std::vector<std::string>{"noaa flip"}));
}
TEST(Gate, TimesAreHeldOnlyByWish) {
    const RunResults a = made({0.01});
    RunResults b = a;
    b.methods[0].secondsMin *= 3, b.methods[0].nsPerPixel *= 3;
    EXPECT_TRUE(gate(a, b, {}).passed());
    GateOptions o;
    addTolerance(o, "time=50%");
    EXPECT_EQ(worse(gate(a, b, o)), (std::vector<std::string>{"noaa time"}));
    b.methods[0].secondsMin = a.methods[0].secondsMin;  // the median of a busy machine alone
    EXPECT_TRUE(gate(a, b, o).passed());
}
TEST(Gate, WhatIsMissingFailsAndIsNamed) {
    const RunResults a = made({0.01, 0.01, 0.01}, {0.1, 0.1, 0.1}), b = made({0.01, 0.01, 0.01});
    GateReport report = gate(a, b, {});
    EXPECT_FALSE(report.passed());
    EXPECT_EQ(report.count(Verdict::missing), 1u);
    EXPECT_TRUE(gate(b, a, {}).passed()) << "a figure more is no fault";
    RunResults other = b;
    other.methods[0].text = other.methods[0].id = "another";
    report = gate(b, other, {});
    EXPECT_EQ(report.count(Verdict::missing), 1u);
    EXPECT_EQ(report.count(Verdict::added), 1u);
    GateOptions lenient;
    lenient.allowMissing = true;
    EXPECT_TRUE(gate(b, other, lenient).passed());
    EXPECT_TRUE(gate(a, b, lenient).passed());
}
TEST(Gate, WhatCannotBeComparedIsRefused) {
    const RunResults a = made({0.01, 0.02});
    const auto with = [&](auto change) {
        RunResults b = a;
        change(b);
        return refusal(a, b);
    };
    EXPECT_EQ(with([](RunResults&) {}), "");
    EXPECT_NE(with([](RunResults& r) { r.width = 255; }).find("the resolution: before 256x128, now 255x128"),
              std::string::npos);
    EXPECT_NE(with([](RunResults& r) { r.protocol.eightBit = true; }).find("quantise=8"), std::string::npos);
    EXPECT_NE(with([](RunResults& r) { r.methods[0].frames.pop_back(); }).find("the frames: before 1,2, now 1"),
              std::string::npos);
    EXPECT_NE(with([](RunResults& r) { r.shot = "other"; }).find("the shot: before 'made', now 'other'"),
              std::string::npos);
    EXPECT_NE(with([](RunResults& r) {
                  r.complete = false, r.framesAsked = 9;
              }).find("the new run was interrupted after 2 of 9 frames"),
              std::string::npos);
}
TEST(Gate, TolerancesAreRead) {
    GateOptions o;
    addTolerance(o, "ssim=0.01");
    EXPECT_EQ(o.tolerances.at("ssimLuma").value, 0.01);
    addTolerance(o, "flip=5%");
    EXPECT_TRUE(o.tolerances.at("flip").isShare);
    EXPECT_DOUBLE_EQ(o.tolerances.at("flip").value, 0.05);
    for (const char* bad :
         {"flop=1", "psnr", "psnr=", "psnr=x", "psnr=-1", "psnr=1%%", "time=1", "psnr=nan", "psnr=inf"})
        EXPECT_THROW(addTolerance(o, bad), UsageError) << bad;
    try {
        addTolerance(o, "flpi=1");
    } catch (const UsageError& e) {
        EXPECT_NE(std::string(e.what()).find("did you mean 'flip'?"), std::string::npos) << e.what();
    }
    const std::string list = listOfTolerances();
    for (const char* figure : {"psnr", "ssimLuma", "flip", "ghostMse", "time"})
        EXPECT_NE(list.find(figure), std::string::npos) << figure;
}
TEST(Gate, JsonAndJunitHoldEveryRow) {
    RunResults a = made({0.01}, {0.1}), b = made({0.02}, {0.1});
    for (RunResults* r : {&a, &b}) r->methods[0].text = "fxaa<\"&1", r->provenance.rerun = "aaresolve run shot";
    const GateReport report = gate(a, b, {});
    const auto j = nlohmann::json::parse(toJsonText(report));
    EXPECT_EQ(j["passed"], false);
    EXPECT_EQ(j["counts"]["worse"], 1);
    EXPECT_EQ(j["rows"].size(), report.rows.size());
    EXPECT_EQ(j["rows"][0]["figure"], "psnr");
    EXPECT_NEAR(j["rows"][0]["worsening"].get<double>(), psnr(0.01) - psnr(0.02), 1e-12);
    EXPECT_EQ(j["rows"][0]["rerun"].get<std::string>().substr(0, 22), "aaresolve run shot -m ");
    const std::string xml = toJunitText(report);
    EXPECT_NE(xml.find("<testsuites name=\"aaresolve gate\" tests=\"2\" failures=\"1\">"), std::string::npos) << xml;
    EXPECT_NE(xml.find("classname=\"made.fxaa&lt;&quot;&amp;1\" name=\"psnr\"><failure type=\"worse\""),
              std::string::npos)
        << xml;
    EXPECT_EQ(xml.find("fxaa<"), std::string::npos);
}

}  // namespace
}  // namespace aa
