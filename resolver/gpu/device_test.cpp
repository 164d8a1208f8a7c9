#include "gpu/device.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "gpu/gpu_testing.h"

using namespace aa;
using namespace aa::gpu;
using testing::HasSubstr;

namespace {

class GpuDevice : public DeviceTest {
  protected:
    void open() override { device = std::make_unique<Device>("vulkan"); }
    std::unique_ptr<Device> device;
};

TEST_F(GpuDevice, ImagesComeBackAsTheyWentUp) {
    for (const Format format : {Format::rgba32f, Format::rgba16f, Format::r32ui, Format::rg32f}) {
        Image image(*device, 5, 3, format, 2);
        std::vector<std::byte> sent(image.bytes()), found;
        for (size_t i = 0; i < sent.size(); i++) sent[i] = std::byte(i * 7 % 60);  // no NaN in any format
        Recorder recorder(*device);
        recorder.upload(image, [&](std::byte* to) { std::memcpy(to, sent.data(), sent.size()); });
        recorder.download(image, [&](const std::byte* from) { found.assign(from, from + ptrdiff_t(image.bytes())); });
        recorder.run();
        EXPECT_EQ(found, sent) << int(format);
    }
}
TEST_F(GpuDevice, NewMemoryIsZero) {
    Image image(*device, 4, 4, Format::rgba32f);
    Buffer buffer(*device, 64);
    Recorder recorder(*device);
    const auto isZero = [](const std::byte* p, size_t n) {
        for (size_t i = 0; i < n; i++) EXPECT_EQ(p[i], std::byte(0));
    };
    recorder.download(image, [&](const std::byte* p) { isZero(p, image.bytes()); });
    recorder.download(buffer, [&](const std::byte* p) { isZero(p, buffer.bytes()); });
    recorder.run();
}
TEST_F(GpuDevice, TooLargeIsOneClearLine) {
    try {
        const Image image(*device, 1 << 20, 4, Format::rgba32f);
        FAIL() << "expected a DeviceError";
    } catch (const DeviceError& e) {
        EXPECT_THAT(e.what(), HasSubstr("1048576 x 4"));
        EXPECT_THAT(e.what(), HasSubstr("--device cpu"));
    }
}
TEST_F(GpuDevice, OutOfMemoryIsOneClearLine) {
    std::vector<Image> images;  // a terabyte, in case the device takes what it does not have
    try {
        for (int i = 0; i < 4; i++) images.emplace_back(*device, 16384, 16384, Format::rgba32f, 64);
        FAIL() << "expected a DeviceError";
    } catch (const DeviceError& e) {
        EXPECT_THAT(e.what(), testing::AnyOf(HasSubstr("out of memory"), HasSubstr("images of at most")));
    }
}
TEST_F(GpuDevice, UnknownShaderIsAProgrammingError) { EXPECT_THROW(Shader("no/such"), std::logic_error); }

TEST(GpuRefusal, SaysWhatHappenedAndWhatToDo) {
    constexpr int kLost = -4, kDeviceMemory = -2, kHostMemory = -1, kOther = -3;
    EXPECT_THAT(refusal(kLost, "a card", "temporal/karis"), HasSubstr("a card was lost during temporal/karis"));
    EXPECT_THAT(refusal(kDeviceMemory, "a card", "an upload"), HasSubstr("a card is out of memory"));
    EXPECT_THAT(refusal(kHostMemory, "a card", "an upload"), HasSubstr("out of memory on this machine"));
    for (const int result : {kLost, kDeviceMemory, kOther})
        EXPECT_THAT(refusal(result, "a card", "x"), HasSubstr("--device cpu"));
}
}  // namespace
