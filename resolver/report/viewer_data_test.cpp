#include "report/viewer_data.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

#include "image/error.h"
#include "image/io.h"

namespace aa {
namespace {
namespace fs = std::filesystem;

// A run on disk: noaa and two methods over some frames, brighter and wrong in a block that moves.
struct SmallRun {
    fs::path folder = fs::temp_directory_path() / "aaresolve_viewer_data";
    RunResults run;
    SmallRun(int width, int height, int frames, const std::string& kind = ".exr") {
        fs::remove_all(folder);
        run.shot = "test", run.width = width, run.height = height;
        makeWritableFolder(folder / "truth");
        for (const char* id : {"noaa", "one", "two"}) {
            MethodResult m;
            m.id = m.text = m.folder = id;
            makeWritableFolder(folder / id);
            run.methods.push_back(m);
        }
        for (int frame = 1; frame <= frames; frame++) {
            Rgb exact(width, height, 0.2f);
            for (int x = 0; x < width; x++) exact.c[0].at(x, frame % height) = 1.5f;
            write("truth/" + std::to_string(frame) + kind, exact);
            run.truthImages[frame] = "truth/" + std::to_string(frame) + kind;
            for (size_t m = 0; m < run.methods.size(); m++) {
                Rgb image = exact;
                for (int y = 2; y < std::min(6, height); y++)
                    for (int x = frame; x < std::min(frame + 4, width); x++) image.c[1].at(x, y) += 0.1f * float(3 - m);
                FrameResult f;
                f.frame = frame, f.image = run.methods[m].folder + "/" + std::to_string(frame) + kind;
                write(f.image, image);
                run.methods[m].frames.push_back(f);
            }
        }
    }
    ~SmallRun() { fs::remove_all(folder); }
    void write(const std::string& file, const Rgb& image) const {
        if (file.ends_with(".png"))
            writePng(folder / file, image);
        else
            writeExr(folder / file, image, false);
    }
};

// Every picture of a view, as the page comes to it.
std::map<std::pair<int, int>, Words> unpackedAll(const PackedView& view, int bits) {
    std::map<std::pair<int, int>, Words> all;
    for (const auto& p : view.pictures) {
        const Words* other = p.alone ? nullptr : &all.at({p.fromFrame, p.fromSource});  // there already
        all[{p.frame, p.source}] = unpacked(p.bytes, view.window.width, view.window.height, bits, other, p.guess);
    }
    return all;
}

TEST(ViewerData, HoldsEveryPictureToTheCode) {
    const SmallRun on(40, 24, 11);
    const ViewerData data = viewerData(on.run, on.folder, {}, {});
    ASSERT_EQ(data.views.size(), 1u);
    EXPECT_EQ(data.views[0].window, (Window{0, 0, 40, 24}));
    EXPECT_EQ(data.views[0].frames.size(), 11u);
    EXPECT_TRUE(data.leftOut.empty());
    const auto all = unpackedAll(data.views[0], 8);
    ASSERT_EQ(all.size(), 44u);
    for (int frame = 1; frame <= 11; frame++) {
        const Pictures p = loadPictures(on.run, on.folder, frame, {});
        EXPECT_EQ(all.at({frame, PackedPicture::kTruth}).values, codeWords(p.truth).values);
        for (int m = 0; m < 3; m++)
            EXPECT_EQ(all.at({frame, m}).values, codeWords(p.methods[size_t(m)]).values) << frame << " " << m;
    }
    ASSERT_EQ(data.places.size(), 11u);
    for (const auto& place : data.places) EXPECT_FALSE(place.windows.empty());
}
TEST(ViewerData, FloatsAreTheFiles) {
    const SmallRun on(20, 12, 2);
    const ViewerData data = viewerData(on.run, on.folder, {.floats = true}, {});
    const auto all = unpackedAll(data.views[0], 32);
    const LinearPictures p = loadLinearPictures(on.run, on.folder, 2);
    EXPECT_EQ(all.at({2, PackedPicture::kTruth}).values, floatWords(p.truth->linear).values);
    EXPECT_EQ(all.at({2, 1}).values, floatWords(p.methods[1].linear).values);
    const SmallRun codes(20, 12, 1, ".png");
    EXPECT_THROW(viewerData(codes.run, codes.folder, {.floats = true}, {}), InputError);
    EXPECT_EQ(viewerData(codes.run, codes.folder, {}, {}).views.size(), 1u);
}
TEST(ViewerData, TheLastFramesThatFit) {
    const SmallRun on(40, 24, 6);
    const size_t whole = viewerData(on.run, on.folder, {}, {}).textBytes();
    const ViewerData half = viewerData(on.run, on.folder, {.limitBytes = whole / 2}, {});
    EXPECT_LE(half.textBytes(), whole / 2);
    ASSERT_FALSE(half.leftOut.empty());
    EXPECT_EQ(half.leftOut.front(), 1);
    EXPECT_EQ(half.views[0].frames.front(), half.leftOut.back() + 1);
    EXPECT_EQ(half.views[0].frames.back(), 6);
    EXPECT_EQ(viewerData(on.run, on.folder, {.limitBytes = 1}, {}).views[0].frames, std::vector<int>{6});
    EXPECT_TRUE(viewerData(on.run, on.folder, {.limitBytes = 0}, {}).leftOut.empty());
}
TEST(ViewerData, CropsAndNone) {
    const SmallRun on(300, 200, 3);
    const ViewerData crops = viewerData(on.run, on.folder, {.what = Embed::crops}, {});
    ASSERT_FALSE(crops.views.empty());
    for (const auto& v : crops.views) {
        EXPECT_EQ(v.window.width, 128);
        EXPECT_EQ(v.frames.size(), 3u);
    }
    for (const auto& place : crops.places)
        for (const Window& w : place.windows) {
            const auto holds = [&](const PackedView& v) {
                return w.x >= v.window.x && w.y >= v.window.y && w.x + w.width <= v.window.x + v.window.width &&
                       w.y + w.height <= v.window.y + v.window.height;
            };
            EXPECT_TRUE(std::any_of(crops.views.begin(), crops.views.end(), holds));
        }
    EXPECT_TRUE(viewerData(on.run, on.folder, {.what = Embed::none}, {}).views.empty());
    // Of pictures too large for the limit, the part where the methods differ.
    const ViewerData part = viewerData(on.run, on.folder, {.limitBytes = 40'000}, {});
    EXPECT_EQ(part.views[0].window.width, 150);
    EXPECT_LE(part.views[0].window.x, 3);
}
TEST(ViewerData, ThresholdsAreEncodesOwn) {
    for (const DisplayChain& chain :
         {DisplayChain{}, DisplayChain{.exposure = 1.5f, .toneMap = ToneMap::aces},
          DisplayChain{.toneMap = ToneMap::reinhard}, DisplayChain{.transfer = Transfer::identity}}) {
        const auto thresholds = codeThresholds(chain, {});
        ASSERT_EQ(thresholds.size(), 255u);
        Rgb at(255, 1), below(255, 1), shown;
        for (size_t k = 0; k < 255; k++) {
            at.c[0].at(int(k), 0) = std::min(thresholds[k], std::numeric_limits<float>::max());
            below.c[0].at(int(k), 0) = std::nextafter(thresholds[k], 0.0f);
        }
        encode(at, chain, {}, shown);
        const Words reached = codeWords(shown);
        encode(below, chain, {}, shown);
        const Words missed = codeWords(shown);
        for (size_t k = 0; k < 255; k++) {  // the first channel comes second
            if (std::isfinite(thresholds[k])) {
                EXPECT_EQ(reached.values[255 + k], k + 1);
            }
            EXPECT_EQ(missed.values[255 + k], k);
        }
    }
}

}  // namespace
}  // namespace aa
