// shaders/temporal/karis.comp in a program of its own: nothing here knows aaresolve. What an engine does each frame, on
// files: bind seven images and a buffer, push the frame's numbers, dispatch, swap the history.
//
//   glslangValidator -V --target-env vulkan1.1 ../temporal/karis.comp -o karis.spv
//   g++ -std=c++20 -O2 host.cpp -o host $(pkg-config --cflags --libs OpenEXR) -lvulkan
//   ./host karis.spv SHOT result.exr
//
// SHOT: a folder as the add-on or `aaresolve synth` writes it (docs/format.md). result.exr: the last frame, linear.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <vulkan/vulkan_raii.hpp>

using Pixels = std::vector<float>;  // 4 per texel

// Channels of a multi-part EXR, whichever part holds them, interleaved into four.
Pixels load(const std::string& path, std::vector<std::string> channels, int width, int height, float rest) {
    Pixels pixels(size_t(width) * height * 4, rest);
    Imf::MultiPartInputFile file(path.c_str());
    for (int part = 0; part < file.parts(); part++) {
        Imf::InputPart input(file, part);
        Imf::FrameBuffer buffer;
        for (size_t c = 0; c < channels.size(); c++)
            if (input.header().channels().findChannel(channels[c]))
                buffer.insert(channels[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(&pixels[c]), 16, 16 * size_t(width)));
        if (buffer.begin() == buffer.end()) continue;
        input.setFrameBuffer(buffer);
        input.readPixels(0, height - 1);
    }
    return pixels;
}

struct Push {  // common/temporal.glsl
    int32_t width, height, texelX = 0, texelY = 0;
    float jitterX, jitterY, readX = 0, readY = 0, feedbackCeiling = 1;
    uint32_t firstFrame, frameNumber, depthKnown = 0;
    float perDepth[4] = {0, 0, 1, 0}, constant[4] = {};
};

int main(int argc, char** argv) {
    if (argc != 4) return std::puts("host SHADER.spv SHOT RESULT.exr"), 2;
    const std::string folder = argv[2];
    const auto shot = nlohmann::json::parse(std::ifstream(folder + "/shot.json"));
    const int width = shot["resolution"][0], height = shot["resolution"][1];
    std::ifstream file(argv[1], std::ios::binary);
    const std::string code((std::istreambuf_iterator<char>(file)), {});

    // A device with one queue that computes.
    vk::raii::Context context;
    const vk::ApplicationInfo application("example", 1, "example", 1, VK_API_VERSION_1_1);
    vk::raii::Instance instance(context, vk::InstanceCreateInfo({}, &application));
    vk::raii::PhysicalDevice physical = std::move(vk::raii::PhysicalDevices(instance).front());
    uint32_t family = 0;
    while (!(physical.getQueueFamilyProperties()[family].queueFlags & vk::QueueFlagBits::eCompute)) family++;
    const float priority = 1;
    const vk::DeviceQueueCreateInfo queues({}, family, 1, &priority);
    vk::PhysicalDeviceFeatures features;
    features.shaderStorageImageWriteWithoutFormat = true;
    vk::raii::Device device(physical, vk::DeviceCreateInfo({}, queues, {}, {}, &features));
    vk::raii::Queue queue(device, family, 0);
    vk::raii::CommandPool pool(device, {{}, family});
    const auto memoryOf = [&](const vk::MemoryRequirements& needs, vk::MemoryPropertyFlags flags) {
        const auto types = physical.getMemoryProperties();
        for (uint32_t i = 0;; i++)
            if ((needs.memoryTypeBits >> i & 1) && (types.memoryTypes[i].propertyFlags & flags) == flags)
                return vk::raii::DeviceMemory(device, {needs.size, i});
    };
    const auto now = [&](auto record) {  // commands, run at once
        vk::raii::CommandBuffer c = std::move(vk::raii::CommandBuffers(device, {*pool, vk::CommandBufferLevel::ePrimary, 1})[0]);
        c.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
        record(c);
        c.end();
        queue.submit(vk::SubmitInfo({}, {}, *c));
        queue.waitIdle();
    };

    // Images of RGBA 32F in the layout GENERAL: current, motion, depth, two histories, the result, one that is not used.
    enum { current, motion, depth, historyA, historyB, result, unused, imageCount };
    std::vector<vk::raii::Image> images;
    std::vector<vk::raii::DeviceMemory> memories;
    std::vector<vk::raii::ImageView> views;
    const vk::ImageSubresourceRange whole(vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1);
    for (int i = 0; i < imageCount; i++) {
        using Usage = vk::ImageUsageFlagBits;
        const auto format = vk::Format::eR32G32B32A32Sfloat;
        images.emplace_back(device, vk::ImageCreateInfo({}, vk::ImageType::e2D, format, {uint32_t(width), uint32_t(height), 1}, 1, 1,
                                                        vk::SampleCountFlagBits::e1, vk::ImageTiling::eOptimal,
                                                        Usage::eSampled | Usage::eStorage | Usage::eTransferSrc | Usage::eTransferDst));
        memories.push_back(memoryOf(images[i].getMemoryRequirements(), vk::MemoryPropertyFlagBits::eDeviceLocal));
        images[i].bindMemory(*memories[i], 0);
        views.emplace_back(device, vk::ImageViewCreateInfo({}, *images[i], vk::ImageViewType::e2D, format, {}, whole));
        now([&](auto& c) {
            c.pipelineBarrier(vk::PipelineStageFlagBits::eTopOfPipe, vk::PipelineStageFlagBits::eTransfer, {}, {}, {},
                              vk::ImageMemoryBarrier({}, vk::AccessFlagBits::eTransferWrite, vk::ImageLayout::eUndefined,
                                                     vk::ImageLayout::eGeneral, family, family, *images[i], whole));
        });
    }
    const size_t bytes = size_t(width) * height * 16;
    vk::raii::Buffer staging(device, {{}, bytes, vk::BufferUsageFlagBits::eTransferSrc | vk::BufferUsageFlagBits::eTransferDst});
    vk::raii::DeviceMemory stagingMemory =
        memoryOf(staging.getMemoryRequirements(), vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent);
    staging.bindMemory(*stagingMemory, 0);
    float* const mapped = static_cast<float*>(stagingMemory.mapMemory(0, bytes));
    const vk::BufferImageCopy all(0, 0, 0, {vk::ImageAspectFlagBits::eColor, 0, 0, 1}, {}, {uint32_t(width), uint32_t(height), 1});
    const auto upload = [&](int image, const Pixels& pixels) {
        std::copy(pixels.begin(), pixels.end(), mapped);
        now([&](auto& c) { c.copyBufferToImage(*staging, *images[image], vk::ImageLayout::eGeneral, all); });
    };

    // The pipeline: bindings 0 to 3 are textures, 4 to 6 images. Constant 1 (the history's filter) and 0 (dilation) are
    // set as karis has them; all others keep their defaults.
    vk::raii::Sampler sampler(device, vk::SamplerCreateInfo({}, vk::Filter::eNearest, vk::Filter::eNearest));
    std::vector<vk::DescriptorSetLayoutBinding> slots;
    for (uint32_t i = 0; i < 8; i++)
        slots.emplace_back(i, i < 4   ? vk::DescriptorType::eCombinedImageSampler
                              : i < 7 ? vk::DescriptorType::eStorageImage
                                      : vk::DescriptorType::eStorageBuffer, 1, vk::ShaderStageFlagBits::eCompute);
    vk::raii::DescriptorSetLayout setLayout(device, vk::DescriptorSetLayoutCreateInfo({}, slots));
    const vk::PushConstantRange range(vk::ShaderStageFlagBits::eCompute, 0, sizeof(Push));
    vk::raii::PipelineLayout layout(device, vk::PipelineLayoutCreateInfo({}, *setLayout, range));
    vk::raii::ShaderModule module(device, {{}, code.size(), reinterpret_cast<const uint32_t*>(code.data())});
    const int32_t constants[] = {1, 0};  // DILATION closest of the diagonals, HISTORY_FILTER bilinear
    const vk::SpecializationMapEntry entries[] = {{0, 0, 4}, {1, 4, 4}};
    const vk::SpecializationInfo special(2, entries, sizeof(constants), constants);
    vk::raii::Pipeline pipeline(device, nullptr, vk::ComputePipelineCreateInfo({}, {{}, vk::ShaderStageFlagBits::eCompute, *module, "main", &special}, *layout));
    const vk::DescriptorPoolSize sizes[] = {{vk::DescriptorType::eCombinedImageSampler, 8}, {vk::DescriptorType::eStorageImage, 6},
                                             {vk::DescriptorType::eStorageBuffer, 2}};
    vk::raii::DescriptorPool sets(device, vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 2, sizes));

    // Binding 7: the weights of the 3 x 3 samples, which follow the jitter.
    vk::raii::Buffer weights(device, {{}, 9 * sizeof(float), vk::BufferUsageFlagBits::eStorageBuffer});
    vk::raii::DeviceMemory weightsMemory =
        memoryOf(weights.getMemoryRequirements(), vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent);
    weights.bindMemory(*weightsMemory, 0);
    float* const weight = static_cast<float*>(weightsMemory.mapMemory(0, VK_WHOLE_SIZE));

    int previous = historyA, next = historyB, number = 0;
    for (const auto& f : shot["frames"]) {
        const std::string path = folder + "/" + f["file"].get<std::string>();
        upload(current, load(path, {"R", "G", "B"}, width, height, 1));
        upload(motion, load(path, {"motion.X", "motion.Y"}, width, height, 0));
        upload(depth, load(path, {"Z"}, width, height, 0));
        vk::raii::DescriptorSet set = std::move(vk::raii::DescriptorSets(device, {*sets, *setLayout})[0]);
        const int bound[] = {current, motion, depth, previous, next, result, unused};
        for (uint32_t i = 0; i < 7; i++) {
            const vk::DescriptorImageInfo image(*sampler, *views[bound[i]], vk::ImageLayout::eGeneral);
            device.updateDescriptorSets(vk::WriteDescriptorSet(*set, i, 0, slots[i].descriptorType, image), {});
        }
        const vk::DescriptorBufferInfo buffer(*weights, 0, VK_WHOLE_SIZE);
        device.updateDescriptorSets(vk::WriteDescriptorSet(*set, 7, 0, slots[7].descriptorType, {}, buffer), {});
        Push push{.width = width, .height = height, .jitterX = f["jitter"][0], .jitterY = f["jitter"][1],
                  .firstFrame = number == 0, .frameNumber = uint32_t(number)};
        for (int k = 0; k < 9; k++) {
            const double x = k % 3 - 1 + double(push.jitterX), y = k / 3 - 1 + double(push.jitterY);
            weight[k] = float(std::exp(-2.29 * (x * x + y * y)));
        }
        now([&](auto& c) {
            c.bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline);
            c.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout, 0, *set, {});
            c.template pushConstants<Push>(*layout, vk::ShaderStageFlagBits::eCompute, 0, push);
            c.dispatch((width + 7) / 8, (height + 7) / 8, 1);
        });
        std::swap(previous, next), number++;
    }

    now([&](auto& c) { c.copyImageToBuffer(*images[result], vk::ImageLayout::eGeneral, *staging, all); });
    Imf::Header header(width, height);
    Imf::FrameBuffer buffer;
    for (int c = 0; c < 3; c++) {
        const std::string name(1, "RGB"[c]);
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(mapped + c), 16, 16 * size_t(width)));
    }
    Imf::OutputFile out(argv[3], header);
    out.setFrameBuffer(buffer);
    out.writePixels(height);
}
