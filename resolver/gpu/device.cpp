#include "gpu/device.h"

#define VULKAN_HPP_NO_SPACESHIP_OPERATOR
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <optional>
#include <vulkan/vulkan_raii.hpp>

#include "gpu/shader_library.h"
#include "image/lower_case.h"

namespace aa::gpu {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";
constexpr uint32_t kGroup = 8;  // px per side of a workgroup

vk::Format vulkan(Format f) {
    switch (f) {
        case Format::rgba32f:
            return vk::Format::eR32G32B32A32Sfloat;
        case Format::rgba16f:
            return vk::Format::eR16G16B16A16Sfloat;
        case Format::rg32f:
            return vk::Format::eR32G32Sfloat;
        case Format::rg16f:
            return vk::Format::eR16G16Sfloat;
        case Format::r32f:
            return vk::Format::eR32Sfloat;
        case Format::r32ui:
            return vk::Format::eR32Uint;
        case Format::rgba8:
            return vk::Format::eR8G8B8A8Unorm;
    }
    throw std::logic_error("gpu::Format: unknown");
}
const char* kindOf(vk::PhysicalDeviceType type) {
    switch (type) {
        case vk::PhysicalDeviceType::eDiscreteGpu:
            return "discrete";
        case vk::PhysicalDeviceType::eIntegratedGpu:
            return "integrated";
        case vk::PhysicalDeviceType::eVirtualGpu:
            return "virtual";
        case vk::PhysicalDeviceType::eCpu:
            return "cpu";
        default:
            return "other";
    }
}
int rank(const DeviceInfo& d) {
    const std::string_view kinds[] = {"discrete", "integrated", "virtual", "other", "cpu"};
    return int(std::find(std::begin(kinds), std::end(kinds), d.kind) - std::begin(kinds));
}

struct Loader {
    vk::raii::Context context;
    vk::raii::Instance instance = nullptr;
};
Loader load(bool validate) {
    std::optional<vk::raii::Context> context;
    try {
        context.emplace();
    } catch (const std::exception&) {
        throw DeviceError(
            "--device vulkan: no Vulkan loader (libvulkan.so.1) on this machine; install libvulkan1 and your card's "
            "driver (mesa-vulkan-drivers has one in software), or use --device cpu");
    }
    Loader loader{std::move(*context)};
    const vk::ApplicationInfo application("aaresolve", 1, "aaresolve", 1, VK_API_VERSION_1_1);
    std::vector<const char*> layers, extensions;
    if (validate) {
        const auto found = loader.context.enumerateInstanceLayerProperties();
        if (std::none_of(found.begin(), found.end(),
                         [](const auto& l) { return std::string_view(l.layerName) == kValidationLayer; }))
            throw DeviceError("--gpu-validate: Vulkan's validation layer is not installed (vulkan-validationlayers)");
        layers.push_back(kValidationLayer);
        extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    }
    try {
        loader.instance =
            vk::raii::Instance(loader.context, vk::InstanceCreateInfo({}, &application, layers, extensions));
    } catch (const vk::SystemError& e) {
        throw DeviceError(std::string("--device vulkan: no driver answers (") + e.what() +
                          "); install your card's driver (mesa-vulkan-drivers has one in software), or use --device "
                          "cpu");
    }
    return loader;
}

std::string lacksOf(const vk::raii::PhysicalDevice& device, const vk::PhysicalDeviceProperties& properties) {
    if (properties.apiVersion < VK_API_VERSION_1_1) return "Vulkan 1.1";
    const auto features = device.getFeatures();
    if (!features.shaderStorageImageWriteWithoutFormat) return "shaderStorageImageWriteWithoutFormat";
    if (!features.shaderStorageImageExtendedFormats) return "shaderStorageImageExtendedFormats";
    if (properties.limits.maxComputeSharedMemorySize < 32768) return "32 KB of shared memory";
    if (properties.limits.maxComputeWorkGroupInvocations < 256) return "workgroups of 256 invocations";
    if (properties.limits.maxPerStageDescriptorStorageImages < 8) return "8 storage images in a shader";
    for (const auto& family : device.getQueueFamilyProperties())
        if (family.queueFlags & vk::QueueFlagBits::eCompute) return {};
    return "a compute queue";
}
struct Found {
    vk::raii::PhysicalDevice device;
    DeviceInfo info;
};
std::vector<Found> devicesOf(const vk::raii::Instance& instance) {
    std::vector<Found> all;
    std::vector<vk::raii::PhysicalDevice> devices;
    try {
        for (auto& d : vk::raii::PhysicalDevices(instance)) devices.push_back(std::move(d));
    } catch (const vk::SystemError&) {  // a loader without any driver
    }
    for (auto& d : devices) {
        const auto p = d.getProperties();
        DeviceInfo info;
        info.name = std::string(p.deviceName);
        info.kind = kindOf(p.deviceType);
        info.api = std::to_string(VK_API_VERSION_MAJOR(p.apiVersion)) + "." +
                   std::to_string(VK_API_VERSION_MINOR(p.apiVersion)) + "." +
                   std::to_string(VK_API_VERSION_PATCH(p.apiVersion));
        if (p.apiVersion >= VK_API_VERSION_1_2) {
            const auto chain = d.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceDriverProperties>();
            const auto& driver = chain.get<vk::PhysicalDeviceDriverProperties>();
            info.driver = std::string(driver.driverName) + " " + std::string(driver.driverInfo);
        }
        const auto memory = d.getMemoryProperties();
        for (uint32_t i = 0; i < memory.memoryHeapCount; i++)
            if (memory.memoryHeaps[i].flags & vk::MemoryHeapFlagBits::eDeviceLocal)
                info.memoryBytes += memory.memoryHeaps[i].size;
        info.lacks = lacksOf(d, p);
        all.push_back({std::move(d), std::move(info)});
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const Found& a, const Found& b) { return rank(a.info) < rank(b.info); });
    for (size_t i = 0; i < all.size(); i++) all[i].info.index = i;
    return all;
}
// The device that `text` asks for.
size_t choose(const std::vector<Found>& devices, std::string_view text) {
    if (text != "vulkan" && !text.starts_with("vulkan:"))
        throw UsageError("--device: expected cpu, vulkan, vulkan:NUMBER or vulkan:NAME, found '" + std::string(text) +
                         "'");
    if (devices.empty())
        throw DeviceError(
            "--device vulkan: no device and no driver; install your card's driver (mesa-vulkan-drivers has one in "
            "software), or use --device cpu");
    std::string list;
    for (const Found& d : devices)
        list += (list.empty() ? "" : ", ") + std::to_string(d.info.index) + " " + d.info.name;
    const std::string_view wanted = text.size() > 7 ? text.substr(7) : std::string_view{};
    size_t number = 0;
    const auto [end, failed] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), number);
    const bool isNumber = !wanted.empty() && failed == std::errc{} && end == wanted.data() + wanted.size();
    for (const Found& d : devices) {
        const bool fits = isNumber         ? d.info.index == number
                          : wanted.empty() ? d.info.lacks.empty()
                                           : lowerCase(d.info.name).find(lowerCase(wanted)) != std::string::npos;
        if (!fits) continue;
        if (!d.info.lacks.empty()) throw DeviceError("--device: " + d.info.name + " lacks " + d.info.lacks);
        return d.info.index;
    }
    throw DeviceError("--device " + std::string(text) + ": no such usable device; there is " + list);
}

}  // namespace

size_t bytesPerTexel(Format f) {
    switch (f) {
        case Format::rgba32f:
            return 16;
        case Format::rgba16f:
        case Format::rg32f:
            return 8;
        case Format::rg16f:
        case Format::r32f:
        case Format::r32ui:
        case Format::rgba8:
            return 4;
    }
    throw std::logic_error("gpu::Format: unknown");
}

std::string refusal(int result, const std::string& device, const std::string& during) {
    switch (vk::Result(result)) {
        case vk::Result::eErrorDeviceLost:
            return "--device: " + device + " was lost during " + during +
                   " (its driver reset it, or another program's fault did); run again, or use --device cpu";
        case vk::Result::eErrorOutOfDeviceMemory:
            return "--device: " + device + " is out of memory during " + during +
                   "; use fewer methods or a smaller resolution, or --device cpu";
        case vk::Result::eErrorOutOfHostMemory:
            return "--device: out of memory on this machine during " + during +
                   "; use fewer methods or a smaller resolution";
        default:
            return "--device: " + device + ": " + vk::to_string(vk::Result(result)) + " during " + during +
                   "; use --device cpu";
    }
}

std::vector<DeviceInfo> listDevices() {
    const Loader loader = load(false);
    std::vector<DeviceInfo> all;
    for (auto& d : devicesOf(loader.instance)) all.push_back(std::move(d.info));
    return all;
}

class DeviceState {
  public:
    DeviceInfo info;
    std::filesystem::path shaders;  // of SPIR-V that stands for the program's own
    Loader loader;
    std::vector<std::string> complaints;  // of the validation layer
    std::mutex complaintsMutex;
    vk::raii::DebugUtilsMessengerEXT messenger = nullptr;
    vk::raii::PhysicalDevice physical = nullptr;
    vk::PhysicalDeviceMemoryProperties memory;
    vk::PhysicalDeviceLimits limits;
    uint32_t family = 0, timestampBits = 0;
    vk::raii::Device device = nullptr;
    vk::raii::Queue queue = nullptr;
    std::mutex queueMutex;
    vk::raii::Sampler nearest = nullptr, linear = nullptr;
    vk::raii::PipelineCache cache = nullptr;
    vk::raii::CommandPool setupPool = nullptr;  // of the images' first commands, under the queue's mutex

    // Vulkan's errors as one line for the user.
    template <class Fn>
    auto guarded(const Fn& fn, const std::string& during) const {
        try {
            return fn();
        } catch (const vk::SystemError& e) {
            throw DeviceError(refusal(e.code().value(), info.name, during));
        }
    }
    void complain() {
        const std::lock_guard lock(complaintsMutex);
        if (complaints.empty()) return;
        const std::string first = complaints.front();
        const size_t count = complaints.size();
        complaints.clear();
        throw DeviceError("Vulkan's validation layer: " + first +
                          (count > 1 ? " (and " + std::to_string(count - 1) + " more)" : ""));
    }
    vk::raii::DeviceMemory allocate(const vk::MemoryRequirements& needs, vk::MemoryPropertyFlags wanted,
                                    vk::MemoryPropertyFlags preferred = {}) const {
        for (const auto flags : {wanted | preferred, wanted})
            for (uint32_t i = 0; i < memory.memoryTypeCount; i++)
                if ((needs.memoryTypeBits >> i & 1) && (memory.memoryTypes[i].propertyFlags & flags) == flags)
                    return {device, {needs.size, i}};
        throw DeviceError("--device: " + info.name + " has no memory of the kind that is needed");
    }
    // Runs a few commands at once.
    template <class Fn>
    void now(const Fn& record) {
        const std::lock_guard lock(queueMutex);
        vk::raii::CommandBuffers buffers(device, {*setupPool, vk::CommandBufferLevel::ePrimary, 1});
        buffers[0].begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
        record(buffers[0]);
        buffers[0].end();
        const vk::CommandBuffer commands = *buffers[0];
        queue.submit(vk::SubmitInfo({}, {}, commands));
        queue.waitIdle();
    }
};

namespace {
VKAPI_ATTR VkBool32 VKAPI_CALL onComplaint(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                           const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    auto& state = *static_cast<DeviceState*>(user);
    const std::lock_guard lock(state.complaintsMutex);
    state.complaints.emplace_back(data->pMessage);
    return VK_FALSE;
}
std::unique_ptr<DeviceState> open(std::string_view text, DeviceOptions options) {
    auto s = std::make_unique<DeviceState>();
    s->shaders = options.shaders;
    s->loader = load(options.validate);
    auto devices = devicesOf(s->loader.instance);
    Found& chosen = devices[choose(devices, text)];
    s->info = chosen.info;
    s->physical = std::move(chosen.device);
    s->memory = s->physical.getMemoryProperties();
    s->limits = s->physical.getProperties().limits;
    if (options.validate) {
        // The C structure: later headers take other types of function in the C++ one.
        VkDebugUtilsMessengerCreateInfoEXT wanted{};
        wanted.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
        wanted.messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
        wanted.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
        wanted.pfnUserCallback = onComplaint;
        wanted.pUserData = s.get();
        s->messenger = {s->loader.instance, vk::DebugUtilsMessengerCreateInfoEXT(wanted)};
    }
    s->guarded(
        [&] {
            const auto families = s->physical.getQueueFamilyProperties();
            // A family of compute alone where there is one, otherwise any that computes.
            for (uint32_t i = uint32_t(families.size()); i-- > 0;)
                if (families[i].queueFlags & vk::QueueFlagBits::eCompute) s->family = i;
            s->timestampBits = families[s->family].timestampValidBits;
            const float priority = 1;
            const vk::DeviceQueueCreateInfo queues({}, s->family, 1, &priority);
            vk::PhysicalDeviceFeatures features;
            features.shaderStorageImageWriteWithoutFormat = true;
            features.shaderStorageImageExtendedFormats = true;
            s->device = {s->physical, vk::DeviceCreateInfo({}, queues, {}, {}, &features)};
            s->queue = {s->device, s->family, 0};
            const auto sampler = [&](vk::Filter filter) {
                const auto edge = vk::SamplerAddressMode::eClampToEdge;
                return vk::raii::Sampler(
                    s->device,
                    vk::SamplerCreateInfo({}, filter, filter, vk::SamplerMipmapMode::eNearest, edge, edge, edge));
            };
            s->nearest = sampler(vk::Filter::eNearest), s->linear = sampler(vk::Filter::eLinear);
            s->cache = {s->device, vk::PipelineCacheCreateInfo()};
            s->setupPool = {s->device, vk::CommandPoolCreateInfo({}, s->family)};
        },
        "its start");
    return s;
}
}  // namespace

Device::Device(std::string_view text, DeviceOptions options) : state_(open(text, options)) {}
Device::~Device() = default;
const DeviceInfo& Device::info() const { return state_->info; }

// ---- images and buffers ---------------------------------------------------------------------------------------------
struct Image::State {
    vk::raii::DeviceMemory memory = nullptr;
    vk::raii::Image image = nullptr;
    vk::raii::ImageView view = nullptr;
};
struct Buffer::State {
    vk::raii::DeviceMemory memory = nullptr;
    vk::raii::Buffer buffer = nullptr;
};
namespace {
constexpr vk::ImageSubresourceRange allLayers() {
    return {vk::ImageAspectFlagBits::eColor, 0, 1, 0, VK_REMAINING_ARRAY_LAYERS};
}
vk::ClearColorValue black(Format format) {
    return format == Format::r32ui ? vk::ClearColorValue(std::array<uint32_t, 4>{})
                                   : vk::ClearColorValue(std::array<float, 4>{});
}
}  // namespace

Image::Image(const Device& of, int width, int height, Format format, int layers)
    : state_(std::make_unique<State>()), width_(width), height_(height), layers_(layers), format_(format) {
    DeviceState& d = of.state();
    const uint32_t most = d.limits.maxImageDimension2D;
    if (uint32_t(width) > most || uint32_t(height) > most)
        throw DeviceError("--device: " + d.info.name + " holds images of at most " + std::to_string(most) + " x " +
                          std::to_string(most) + " px, found " + std::to_string(width) + " x " +
                          std::to_string(height) + "; use --device cpu");
    d.guarded(
        [&] {
            using Usage = vk::ImageUsageFlagBits;
            state_->image = {
                d.device,
                vk::ImageCreateInfo({}, vk::ImageType::e2D, vulkan(format), {uint32_t(width), uint32_t(height), 1}, 1,
                                    uint32_t(this->layers()), vk::SampleCountFlagBits::e1, vk::ImageTiling::eOptimal,
                                    Usage::eSampled | Usage::eStorage | Usage::eTransferSrc | Usage::eTransferDst)};
            state_->memory =
                d.allocate(state_->image.getMemoryRequirements(), vk::MemoryPropertyFlagBits::eDeviceLocal);
            state_->image.bindMemory(*state_->memory, 0);
            state_->view = {d.device,
                            vk::ImageViewCreateInfo({}, *state_->image,
                                                    layers > 0 ? vk::ImageViewType::e2DArray : vk::ImageViewType::e2D,
                                                    vulkan(format), {}, allLayers())};
            d.now([&](const vk::raii::CommandBuffer& c) {
                c.pipelineBarrier(
                    vk::PipelineStageFlagBits::eTopOfPipe, vk::PipelineStageFlagBits::eTransfer, {}, {}, {},
                    vk::ImageMemoryBarrier({}, vk::AccessFlagBits::eTransferWrite, vk::ImageLayout::eUndefined,
                                           vk::ImageLayout::eGeneral, VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_IGNORED,
                                           *state_->image, allLayers()));
                c.clearColorImage(*state_->image, vk::ImageLayout::eGeneral, black(format), allLayers());
            });
        },
        "making an image of " + std::to_string(width) + " x " + std::to_string(height) + " px");
}
Image::Image() = default;
Image::Image(Image&&) noexcept = default;
Image& Image::operator=(Image&&) noexcept = default;
Image::~Image() = default;

Buffer::Buffer(const Device& of, size_t bytes) : state_(std::make_unique<State>()), bytes_((bytes + 3) / 4 * 4) {
    DeviceState& d = of.state();
    if (bytes_ > d.limits.maxStorageBufferRange)
        throw DeviceError("--device: " + d.info.name + " holds buffers of at most " +
                          std::to_string(d.limits.maxStorageBufferRange) + " bytes, found " + std::to_string(bytes) +
                          "; use --device cpu");
    d.guarded(
        [&] {
            using Usage = vk::BufferUsageFlagBits;
            state_->buffer = {d.device,
                              vk::BufferCreateInfo({}, std::max<size_t>(bytes_, 4),
                                                   Usage::eStorageBuffer | Usage::eTransferSrc | Usage::eTransferDst)};
            state_->memory =
                d.allocate(state_->buffer.getMemoryRequirements(), vk::MemoryPropertyFlagBits::eDeviceLocal);
            state_->buffer.bindMemory(*state_->memory, 0);
            d.now([&](const vk::raii::CommandBuffer& c) { c.fillBuffer(*state_->buffer, 0, VK_WHOLE_SIZE, 0); });
        },
        "making a buffer of " + std::to_string(bytes) + " bytes");
}
Buffer::Buffer() = default;
Buffer::Buffer(Buffer&&) noexcept = default;
Buffer& Buffer::operator=(Buffer&&) noexcept = default;
Buffer::~Buffer() = default;

// ---- shaders --------------------------------------------------------------------------------------------------------
struct Shader::Pipeline {
    vk::raii::DescriptorSetLayout sets = nullptr;
    vk::raii::PipelineLayout layout = nullptr;
    vk::raii::Pipeline pipeline = nullptr;
    std::vector<Binding::Kind> kinds;
};
namespace {
std::span<const uint32_t> codeOf(std::string_view name) {
    for (const ShaderCode& s : shaderLibrary())
        if (s.name == name) return s.words;
    throw std::logic_error("gpu::Shader: there is no shaders/" + std::string(name) + ".comp");
}
// FOLDER/name.spv where it exists, otherwise what the program holds.
std::vector<uint32_t> codeOf(std::string_view name, const std::filesystem::path& folder) {
    const auto held = codeOf(name);
    std::vector<uint32_t> words(held.begin(), held.end());
    const std::filesystem::path path = folder / (std::string(name) + ".spv");
    std::ifstream file(path, std::ios::binary);
    if (folder.empty() || !file) return words;
    const std::string bytes((std::istreambuf_iterator<char>(file)), {});
    constexpr uint32_t kMagic = 0x07230203;
    words.assign(bytes.size() / 4, 0);
    std::memcpy(words.data(), bytes.data(), 4 * words.size());
    if (bytes.size() % 4 != 0 || words.size() < 5 || words[0] != kMagic)
        throw DeviceError(path.string() + ": expected SPIR-V, as glslangValidator -V writes it");
    return words;
}
vk::DescriptorType typeOf(Binding::Kind kind) {
    return kind == Binding::Kind::image    ? vk::DescriptorType::eStorageImage
           : kind == Binding::Kind::buffer ? vk::DescriptorType::eStorageBuffer
                                           : vk::DescriptorType::eCombinedImageSampler;
}
}  // namespace
Shader::Shader(std::string_view name, std::vector<Constant> constants) : name_(name), constants_(std::move(constants)) {
    codeOf(name_);
}
Shader::Shader() = default;
Shader::Shader(Shader&&) noexcept = default;
Shader& Shader::operator=(Shader&&) noexcept = default;
Shader::~Shader() = default;

// ---- recorder -------------------------------------------------------------------------------------------------------
namespace {
// Host memory that the device copies from or into, in chunks that are used again.
class Staging {
  public:
    struct Piece {
        vk::Buffer buffer;
        size_t offset;
        std::byte* memory;
    };
    Staging(DeviceState& device, bool readBack) : device_(device), readBack_(readBack) {}
    Piece take(size_t bytes) {
        const size_t needed = (bytes + 255) / 256 * 256;
        for (Chunk& c : chunks_)
            if (c.size - c.used >= needed) return piece(c, needed);
        return piece(chunks_.emplace_back(make(std::max(needed, kChunk))), needed);
    }
    void reset() {
        for (Chunk& c : chunks_) c.used = 0;
    }

  private:
    static constexpr size_t kChunk = 8 << 20;
    struct Chunk {
        vk::raii::DeviceMemory memory = nullptr;
        vk::raii::Buffer buffer = nullptr;
        std::byte* mapped = nullptr;
        size_t size = 0, used = 0;
    };
    Chunk make(size_t bytes) {
        using Memory = vk::MemoryPropertyFlagBits;
        Chunk c;
        c.size = bytes;
        c.buffer = {device_.device,
                    vk::BufferCreateInfo(
                        {}, bytes, vk::BufferUsageFlagBits::eTransferSrc | vk::BufferUsageFlagBits::eTransferDst)};
        c.memory = device_.allocate(c.buffer.getMemoryRequirements(), Memory::eHostVisible | Memory::eHostCoherent,
                                    readBack_ ? Memory::eHostCached : vk::MemoryPropertyFlags{});
        c.buffer.bindMemory(*c.memory, 0);
        c.mapped = static_cast<std::byte*>(c.memory.mapMemory(0, VK_WHOLE_SIZE));
        return c;
    }
    static Piece piece(Chunk& c, size_t bytes) {
        const Piece p{*c.buffer, c.used, c.mapped + c.used};
        c.used += bytes;
        return p;
    }
    DeviceState& device_;
    bool readBack_;
    std::vector<Chunk> chunks_;
};
constexpr uint32_t kMostQueries = 1024;
}  // namespace

struct Recorder::State {
    DeviceState& d;
    vk::raii::CommandPool pool;
    vk::raii::CommandBuffer commands = nullptr;
    vk::raii::Fence fence;
    vk::raii::QueryPool queries = nullptr;
    std::vector<vk::raii::DescriptorPool> setPools;
    std::vector<vk::raii::DescriptorSet> sets;
    Staging up, down;
    struct Download {
        const std::byte* memory;
        std::function<void(const std::byte*)> take;
    };
    std::vector<Download> downloads;
    struct Timed {
        std::string shader;
        size_t bytesRead = 0, bytesWritten = 0;
    };
    std::vector<Timed> timed;
    std::vector<PassTime> times;
    bool recording = false, submitted = false;

    explicit State(DeviceState& device)
        : d(device),
          pool(device.device,
               vk::CommandPoolCreateInfo(vk::CommandPoolCreateFlagBits::eResetCommandBuffer, device.family)),
          fence(device.device, vk::FenceCreateInfo()),
          up(device, false),
          down(device, true) {
        commands = std::move(vk::raii::CommandBuffers(d.device, {*pool, vk::CommandBufferLevel::ePrimary, 1})[0]);
        if (d.timestampBits > 0)
            queries = {d.device, vk::QueryPoolCreateInfo({}, vk::QueryType::eTimestamp, kMostQueries)};
    }
    const vk::raii::CommandBuffer& begun() {
        if (!recording) {
            commands.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
            if (d.timestampBits > 0) commands.resetQueryPool(*queries, 0, kMostQueries);
            recording = true;
        }
        return commands;
    }
    // Everything before is done and seen by everything after.
    void barrier() {
        using Stage = vk::PipelineStageFlagBits;
        using Access = vk::AccessFlagBits;
        const auto stages = Stage::eComputeShader | Stage::eTransfer | Stage::eHost;
        begun().pipelineBarrier(stages, stages, {},
                                vk::MemoryBarrier(Access::eShaderWrite | Access::eTransferWrite | Access::eHostWrite,
                                                  Access::eShaderRead | Access::eShaderWrite | Access::eTransferRead |
                                                      Access::eTransferWrite | Access::eHostRead),
                                {}, {});
    }
    vk::raii::DescriptorSet newSet(vk::DescriptorSetLayout layout) {
        const auto tryOne = [&]() -> std::optional<vk::raii::DescriptorSet> {
            if (setPools.empty()) return {};
            try {
                return std::move(vk::raii::DescriptorSets(d.device, {*setPools.back(), layout})[0]);
            } catch (const vk::OutOfPoolMemoryError&) {
                return {};
            } catch (const vk::FragmentedPoolError&) {
                return {};
            }
        };
        if (auto set = tryOne()) return std::move(*set);
        constexpr uint32_t kSets = 64;
        const vk::DescriptorPoolSize sizes[] = {{vk::DescriptorType::eCombinedImageSampler, 12 * kSets},
                                                {vk::DescriptorType::eStorageImage, 6 * kSets},
                                                {vk::DescriptorType::eStorageBuffer, 6 * kSets}};
        setPools.emplace_back(
            d.device, vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, kSets, sizes));
        return std::move(*tryOne());
    }
};

Recorder::Recorder(const Device& device)
    : state_(device.state().guarded([&] { return std::make_unique<State>(device.state()); }, "its start")) {}
Recorder::~Recorder() {
    if (state_->submitted) try {
            wait();
        } catch (const std::exception&) {  // told by whoever waited for it
        }
}

void Recorder::dispatchBytes(Shader& shader, int width, int height, std::span<const Binding> bindings,
                             std::span<const std::byte> push) {
    State& s = *state_;
    DeviceState& d = s.d;
    d.guarded(
        [&] {
            if (!shader.pipeline_) {
                auto p = std::make_unique<Shader::Pipeline>();
                std::vector<vk::DescriptorSetLayoutBinding> slots;
                for (uint32_t i = 0; i < bindings.size(); i++) {
                    p->kinds.push_back(bindings[i].kind);
                    slots.emplace_back(i, typeOf(bindings[i].kind), 1, vk::ShaderStageFlagBits::eCompute);
                }
                p->sets = {d.device, vk::DescriptorSetLayoutCreateInfo({}, slots)};
                const vk::PushConstantRange range(vk::ShaderStageFlagBits::eCompute, 0, uint32_t(push.size()));
                const vk::DescriptorSetLayout layout = *p->sets;
                vk::PipelineLayoutCreateInfo layoutInfo({}, layout);
                if (!push.empty()) layoutInfo.setPushConstantRanges(range);
                p->layout = {d.device, layoutInfo};
                const auto code = codeOf(shader.name_, d.shaders);
                const vk::raii::ShaderModule module(d.device,
                                                    vk::ShaderModuleCreateInfo({}, 4 * code.size(), code.data()));
                std::vector<vk::SpecializationMapEntry> entries;
                std::vector<uint32_t> values;
                for (const Constant& c : shader.constants_) {
                    entries.emplace_back(c.id, uint32_t(4 * values.size()), 4);
                    values.push_back(c.bits);
                }
                const vk::SpecializationInfo special(uint32_t(entries.size()), entries.data(), 4 * values.size(),
                                                     values.data());
                p->pipeline = {d.device, d.cache,
                               vk::ComputePipelineCreateInfo(
                                   {}, {{}, vk::ShaderStageFlagBits::eCompute, *module, "main", &special}, *p->layout)};
                shader.pipeline_ = std::move(p);
            }
            const Shader::Pipeline& p = *shader.pipeline_;
            vk::raii::DescriptorSet set = s.newSet(*p.sets);
            std::vector<vk::DescriptorImageInfo> images(bindings.size());
            std::vector<vk::DescriptorBufferInfo> buffers(bindings.size());
            std::vector<vk::WriteDescriptorSet> writes;
            for (uint32_t i = 0; i < bindings.size(); i++) {
                const Binding& b = bindings[i];
                if (typeOf(b.kind) != typeOf(p.kinds.at(i)))
                    throw std::logic_error("gpu::Recorder: " + shader.name_ + ": binding " + std::to_string(i) +
                                           " changed its kind");
                vk::WriteDescriptorSet w(*set, i, 0, 1, typeOf(b.kind));
                if (b.memory) {
                    buffers[i] = vk::DescriptorBufferInfo(*b.memory->state().buffer, 0, VK_WHOLE_SIZE);
                    w.pBufferInfo = &buffers[i];
                } else {
                    images[i] = vk::DescriptorImageInfo(b.kind == Binding::Kind::linear ? *d.linear : *d.nearest,
                                                        *b.texture->state().view, vk::ImageLayout::eGeneral);
                    w.pImageInfo = &images[i];
                }
                writes.push_back(w);
            }
            d.device.updateDescriptorSets(writes, {});
            s.barrier();
            const auto& c = s.commands;
            const uint32_t query = 2 * uint32_t(s.timed.size());
            const bool time = d.timestampBits > 0 && query + 2 <= kMostQueries;
            c.bindPipeline(vk::PipelineBindPoint::eCompute, *p.pipeline);
            c.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *p.layout, 0, *set, {});
            if (!push.empty())
                c.pushConstants<std::byte>(*p.layout, vk::ShaderStageFlagBits::eCompute, 0,
                                           vk::ArrayProxy<const std::byte>(uint32_t(push.size()), push.data()));
            if (time) c.writeTimestamp(vk::PipelineStageFlagBits::eBottomOfPipe, *s.queries, query);
            c.dispatch((uint32_t(width) + kGroup - 1) / kGroup, (uint32_t(height) + kGroup - 1) / kGroup, 1);
            if (time) {
                c.writeTimestamp(vk::PipelineStageFlagBits::eBottomOfPipe, *s.queries, query + 1);
                State::Timed& t = s.timed.emplace_back();
                t.shader = shader.name_;
                for (const Binding& b : bindings) {
                    if (b.kind == Binding::Kind::image)
                        t.bytesWritten += b.texture->bytes();
                    else
                        t.bytesRead += b.memory ? b.memory->bytes() : b.texture->bytes();
                }
            }
            s.sets.push_back(std::move(set));
        },
        shader.name_);
}
void Recorder::copy(const Image& from, Image& to) {
    State& s = *state_;
    s.barrier();
    const vk::ImageSubresourceLayers layers(vk::ImageAspectFlagBits::eColor, 0, 0, uint32_t(from.layers()));
    s.commands.copyImage(*from.state().image, vk::ImageLayout::eGeneral, *to.state().image, vk::ImageLayout::eGeneral,
                         vk::ImageCopy(layers, {}, layers, {}, {uint32_t(from.width()), uint32_t(from.height()), 1}));
}
void Recorder::clear(Image& image, std::array<float, 4> value) {
    state_->barrier();
    const auto whole =
        std::array<uint32_t, 4>{uint32_t(value[0]), uint32_t(value[1]), uint32_t(value[2]), uint32_t(value[3])};
    state_->commands.clearColorImage(
        *image.state().image, vk::ImageLayout::eGeneral,
        image.format() == Format::r32ui ? vk::ClearColorValue(whole) : vk::ClearColorValue(value), allLayers());
}
void Recorder::clear(Buffer& buffer) {
    state_->barrier();
    state_->commands.fillBuffer(*buffer.state().buffer, 0, VK_WHOLE_SIZE, 0);
}
namespace {
vk::BufferImageCopy wholeImage(const Image& image, size_t offset) {
    return vk::BufferImageCopy(offset, 0, 0, {vk::ImageAspectFlagBits::eColor, 0, 0, uint32_t(image.layers())}, {},
                               {uint32_t(image.width()), uint32_t(image.height()), 1});
}
}  // namespace
void Recorder::upload(Image& to, const std::function<void(std::byte*)>& fill) {
    State& s = *state_;
    s.d.guarded(
        [&] {
            const auto piece = s.up.take(to.bytes());
            fill(piece.memory);
            s.barrier();
            s.commands.copyBufferToImage(piece.buffer, *to.state().image, vk::ImageLayout::eGeneral,
                                         wholeImage(to, piece.offset));
        },
        "an upload");
}
void Recorder::upload(Buffer& to, std::span<const std::byte> bytes) {
    State& s = *state_;
    if (bytes.empty()) return;
    s.d.guarded(
        [&] {
            const auto piece = s.up.take(bytes.size());
            std::copy(bytes.begin(), bytes.end(), piece.memory);
            s.barrier();
            s.commands.copyBuffer(piece.buffer, *to.state().buffer, vk::BufferCopy(piece.offset, 0, bytes.size()));
        },
        "an upload");
}
void Recorder::download(const Image& from, std::function<void(const std::byte*)> take) {
    State& s = *state_;
    s.d.guarded(
        [&] {
            const auto piece = s.down.take(from.bytes());
            s.barrier();
            s.commands.copyImageToBuffer(*from.state().image, vk::ImageLayout::eGeneral, piece.buffer,
                                         wholeImage(from, piece.offset));
            s.downloads.push_back({piece.memory, std::move(take)});
        },
        "a download");
}
void Recorder::download(const Buffer& from, std::function<void(const std::byte*)> take) {
    State& s = *state_;
    s.d.guarded(
        [&] {
            const auto piece = s.down.take(from.bytes());
            s.barrier();
            s.commands.copyBuffer(*from.state().buffer, piece.buffer, vk::BufferCopy(0, piece.offset, from.bytes()));
            s.downloads.push_back({piece.memory, std::move(take)});
        },
        "a download");
}
void Recorder::submit() {
    State& s = *state_;
    s.d.guarded(
        [&] {
            s.barrier();
            s.commands.end();
            const std::lock_guard lock(s.d.queueMutex);
            const vk::CommandBuffer commands = *s.commands;
            s.d.queue.submit(vk::SubmitInfo({}, {}, commands), *s.fence);
            s.submitted = true;
        },
        "a submission");
}
void Recorder::wait() {
    State& s = *state_;
    if (!s.submitted) return;
    s.submitted = s.recording = false;
    s.d.guarded(
        [&] {
            constexpr uint64_t kPatience = 120'000'000'000;  // ns; a driver that hangs must not hang the program
            if (s.d.device.waitForFences(*s.fence, true, kPatience) != vk::Result::eSuccess)
                throw DeviceError("--device: " + s.d.info.name + " did not answer for two minutes; use --device cpu");
            s.d.device.resetFences(*s.fence);
            s.times.clear();
            if (!s.timed.empty()) {
                const auto [result, ticks] = s.queries.getResults<uint64_t>(
                    0, uint32_t(2 * s.timed.size()), 2 * s.timed.size() * sizeof(uint64_t), sizeof(uint64_t),
                    vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait);
                const uint64_t mask = s.d.timestampBits >= 64 ? ~uint64_t(0) : (uint64_t(1) << s.d.timestampBits) - 1;
                for (size_t i = 0; i < s.timed.size(); i++)
                    s.times.push_back(
                        {s.timed[i].shader,
                         1e-9 * double(s.d.limits.timestampPeriod) * double((ticks[2 * i + 1] - ticks[2 * i]) & mask),
                         s.timed[i].bytesRead, s.timed[i].bytesWritten});
            }
        },
        "its work");
    for (const auto& d : s.downloads) d.take(d.memory);
    s.downloads.clear(), s.timed.clear(), s.sets.clear();
    s.up.reset(), s.down.reset();
    s.d.complain();
}
const std::vector<PassTime>& Recorder::times() const { return state_->times; }

}  // namespace aa::gpu
