#include "report/gallery.h"

#include <gtest/gtest.h>

#include <cmath>

#include "image/error.h"
#include "image/io.h"
#include "image/io_testing.h"
#include "metrics/maps.h"
#include "report/canvas.h"
#include "report/sheet.h"

namespace aa {
namespace {
namespace fs = std::filesystem;

void addBlock(Rgb& image, const Window& w, float amount) {
    for (auto& p : image.c)
        for (int y = w.y; y < w.y + w.height; y++)
            for (int x = w.x; x < w.x + w.width; x++) p.at(x, y) += amount;
}
bool contains(const Window& w, int x, int y) { return x >= w.x && x < w.x + w.width && y >= w.y && y < w.y + w.height; }

TEST(Gallery, WindowsLieWhereMethodsDiffer) {
    Pictures p{1, Rgb(200, 100, 0.5f), {Rgb(200, 100, 0.5f), Rgb(200, 100, 0.5f)}};
    addBlock(p.methods[0], {20, 20, 8, 8}, 0.3f);                   // only the first errs
    addBlock(p.methods[1], {150, 70, 8, 8}, 0.2f);                  // only the second errs
    for (auto& m : p.methods) addBlock(m, {80, 40, 20, 20}, 0.4f);  // both err alike: tells nothing between them
    const auto windows = mostTellingWindows(p, 24, 24, 3);
    ASSERT_EQ(windows.size(), 2u);
    EXPECT_TRUE(contains(windows[0], 24, 24));
    EXPECT_TRUE(contains(windows[1], 154, 74));
    EXPECT_FALSE(windows[0].overlaps(windows[1]));
    // A single method: its own error counts.
    Pictures one{1, p.truth, {p.methods[0]}};
    const auto alone = mostTellingWindows(one, 24, 24, 1);
    ASSERT_EQ(alone.size(), 1u);
    EXPECT_TRUE(contains(alone[0], 90, 50));
    // Without truth: the methods' difference from each other.
    Pictures blind{1, {}, p.methods};
    const auto found = mostTellingWindows(blind, 24, 24, 2);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_TRUE(contains(found[0], 24, 24));
    EXPECT_TRUE(contains(found[1], 154, 74));
    // Only what the figures are of.
    p.region = Window{100, 50, 100, 50};
    const auto inRegion = mostTellingWindows(p, 24, 24, 3);
    ASSERT_EQ(inRegion.size(), 1u);
    EXPECT_TRUE(contains(inRegion[0], 154, 74));
    // No difference, no window.
    EXPECT_TRUE(mostTellingWindows({1, p.truth, {p.truth, p.truth}}, 24, 24, 3).empty());
}
TEST(Gallery, ErrorMapIsTheRmsOverChannels) {
    Rgb t(3, 1, 0.5f), r = t;
    t.c[0].at(1, 0) += 0.3f;
    t.c[2].at(1, 0) -= 0.3f;
    const PlaneF e = errorMap(t, r);
    EXPECT_EQ(e.at(0, 0), 0.0f);
    EXPECT_NEAR(e.at(1, 0), std::sqrt(0.18 / 3), 1e-6);
}
TEST(Gallery, ShrinkingKeepsTheLightNotTheCodes) {
    Rgb stripes(60, 10);
    for (auto& p : stripes.c)
        for (int y = 0; y < 10; y++)
            for (int x = 0; x < 60; x++) p.at(x, y) = x % 2 ? 1.0f : 0.0f;
    const Rgb half = shrunk(stripes, 30, 5, {});
    EXPECT_NEAR(half.c[0].at(7, 3), 0.735357, 1e-5);  // sRGB code of half the light, not 0.5
    PlaneF ramp(7, 1);
    for (int x = 0; x < 7; x++) ramp.at(x, 0) = float(x);
    const PlaneF thirds = shrunk(ramp, 3, 1);
    EXPECT_NEAR(thirds.at(0, 0), (0 + 1 + 2 / 3.0) / (7 / 3.0), 1e-6);
    EXPECT_NEAR((thirds.at(0, 0) + thirds.at(1, 0) + thirds.at(2, 0)) / 3, 3.0, 1e-6);
}

TEST(ColourMap, LightnessRisesEvenly) {
    const auto lightness = [](const Colour& c) {  // OKLab L of encoded sRGB
        const auto decode = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
        const double r = decode(double(c[0])), g = decode(double(c[1])), b = decode(double(c[2]));
        const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
        const double m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
        const double s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
        return 0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s;
    };
    for (int i = 0; i <= 64; i++) {
        const Colour c = errorColour(i / 64.0);
        for (const float v : c) EXPECT_TRUE(v >= 0 && v <= 1) << i;
        EXPECT_NEAR(lightness(c), 0.10 + 0.87 * i / 64.0, 2e-3) << i;
    }
    EXPECT_EQ(errorColour(-1), errorColour(0));
    EXPECT_EQ(errorColour(7), errorColour(1));
    EXPECT_EQ(errorColour(NAN), errorColour(0));
}

// A run on disk: `methods` images of w x h, the k-th wrong by 0.05 k in a corner block.
struct RunOnDisk {
    fs::path folder;
    RunResults run;
    RunOnDisk(const char* name, int w, int h, int methods, bool truth) : folder(fs::temp_directory_path() / name) {
        fs::remove_all(folder);
        run.shot = "test", run.width = w, run.height = h, run.programVersion = "1", run.isa = "x",
        run.precision = "fast";
        Rgb exact(w, h, 0.25f);
        makeWritableFolder(folder / "truth");
        if (truth) {
            writeExr(folder / "truth/000003.exr", exact, false);
            run.truthImages[3] = "truth/000003.exr";
            run.truthNoise = 1e-7;
        }
        std::vector<TileErrors> errors(static_cast<size_t>(methods));
        for (int k = 0; k < methods; k++) {
            MethodResult m;
            m.id = m.text = m.folder = k == 0 ? "noaa" : "method" + std::to_string(k);
            makeWritableFolder(folder / m.folder);
            Rgb image = exact;
            addBlock(image, {0, 0, std::min(6, w), std::min(6, h)}, 0.05f * float(methods - k));
            writeExr(folder / m.folder / "000003.exr", image, false);
            FrameResult f;
            f.frame = 3, f.seconds = 1e-3, f.image = m.folder + "/000003.exr";
            Rgb encoded;
            encode(image, {}, {}, encoded);
            if (truth)
                f.metrics = measure({encoded, &image}, makeReference(exact, exact, {}, {}), {}, {}, errors[size_t(k)]);
            m.frames.push_back(f);
            run.methods.push_back(m);
        }
        finish(run, errors);
    }
    ~RunOnDisk() { fs::remove_all(folder); }
    Shown shown() const {
        const auto order = presentationOrder(run);
        return {run, order,
                [this, order](int frame) { return loadPictures(onlyMethods(run, order), folder, frame, {}); }};
    }
};

TEST(Sheet, OrderIsBestFirst) {
    RunOnDisk r("aaresolve_sheet_order", 40, 30, 4, true);
    EXPECT_EQ(presentationOrder(r.run), (std::vector<size_t>{3, 2, 1, 0}));
    // noaa has its place like any other; what has no figures comes last.
    std::swap(r.run.methods[0].pooled, r.run.methods[2].pooled);
    EXPECT_EQ(presentationOrder(r.run), (std::vector<size_t>{3, 0, 1, 2}));
    r.run.methods[3].pooled.reset();
    EXPECT_EQ(presentationOrder(r.run), (std::vector<size_t>{0, 1, 2, 3}));
}
TEST(Sheet, DrawsEverySize) {
    for (const auto& [w, h] : {std::pair{1, 1}, {3, 200}, {200, 3}, {64, 48}, {700, 500}})
        for (const bool truth : {true, false}) {
            const RunOnDisk r("aaresolve_sheet_sizes", w, h, 3, truth);
            EXPECT_EQ(loadPictures(r.run, r.folder, 3, {}).truth.empty(), !truth);
            const auto pages = sheet(r.shown(), 3, {}, {});
            ASSERT_EQ(pages.size(), 1u);
            pages[0].writePng(r.folder / "sheet.png");
            const LoadedImage drawn = readImage(r.folder / "sheet.png");
            EXPECT_LE(drawn.rgb.width(), 2400);
            EXPECT_GT(drawn.rgb.height(), 3 * 100);
            EXPECT_FALSE(hasTemporaryFiles(r.folder));
        }
}
TEST(Sheet, ShowsThePixelsAndTheirErrors) {
    const RunOnDisk r("aaresolve_sheet_pixels", 480, 270, 2, true);
    sheet(r.shown(), 3, {}, {})[0].writePng(r.folder / "sheet.png");
    const Rgb drawn = readImage(r.folder / "sheet.png").rgb;
    // Count the pixels that carry the colour of the wrong block's error: 6 x 6 in each method's error map.
    Rgb exact(480, 270, 0.25f), wrong(480, 270, 0.25f), exactEncoded, wrongEncoded;
    addBlock(wrong, {0, 0, 6, 6}, 0.1f);
    encode(exact, {}, {}, exactEncoded);
    encode(wrong, {}, {}, wrongEncoded);
    const Colour c = errorColour(double(errorMap(wrongEncoded, exactEncoded).at(2, 2)) / kErrorScale);
    int found = 0;
    for (int y = 0; y < drawn.height(); y++)
        for (int x = drawn.width() - 520; x < drawn.width(); x++) {
            bool same = true;
            for (size_t k = 0; k < 3; k++) same &= std::abs(drawn.c[k].at(x, y) - c[k]) < 0.003f;
            found += same;
        }
    EXPECT_GE(found, 36);
    EXPECT_LE(found, 36 + 60);  // and a column or two of the colour bar
}
TEST(Sheet, PicturesAreDisplayedAsTheRunCompared) {
    RunOnDisk r("aaresolve_sheet_display", 20, 20, 2, true);
    EXPECT_GT(loadPictures(r.run, r.folder, 3, {}).truth.c[0].at(3, 3), 0.5f);  // sRGB of 0.25
    r.run.protocol.display.transfer = Transfer::identity;
    EXPECT_EQ(loadPictures(r.run, r.folder, 3, {}).truth.c[0].at(3, 3), 0.25f);
    r.run.protocol.eightBit = true;
    EXPECT_EQ(loadPictures(r.run, r.folder, 3, {}).truth.c[0].at(3, 3), 64.0f / 255);
    r.run.protocol.eightBit = false;
    r.run.protocol.display.exposure = 1;
    EXPECT_EQ(loadPictures(r.run, r.folder, 3, {}).truth.c[0].at(3, 3), 0.5f);
    writeExr(r.folder / "truth/000003.exr", Rgb(20, 20, 0.25f), true);  // displayed already: no exposure again
    EXPECT_EQ(loadPictures(r.run, r.folder, 3, {}).truth.c[0].at(3, 3), 0.25f);
}
TEST(Sheet, MissingPicturesAreNamed) {
    RunOnDisk r("aaresolve_sheet_missing", 20, 20, 2, true);
    EXPECT_EQ(framesWithPictures(r.run), std::vector<int>{3});
    EXPECT_THROW(loadPictures(r.run, r.folder, 4, {}), InputError);
    writeExr(r.folder / "noaa/000003.exr", Rgb(10, 20), false);
    EXPECT_THROW(loadPictures(r.run, r.folder, 3, {}), InputError);
    r.run.methods[1].frames[0].image.clear();
    EXPECT_TRUE(framesWithPictures(r.run).empty());
}
TEST(Gallery, CropsDoNotAllShowTheSame) {
    // An upright edge, most wrong, and a weaker one elsewhere that runs across.
    Pictures p{.frame = 1, .truth = Rgb(400, 300, 0.2f), .methods = {}};
    for (auto& plane : p.truth.c) {
        for (int y = 0; y < 120; y++)
            for (int x = 60; x < 400; x++) plane.at(x, y) = 0.8f;
        for (int y = 250; y < 300; y++)
            for (int x = 200; x < 400; x++) plane.at(x, y) = 0.8f;
    }
    p.methods = {p.truth, p.truth, p.truth};
    for (auto& plane : p.methods[0].c)  // wrong all along the upright edge
        for (int y = 0; y < 120; y++) plane.at(60, y) = 0.3f;
    for (auto& plane : p.methods[1].c)  // wrong, less so, along the level one
        for (int x = 200; x < 400; x++) plane.at(x, 250) = 0.5f;
    for (auto& m : p.methods) m.fillBorder();
    const auto two = mostTellingWindows(p, 48, 48, 2);
    ASSERT_EQ(two.size(), 2u);
    EXPECT_LT(two[0].x, 61);
    EXPECT_LT(two[0].y, 120);
    EXPECT_GT(two[1].y, 200);  // and not the second window of the upright edge
}
}  // namespace
}  // namespace aa
