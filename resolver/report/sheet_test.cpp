#include "report/sheet.h"

#include <gtest/gtest.h>

#include <set>

#include "image/error.h"
#include "report/sheet_layout.h"

namespace aa {
namespace {

// ---- sizes ----
const std::vector<Window> kThree = {{0, 0, 48, 48}, {50, 0, 48, 48}, {100, 0, 48, 48}};

TEST(SheetLayout, FreeRowsHaveWholeFactors) {
    const RowLayout l = rowLayout({240, 135, true, kThree, 1, 0}, 0, "free");
    EXPECT_EQ(l.frame.magnification, 2);
    EXPECT_EQ(l.frame.width, 480);
    for (const CellSize& c : l.crops) EXPECT_EQ(c.width, 48 * c.magnification);
    EXPECT_EQ(l.width, 2 * 480 + 3 * l.crops[0].width + 4 * kSheetGap);
    EXPECT_EQ(rowLayout({1920, 1080, true, {}, 0, 0}, 0, "free").frame.magnification, 0);  // shrunk
    EXPECT_LE(rowLayout({240, 135, true, kThree, 1, 0, 43}, 0, "free").height * 43 + 43 * 130, kLargestSide);
}
TEST(SheetLayout, LowCropsAreNotEndless) {
    for (const Window& low : {Window{0, 0, 48, 3}, {0, 0, 480, 20}, {0, 0, 3, 48}}) {
        const RowLayout l = rowLayout({480, 270, true, {low}, 1, 0}, 0, "free");
        EXPECT_GE(l.crops[0].magnification, 1);
        EXPECT_LE(l.crops[0].width, std::max(3 * 288 / 2, low.width));
        EXPECT_LE(l.crops[0].height, 288);
    }
}
TEST(SheetLayout, PagesHoldTheirRows) {
    for (const int room : {800, 1100, 1332, 1568})
        for (const int maps : {0, 1, 2}) {
            const RowLayout l = rowLayout({480, 270, true, kThree, maps, 0}, room, "a4");
            EXPECT_LE(l.width, room);
            EXPECT_GE(l.height, 48);
        }
    EXPECT_THROW(rowLayout({480, 270, true, {{0, 0, 480, 270}, {0, 0, 480, 270}}, 1, 0}, 838, "a4"), UsageError);
    EXPECT_THROW(rowLayout({480, 270, false, kThree, 0, 16}, 838, "a4"), UsageError);
}
TEST(SheetLayout, AskedZoomIsKept) {
    const RowLayout l = rowLayout({480, 270, false, kThree, 0, 4}, 1332, "a4");
    for (const CellSize& c : l.crops) EXPECT_EQ(c.magnification, 4);
    const GridLayout g = gridLayout(kThree, 9, 2, 1864, 700, "slide");
    for (const CellSize& c : g.cells) EXPECT_EQ(c.magnification, 2);
}
TEST(SheetLayout, GridsFillThePageWithFewBlocks) {
    const GridLayout nine = gridLayout(kThree, 9, 0, 1864, 700, "slide");
    EXPECT_EQ(nine.columns, 9);
    EXPECT_EQ(nine.cells[0].magnification, 4);  // 9 * (192 + 6) - 6 = 1776; by 5 there would be two blocks
    const GridLayout many = gridLayout(kThree, 40, 0, 1864, 700, "slide");
    EXPECT_LE(many.columns * (many.cellWidth + kCellGap) - kCellGap, 1864);
    EXPECT_EQ((40 + many.columns - 1) / many.columns, 3);
    EXPECT_EQ(many.columns, 14);  // 14, 14, 12 and not 18, 18, 4
    EXPECT_THROW(gridLayout({{0, 0, 2000, 10}}, 2, 0, 1864, 700, "slide"), UsageError);
}

TEST(SheetLayout, HeadsHaveRoomAboveNarrowPictures) {
    const RowLayout l = rowLayout({1, 300, true, {{0, 0, 1, 48}}, 1, 0}, 0, "free");
    EXPECT_EQ(l.frame.width, 1);
    EXPECT_EQ(l.width, 2 * CellSize::kLeastColumn + RowLayout::kLeastMapColumn + 2 * kSheetGap);
    for (const char* page : {"slide", "free"}) try {
            gridLayout({{0, 0, 2000, 10}}, 2, 0, 1864, 700, page);
            ADD_FAILURE();
        } catch (const UsageError& e) {
            EXPECT_EQ(std::string(e.what()).ends_with("--page free"), std::string(page) == "slide") << e.what();
        }
}

// ---- pages ----
TEST(SheetPages, RowsFlowAndHeadsRepeat) {
    int heads = 0, rows = 0;
    SheetSection s;
    s.lead.push_back({40, [&](Canvas&, int) { heads++; }});
    for (int i = 0; i < 10; i++)
        s.rows.push_back({200, [&](Canvas& c, int y) {
                              EXPECT_LE(y + 200, c.height());
                              rows++;
                          }});
    const auto pages = sheetPages({s}, 1000, PageSize::a4, sheetTheme(true), {"shot", "after", "line", "foot"}, "1.0");
    EXPECT_EQ(rows, 10);
    EXPECT_EQ(heads, int(pages.size()));
    EXPECT_EQ(pages.size(), 2u);
    for (const Canvas& p : pages) EXPECT_EQ(std::pair(p.width(), p.height()), std::pair(1684, 1190));
    EXPECT_EQ(sheetPages({s}, 1000, PageSize::free, sheetTheme(true), {"s", "", "", ""}, "1").size(), 1u);
    s.rows.push_back({1190, [](Canvas&, int) {}});
    EXPECT_THROW(sheetPages({s}, 1000, PageSize::a4, sheetTheme(true), {"s", "", "", ""}, "1"), UsageError);
    for (int i = 0; i < 100; i++) s.rows.push_back({200, [](Canvas&, int) {}});
    const auto tall = sheetPages({s}, 1000, PageSize::free, sheetTheme(true), {"s", "", "", ""}, "1");
    EXPECT_EQ(tall.size(), 2u) << "a picture has 16384 px a side at most";
    EXPECT_LE(tall[0].height(), kLargestSide);
}
TEST(SheetPages, LongTextIsBrokenAndNotCut) {
    const std::string line =
        "640 x 360, moving; jitter halton, period 16; a processor with a name of many words, v4, 64 threads";
    for (const PageSize page : {PageSize::a4Portrait, PageSize::slide}) {
        SheetSection s;
        s.rows.push_back({10, [](Canvas&, int) {}});
        const auto pages =
            sheetPages({s}, 100, page, sheetTheme(false), {std::string(90, 'm'), line, line + line, line}, "1");
        std::string all;
        for (const auto& mark : pages[0].marks())
            if (const auto* t = std::get_if<Canvas::Text>(&mark)) {
                all += t->text;
                EXPECT_LE(t->x + t->advancePx, pages[0].width() - kSheetMargin + 2) << t->text;
            }
        EXPECT_EQ(all.find("..."), std::string::npos);
        EXPECT_EQ(std::count(all.begin(), all.end(), 'm') >= 90, true);
    }
}

// ---- a run in memory: gradients, a method brighter by its number, frames brighter by theirs ----
struct Drawn {
    RunResults run;
    int frames = 6;
    Drawn(int methods = 3, int width = 160, int height = 90) {
        run.shot = "ramp", run.width = width, run.height = height, run.programVersion = "1.0";
        for (int m = 0; m < methods; m++) {
            MethodResult r;
            r.id = m == 0 ? "noaa" : m == 1 ? "fxaa311" : "smaa1x", r.family = m == 0 ? "reference" : "spatial";
            r.text = m > 2 ? r.id + ":threshold=0.0" + std::to_string(m) + ",other=1" : r.id;
            r.title = "A method", r.nsPerPixel = 2 + m;
            r.pooled.emplace().frames = 6;
            r.pooled->mean.psnr = 30 + m, r.pooled->mean.mse = std::pow(10, -(30 + m) / 10.0);
            r.pooled->gainDb = m;
            for (int f = 1; f <= frames; f++) {
                FrameResult frame;
                frame.frame = f, frame.image = "there";
                r.frames.push_back(frame);
            }
            run.methods.push_back(r);
        }
    }
    static float value(int x, int y, int m, int f) { return float((x * 3 + y * 5 + m * 17 + f * 7) % 256) / 255.0f; }
    Rgb picture(int m, int f) const {
        Rgb image(run.width, run.height);
        for (size_t c = 0; c < 3; c++)
            for (int y = 0; y < run.height; y++)
                for (int x = 0; x < run.width; x++) image.c[c].at(x, y) = value(x + int(c), y, m, f);
        image.fillBorder();
        return image;
    }
    Shown shown() const {
        const auto order = presentationOrder(run);
        return {run, order, [this, order](int f) {
                    Pictures p;
                    p.frame = f, p.truth = picture(100, f);
                    for (const size_t m : order) p.methods.push_back(picture(int(m), f));
                    return p;
                }};
    }
};
// Where on a canvas a picture of these codes, magnified, lies; its places.
std::vector<std::pair<int, int>> find(const Canvas& canvas, const Rgb& crop, int magnification) {
    std::vector<std::pair<int, int>> places;
    const auto codes = canvas.codes();
    const auto is = [&](int x0, int y0) {
        for (int y = 0; y < crop.height() * magnification; y++)
            for (int x = 0; x < crop.width() * magnification; x++)
                for (size_t c = 0; c < 3; c++)
                    if (codes[(size_t(y0 + y) * size_t(canvas.width()) + size_t(x0 + x)) * 3 + c] !=
                        std::lround(255 * crop.c[c].at(x / magnification, y / magnification)))
                        return false;
        return true;
    };
    for (int y = 0; y + crop.height() * magnification <= canvas.height(); y++)
        for (int x = 0; x + crop.width() * magnification <= canvas.width(); x++)
            if (is(x, y)) places.emplace_back(x, y);
    return places;
}
const Crop kCrop{{20, 10, 24, 16}, "corner"};

TEST(Sheet, CropsAreTheRunsPixelsMagnified) {
    const Drawn d;
    SheetOptions o{.crops = {kCrop}, .zoom = 5};  // the whole frame is by 3
    for (const Arrangement a : {Arrangement::rows, Arrangement::grid}) {
        o.arrangement = a;
        const auto pages = sheet(d.shown(), 4, o, {});
        ASSERT_EQ(pages.size(), 1u);
        std::set<std::pair<int, int>> places;
        for (const int m : {0, 1, 2, 100}) {
            const auto found = find(pages[0], cropped(d.picture(m, 4), kCrop.window), 5);
            ASSERT_EQ(found.size(), 1u) << m;
            places.insert(found[0]);
        }
        std::set<int> xs, ys;
        for (const auto& [x, y] : places) xs.insert(x), ys.insert(y);
        EXPECT_EQ(xs.size(), a == Arrangement::rows ? 1u : 4u);
        EXPECT_EQ(ys.size(), a == Arrangement::rows ? 4u : 1u);
    }
}
TEST(Sheet, StripsHaveARowPerMethodAndAColumnPerFrame) {
    const Drawn d;
    const auto pages = strips(d.shown(), {2, 3, 5}, {.crops = {kCrop}, .zoom = 2});
    ASSERT_EQ(pages.size(), 1u);
    std::set<int> xs, ys;
    for (const int m : {0, 1, 2, 100})
        for (const int f : {2, 3, 5}) {
            const auto found = find(pages[0], cropped(d.picture(m, f), kCrop.window), 2);
            ASSERT_EQ(found.size(), 1u) << m << ' ' << f;
            xs.insert(found[0].first), ys.insert(found[0].second);
        }
    EXPECT_EQ(xs.size(), 3u);
    EXPECT_EQ(ys.size(), 4u);
}
TEST(Sheet, LoopsKeepThePlace) {
    const Drawn d;
    const auto methods = loopOfMethods(d.shown(), 4, {.crops = {kCrop}, .zoom = 2});
    ASSERT_EQ(methods.size(), 4u);
    const int order[] = {100, 2, 1, 0};  // truth, then best first
    std::set<std::pair<int, int>> places;
    for (size_t i = 0; i < 4; i++) {
        const auto found = find(methods[i], cropped(d.picture(order[i], 4), kCrop.window), 2);
        ASSERT_EQ(found.size(), 1u) << i;
        places.insert(found[0]);
    }
    EXPECT_EQ(places.size(), 1u);
    const auto frames = loopOfFrames(d.shown(), {1, 2, 3}, {.crops = {kCrop}, .zoom = 2});
    ASSERT_EQ(frames.size(), 3u);
    places.clear();
    for (size_t i = 0; i < 3; i++) {
        const auto found = find(frames[i], cropped(d.picture(1, int(i) + 1), kCrop.window), 2);
        ASSERT_EQ(found.size(), 1u);
        places.insert(found[0]);
        EXPECT_EQ(frames[i].width(), frames[0].width());
        EXPECT_EQ(frames[i].height(), frames[0].height());
    }
    EXPECT_EQ(places.size(), 1u);
}
std::vector<std::string> texts(const Canvas& canvas) {
    std::vector<std::string> all;
    for (const auto& mark : canvas.marks())
        if (const auto* t = std::get_if<Canvas::Text>(&mark)) all.push_back(t->text);
    return all;
}
TEST(Sheet, NamesAreWholeAndTheBestIsMarked) {
    const Drawn d(5);
    for (const PageSize page : {PageSize::free, PageSize::a4, PageSize::a4Portrait}) {
        std::string all;
        int stars = 0;
        for (const Canvas& canvas : sheet(d.shown(), 4, {.crops = {kCrop}, .page = page}, {}))
            for (const auto& t : texts(canvas)) all += t, stars += t == "\u2605";
        EXPECT_NE(all.find("threshold=0.03"), std::string::npos);
        EXPECT_EQ(all.find("..."), std::string::npos);
        EXPECT_EQ(stars, 2);  // PSNR, time; noaa's time does not count
    }
}
std::string allTexts(const Canvas& canvas) {
    std::string all;
    for (const auto& t : texts(canvas)) all += t + "\n";
    return all;
}
TEST(Sheet, TheFootSaysWhatTheStarsLeaveOut) {
    const Drawn d;
    const auto foot = [&](const std::vector<size_t>& order, const SheetOptions& o) {
        Shown shown = d.shown();
        shown.order = order;
        shown.pictures = [&](int f) {
            Pictures p = d.shown().pictures(f);
            p.methods.resize(order.size());
            return p;
        };
        std::string all = allTexts(sheet(shown, 4, o, {})[0]);
        std::replace(all.begin(), all.end(), '\n', ' ');
        return all;
    };
    const SheetOptions rows{.crops = {kCrop}}, grid{.crops = {kCrop}, .arrangement = Arrangement::grid};
    EXPECT_NE(foot({2, 1, 0}, rows).find("\u2605 best of the methods shown; of time without noaa"), std::string::npos);
    EXPECT_NE(foot({2, 1}, rows).find("\u2605 best of the methods shown. "), std::string::npos);
    EXPECT_NE(foot({2, 1, 0}, grid).find("\u2605 best of the methods shown. "), std::string::npos) << "PSNR alone";
}
TEST(Sheet, WithoutTruthNothingIsSaidOfIt) {
    Drawn d;
    for (MethodResult& m : d.run.methods) {
        m.pooled.reset();
        m.temporal.emplace();
    }
    for (const Arrangement a : {Arrangement::rows, Arrangement::grid}) {
        Shown shown = d.shown();
        shown.pictures = [&](int f) {
            Pictures p = d.shown().pictures(f);
            p.truth = {};
            return p;
        };
        const std::string all = allTexts(sheet(shown, 4, {.crops = {kCrop}, .arrangement = a}, {})[0]);
        EXPECT_NE(all.find("anti-aliasing methods, without a ground truth"), std::string::npos) << all;
        for (const char* word : {"against", "PSNR", "Flicker", "hosts", "Figures", "Errors"})
            EXPECT_EQ(all.find(word), std::string::npos) << word << " in " << all;
        EXPECT_EQ(all.find("\u2605") != std::string::npos, a == Arrangement::rows) << "times alone have stars";
        SheetOptions maps{.crops = {kCrop}};
        chooseColumns(maps, {"crops", "flip"});
        EXPECT_THROW(sheet(shown, 4, maps, {}), InputError) << "a map was asked for that cannot be";
    }
}
TEST(Sheet, GainsAndGhostsHaveAColourWhereTheyAreResolved) {
    Drawn d;
    d.run.methods[2].pooled->gainDb = -2;
    for (size_t m : {1u, 2u}) {
        d.run.methods[m].temporal.emplace().ghostExcess = m == 1 ? 0.5 : 1.5;
        PairResult p;
        p.second = m;
        p.ghost.emplace();
        d.run.pairs.push_back(p);
    }
    const Theme& theme = sheetTheme(false);
    const auto colourOf = [&](const std::string& text, Arrangement a) {
        const auto pages = sheet(d.shown(), 4, {.crops = {kCrop}, .arrangement = a}, {});
        for (const auto& mark : pages[0].marks())
            if (const auto* t = std::get_if<Canvas::Text>(&mark); t && t->text == text) return t->colour;
        ADD_FAILURE() << text;
        return Colour{};
    };
    const auto row = Arrangement::rows;
    for (const bool resolved : {false, true}) {
        for (PairResult& p : d.run.pairs) p.comparison.resolved = p.ghost->resolved = resolved;
        EXPECT_EQ(colourOf("+1.00", row), resolved ? theme.better : theme.ink);
        EXPECT_EQ(colourOf("-2.00", row), resolved ? theme.worse : theme.ink);
        EXPECT_EQ(colourOf("0.5", row), resolved ? theme.better : theme.ink);
        EXPECT_EQ(colourOf("1.5", row), resolved ? theme.worse : theme.ink);
        EXPECT_EQ(colourOf("-2.00 dB over noaa", Arrangement::grid), resolved ? theme.worse : theme.ink);
    }
}
TEST(Sheet, QuartilesStandUnderTheirFigure) {
    Drawn d;
    MethodResult& m = d.run.methods[2];
    m.pooled->mean.others = {
        {"flip", 0.05}, {"flipFirstQuartile", 0.0413}, {"flipMedian", 0.08}, {"flipThirdQuartile", 0.15}};
    m.frames[0].metrics = m.pooled->mean;
    const auto shown = texts(sheet(d.shown(), 4, {.crops = {kCrop}}, {})[0]);
    const auto at = std::find(shown.begin(), shown.end(), "quartiles 0.0413, 0.08, 0.15");
    ASSERT_NE(at, shown.end());
    const auto value = std::find(shown.begin(), at, "0.05");
    EXPECT_NE(value, at) << "above them";
    for (const auto& t : shown) EXPECT_EQ(t.find("FLIP, "), std::string::npos) << "no rows of their own";
}
TEST(Sheet, MethodsAreChosenByTextIdAndFamily) {
    const Drawn d(5);
    const auto names = [&](const std::vector<std::string>& wanted) {
        std::vector<std::string> texts;
        for (const size_t i : chosenMethods(d.run, wanted)) texts.push_back(d.run.methods[i].text);
        return texts;
    };
    EXPECT_EQ(names({}).size(), 5u);
    EXPECT_EQ(names({"spatial"}).size(), 4u);
    EXPECT_EQ(names({"smaa1x:threshold=0.03,other=1,noaa"}),
              (std::vector<std::string>{"smaa1x:threshold=0.03,other=1", "noaa"}));
    EXPECT_EQ(names({"noaa", "fxaa311"}), (std::vector<std::string>{"fxaa311", "noaa"}));
    EXPECT_THROW(names({"fxaa"}), UsageError);
    EXPECT_THROW(names({"noaa,"}), UsageError);
    EXPECT_THROW(names({""}), UsageError);
}
TEST(Sheet, CropsAreRead) {
    const Drawn d;
    EXPECT_EQ(cropFrom("1,2,30,40", d.run).window, (Window{1, 2, 30, 40}));
    const Crop named = cropFrom("1,2,30,40:a: fence", d.run);
    EXPECT_EQ(named.label, "a: fence");
    EXPECT_THROW(cropFrom("1,2,30", d.run), UsageError);
    EXPECT_THROW(cropFrom("150,2,30,40", d.run), UsageError);
    SheetOptions o;
    chooseColumns(o, {"crops", "ssim", "flip"});
    EXPECT_FALSE(o.frameColumn);
    EXPECT_TRUE(o.cropColumns);
    EXPECT_EQ(o.maps.size(), 2u);
    EXPECT_THROW(chooseColumns(o, {"pictures"}), UsageError);
}
}  // namespace
}  // namespace aa
