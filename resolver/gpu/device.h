// A graphics device for compute shaders, through Vulkan and without a window. Nothing here needs Vulkan's headers;
// where the program was built without them (no_device.cpp), there is no device and every call says so.
//
// The shaders' interface is one for all of them (shaders/README.md): descriptor set 0, binding i = the i-th of
// Dispatch::bindings, at most 128 bytes of push constants, specialisation constants by number, workgroups of 8 x 8.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "image/error.h"

namespace aa::gpu {

// What the device or its driver refuses: lost, out of memory, not there. One line for the user, exit code 3.
struct DeviceError : InputError {
    using InputError::InputError;
};

struct DeviceInfo {
    size_t index = 0;                     // as in `--device vulkan:N`
    std::string name, kind, driver, api;  // kind: discrete, integrated, virtual, cpu or other
    uint64_t memoryBytes = 0;             // of its own
    std::string lacks;                    // what it would need to run the shaders; empty: usable
    bool isCpu() const { return kind == "cpu"; }
};
// The user's line for a VkResult that is an error.
std::string refusal(int result, const std::string& device, const std::string& during);
// Real cards before software. Throws DeviceError: no Vulkan in this build, no loader on this machine.
std::vector<DeviceInfo> listDevices();

enum class Format { rgba32f, rgba16f, rg32f, rg16f, r32f, r32ui, rgba8 };
size_t bytesPerTexel(Format format);

class DeviceState;  // Vulkan's objects: device_state.h
class Device;

// Layers of W x H texels. Readable and writable by shaders at any time: its layout never changes.
class Image {
  public:
    Image();
    // `layers` 0: a picture, which shaders see as image2D or sampler2D; else an array of so many (image2DArray ...).
    Image(const Device& device, int width, int height, Format format, int layers = 0);
    Image(Image&&) noexcept;
    Image& operator=(Image&&) noexcept;
    ~Image();
    bool empty() const { return !state_; }
    int width() const { return width_; }
    int height() const { return height_; }
    int layers() const { return layers_ > 0 ? layers_ : 1; }
    bool isArray() const { return layers_ > 0; }
    Format format() const { return format_; }
    size_t bytes() const { return size_t(width_) * size_t(height_) * size_t(layers()) * bytesPerTexel(format_); }
    struct State;
    const State& state() const { return *state_; }

  private:
    std::unique_ptr<State> state_;
    int width_ = 0, height_ = 0, layers_ = 0;
    Format format_ = Format::rgba32f;
};

// Memory of shaders, `bytes` long, zero at first.
class Buffer {
  public:
    Buffer();
    Buffer(const Device& device, size_t bytes);
    Buffer(Buffer&&) noexcept;
    Buffer& operator=(Buffer&&) noexcept;
    ~Buffer();
    bool empty() const { return !state_; }
    size_t bytes() const { return bytes_; }
    struct State;
    const State& state() const { return *state_; }

  private:
    std::unique_ptr<State> state_;
    size_t bytes_ = 0;
};

// What a shader sees at one binding: a texture (nearest or linear filter, clamped to its edge), an image that it writes
// (and may read where the shader says so), or a buffer.
struct Binding {
    enum class Kind { nearest, linear, image, buffer } kind;
    const Image* texture = nullptr;
    const Buffer* memory = nullptr;
};
inline Binding read(const Image& image) { return {Binding::Kind::nearest, &image}; }
inline Binding filtered(const Image& image) { return {Binding::Kind::linear, &image}; }
inline Binding written(Image& image) { return {Binding::Kind::image, &image}; }
inline Binding memory(const Buffer& buffer) { return {Binding::Kind::buffer, nullptr, &buffer}; }

// One specialisation constant: a bool, int, uint or float by its number in the shader.
struct Constant {
    uint32_t id, bits;
    Constant(uint32_t number, bool value) : id(number), bits(value ? 1 : 0) {}
    Constant(uint32_t number, int value) : id(number), bits(uint32_t(value)) {}
    Constant(uint32_t number, float value) : id(number) { __builtin_memcpy(&bits, &value, 4); }
    template <class Enum>
    requires std::is_enum_v<Enum> Constant(uint32_t number, Enum value) : Constant(number, int(value)) {}
};

// A shader with its specialisation constants. Compiled for the device when it first runs.
class Shader {
  public:
    Shader();
    // `name` as in shaders/ without ".comp": "temporal/karis". Throws std::logic_error on an unknown one.
    Shader(std::string_view name, std::vector<Constant> constants = {});
    Shader(Shader&&) noexcept;
    Shader& operator=(Shader&&) noexcept;
    ~Shader();
    const std::string& name() const { return name_; }

  private:
    friend class Recorder;
    struct Pipeline;
    std::string name_;
    std::vector<Constant> constants_;
    std::unique_ptr<Pipeline> pipeline_;
};

struct DeviceOptions {
    bool validate = false;          // Vulkan's validation layer: every complaint is a DeviceError at the next wait()
    std::filesystem::path shaders;  // FOLDER/temporal/karis.spv stands for the program's own shader; empty: none does
};
// A device that was opened. `text`: "vulkan", "vulkan:N" or "vulkan:part of a name"; the first usable one where nothing
// is chosen, a real card before software. Throws DeviceError (nothing that fits; what there is), UsageError.
class Device {
  public:
    explicit Device(std::string_view text, DeviceOptions options = {});
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;
    const DeviceInfo& info() const;
    DeviceState& state() const { return *state_; }

  private:
    std::unique_ptr<DeviceState> state_;
};

// Seconds of one dispatch on the device, by its own clock.
struct PassTime {
    std::string shader;
    double seconds;
    size_t bytesRead, bytesWritten;  // every image and buffer that it binds, once
};

// Commands in order; each sees what those before it wrote. Nothing runs before submit().
class Recorder {
  public:
    explicit Recorder(const Device& device);
    ~Recorder();
    Recorder(const Recorder&) = delete;
    Recorder& operator=(const Recorder&) = delete;

    // `push`: at most 128 bytes, as the shader's push constants lie.
    template <class Push>
    void dispatch(Shader& shader, int width, int height, std::span<const Binding> bindings, const Push& push) {
        static_assert(sizeof(Push) <= 128 && std::is_trivially_copyable_v<Push>);
        dispatchBytes(shader, width, height, bindings, {reinterpret_cast<const std::byte*>(&push), sizeof(Push)});
    }
    // One invocation per pixel of width x height, in workgroups of 8 x 8.
    void dispatchBytes(Shader& shader, int width, int height, std::span<const Binding> bindings,
                       std::span<const std::byte> push);
    void copy(const Image& from, Image& to);  // of one size and format
    void clear(Image& image, std::array<float, 4> value = {0, 0, 0, 0});
    void clear(Buffer& buffer);
    // `fill` writes the image's texels, layer after layer without padding, into memory that the device reads.
    void upload(Image& to, const std::function<void(std::byte*)>& fill);
    void upload(Buffer& to, std::span<const std::byte> bytes);
    // `take` reads them after the work is done, in wait().
    void download(const Image& from, std::function<void(const std::byte*)> take);
    void download(const Buffer& from, std::function<void(const std::byte*)> take);

    void submit();
    void wait();  // until what was submitted is done; then the recorder is empty again. Throws DeviceError.
    void run() { submit(), wait(); }
    // Of the dispatches of the last wait(), in order; empty where the device has no clock.
    const std::vector<PassTime>& times() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace aa::gpu
