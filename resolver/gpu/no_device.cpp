// What stands for device.cpp where Vulkan's headers or glslang were missing when the program was built.
#include "gpu/device.h"

namespace aa::gpu {
namespace {
[[noreturn]] void absent() {
    throw DeviceError(
        "--device vulkan: this program was built without Vulkan; install libvulkan-dev, glslang-tools and spirv-tools "
        "and build it again, or use --device cpu");
}
}  // namespace

struct Image::State {};
struct Buffer::State {};
struct Shader::Pipeline {};
struct Recorder::State {};
class DeviceState {};

std::string refusal(int, const std::string&, const std::string&) { absent(); }
size_t bytesPerTexel(Format) { absent(); }
std::vector<DeviceInfo> listDevices() { absent(); }
Image::Image(const Device&, int, int, Format, int) { absent(); }
Image::Image() = default;
Image::Image(Image&&) noexcept = default;
Image& Image::operator=(Image&&) noexcept = default;
Image::~Image() = default;
Buffer::Buffer(const Device&, size_t) { absent(); }
Buffer::Buffer() = default;
Buffer::Buffer(Buffer&&) noexcept = default;
Buffer& Buffer::operator=(Buffer&&) noexcept = default;
Buffer::~Buffer() = default;
Shader::Shader(std::string_view, std::vector<Constant>) { absent(); }
Shader::Shader() = default;
Shader::Shader(Shader&&) noexcept = default;
Shader& Shader::operator=(Shader&&) noexcept = default;
Shader::~Shader() = default;
Device::Device(std::string_view, DeviceOptions) { absent(); }
Device::~Device() = default;
const DeviceInfo& Device::info() const { absent(); }
Recorder::Recorder(const Device&) { absent(); }
Recorder::~Recorder() = default;
void Recorder::dispatchBytes(Shader&, int, int, std::span<const Binding>, std::span<const std::byte>) { absent(); }
void Recorder::copy(const Image&, Image&) { absent(); }
void Recorder::clear(Image&, std::array<float, 4>) { absent(); }
void Recorder::clear(Buffer&) { absent(); }
void Recorder::upload(Image&, const std::function<void(std::byte*)>&) { absent(); }
void Recorder::upload(Buffer&, std::span<const std::byte>) { absent(); }
void Recorder::download(const Image&, std::function<void(const std::byte*)>) { absent(); }
void Recorder::download(const Buffer&, std::function<void(const std::byte*)>) { absent(); }
void Recorder::submit() { absent(); }
void Recorder::wait() { absent(); }
const std::vector<PassTime>& Recorder::times() const { absent(); }

}  // namespace aa::gpu
