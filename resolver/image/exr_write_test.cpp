#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "image/error.h"
#include "image/exr.h"

namespace aa {
namespace {
namespace fs = std::filesystem;
using OIIO::ImageInput;
using OIIO::TypeDesc;

constexpr int kWidth = 45, kHeight = 70;  // five chunks of ZIP, the last one of six lines

PlaneF numbers(int width, int height, float scale) {
    PlaneF plane(width, height);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) plane.at(x, y) = scale * float(x - 20) / float(y + 3);
    return plane;
}

class WrittenExr : public testing::Test {
  protected:
    void TearDown() override { fs::remove(file); }
    const fs::path file = fs::path(testing::TempDir()) /
                          (std::string("aa_exr_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    const PlaneF a = numbers(kWidth, kHeight, 1e-3f), b = numbers(kWidth, kHeight, 1e9f), list = numbers(7, 33, 1);
    PlaneU ids{kWidth, kHeight, 4'000'000'000u};
};

// By OpenEXR's own reader, channel by channel.
template <class T>
void expectAsRead(const fs::path& file, int part, const std::string& channel, const Plane<T>& plane) {
    auto in = ImageInput::open(file.string());
    ASSERT_TRUE(in && in->seek_subimage(part, 0)) << file;
    const auto& names = in->spec().channelnames;
    const int c = int(std::find(names.begin(), names.end(), channel) - names.begin());
    ASSERT_LT(c, in->spec().nchannels) << channel;
    std::vector<T> pixels(size_t(plane.width()) * size_t(plane.height()));
    const TypeDesc type = std::is_same_v<T, float> ? TypeDesc::FLOAT : TypeDesc::UINT32;
    ASSERT_TRUE(in->read_image(part, 0, c, c + 1, type, pixels.data())) << in->geterror();
    for (int y = 0; y < plane.height(); y++)
        ASSERT_EQ(
            std::memcmp(pixels.data() + ptrdiff_t(y) * plane.width(), plane.row(y), size_t(plane.width()) * sizeof(T)),
            0)
            << channel << " row " << y;
}

TEST_F(WrittenExr, HasEveryPixelForOtherReaders) {
    const std::string longName = "a channel whose name is longer than 31 letters";
    writeParts(file, {{"one", {{"Z", &a}, {"id", &ids}, {longName, &b}}}, {"two", {{"v", &list}}}});
    expectAsRead(file, 0, "Z", a);
    expectAsRead(file, 0, "id", ids);
    expectAsRead(file, 0, longName, b);
    expectAsRead(file, 1, "v", list);
    writeParts(file, {{"", {{"G", &b}, {"B", &a}}, {{"number", -5}}, Window{-3, -2, 64, 80}}});
    expectAsRead(file, 0, "G", b);
    expectAsRead(file, 0, "B", a);
    const auto spec = ImageInput::open(file.string())->spec();
    EXPECT_EQ(spec.get_int_attribute("number"), -5);
    EXPECT_EQ(spec.x, 3);
    EXPECT_EQ(spec.y, 2);
    EXPECT_EQ(spec.full_width, 64);
}

TEST_F(WrittenExr, EachDamagedChunkIsFoundWithItsRow) {
    writeParts(file, {{"", {{"Z", &a}, {"id", &ids}}}});
    std::ifstream in(file, std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(in), {}};
    const int chunks = (kHeight + 15) / 16;
    size_t table = whole.size();  // the first chunk's place stands at the table's start, which ends there
    for (size_t at = 8; at + 8 < whole.size() && table == whole.size(); at++) {
        uint64_t first = 0;
        std::memcpy(&first, whole.data() + at, 8);
        if (first == at + size_t(chunks) * 8) table = at;
    }
    ASSERT_LT(table, whole.size());
    for (int chunk = 0; chunk < chunks; chunk++) {
        uint64_t at = 0;
        std::memcpy(&at, whole.data() + table + size_t(chunk) * 8, 8);
        std::string damaged = whole;
        for (size_t i = 0; i < 12; i++) damaged[at + 20 + i] = char(damaged[at + 20 + i] ^ 0x5a);
        std::ofstream(file, std::ios::binary) << damaged;
        ExrFile exr(file);
        PlaneF z;
        std::vector<ChannelTarget> targets{{"Z", &z}};
        try {
            exr.read(exr.parts()[0], targets);
            ADD_FAILURE() << "chunk " << chunk << " was taken";
        } catch (const InputError& e) {
            EXPECT_THAT(e.what(), testing::HasSubstr("damaged at row " + std::to_string(chunk * 16) + " (")) << chunk;
        }
    }
}

}  // namespace
}  // namespace aa
