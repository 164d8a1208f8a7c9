#include <ImathConfig.h>
#include <half.h>

#include <algorithm>
#include <cstring>

#include "gpu/method.h"

namespace aa::gpu {
namespace {

// A value as its image holds it. binary16 has no room above 65504, and Inf would be no colour.
template <class T>
T stored(float v) {
    if constexpr (std::is_same_v<T, half>)
        return half(std::clamp(v, -65504.0f, 65504.0f));
    else
        return v;
}
// Planes of one size, interleaved as `channels` values per texel; what has no plane is `rest`.
template <class T>
void interleave(const std::vector<const PlaneF*>& planes, size_t channels, float rest, std::byte* to) {
    T* out = reinterpret_cast<T*>(to);
    const int width = planes[0]->width(), height = planes[0]->height();
    for (int y = 0; y < height; y++) {
        for (size_t c = 0; c < channels; c++) {
            if (c >= planes.size()) {
                for (int x = 0; x < width; x++) out[size_t(x) * channels + c] = stored<T>(rest);
                continue;
            }
            const float* row = planes[c]->row(y);
            for (int x = 0; x < width; x++) out[size_t(x) * channels + c] = stored<T>(row[x]);
        }
        out += size_t(width) * channels;
    }
}
size_t channelsOf(Format f) {
    return f == Format::rgba32f || f == Format::rgba16f ? 4 : f == Format::rg32f || f == Format::rg16f ? 2 : 1;
}
void fill(const std::vector<const PlaneF*>& planes, Format format, std::byte* to) {
    const bool narrow = format == Format::rgba16f || format == Format::rg16f;
    if (narrow)
        interleave<half>(planes, channelsOf(format), 1, to);
    else
        interleave<float>(planes, channelsOf(format), 1, to);
}
void fill(const PlaneU& plane, std::byte* to) {
    for (int y = 0; y < plane.height(); y++) {
        std::memcpy(to, plane.row(y), size_t(plane.width()) * 4);
        to += size_t(plane.width()) * 4;
    }
}
std::vector<const PlaneF*> planesOf(const Rgb& colour) { return {&colour.c[0], &colour.c[1], &colour.c[2]}; }

// One layer of an input: planes of floats, or one of ids.
struct Layer {
    std::vector<const PlaneF*> planes;
    const PlaneU* ids = nullptr;
    bool empty() const { return ids ? ids->empty() : planes[0]->empty(); }
};
bool isArray(Input which) { return which >= Input::subColour; }
// What lies behind an input. That of subEncoded is yet to be encoded.
std::vector<Layer> layersOf(const Frame& f, Input which) {
    const auto ofSamples = [&](const auto& layerOf) {
        std::vector<Layer> layers;
        for (const SubSample& s : f.subSamples) layers.push_back(layerOf(s));
        return layers;
    };
    switch (which) {
        case Input::colour:
            return {{planesOf(f.colorLinear)}};
        case Input::encoded:
            return {{planesOf(f.colorEncoded)}};
        case Input::albedoEncoded:
            return {{planesOf(f.albedoEncoded)}};
        case Input::depth:
            return {{{&f.depthView}}};
        case Input::normal:
            return {{planesOf(f.normalWorld)}};
        case Input::motion:
            return {{{&f.motionXPx, &f.motionYPx}}};
        case Input::edges:
            return {{{&f.edgeXPx, &f.edgeYPx}}};
        case Input::objectId:
            return {{{}, &f.objectId}};
        case Input::mask:
            return {{{}, &f.subSampleMask}};
        case Input::subColour:
        case Input::subEncoded:
            return ofSamples([](const SubSample& s) { return Layer{planesOf(s.colorLinear)}; });
        case Input::subNormal:
            return ofSamples([](const SubSample& s) { return Layer{planesOf(s.normalWorld)}; });
        case Input::subDepth:
            return ofSamples([](const SubSample& s) { return Layer{{&s.depthView}}; });
        case Input::subId:
            return ofSamples([](const SubSample& s) { return Layer{{}, &s.objectId}; });
    }
    return {};
}
Format formatOf(Input which, const Session& session) {
    switch (which) {
        case Input::depth:
        case Input::subDepth:
            return Format::r32f;
        case Input::objectId:
        case Input::mask:
        case Input::subId:
            return Format::r32ui;
        case Input::motion:
            return session.fast() ? Format::rg16f : Format::rg32f;
        case Input::edges:
            return Format::rg32f;
        case Input::normal:
        case Input::subNormal:
            return Format::rgba32f;
        default:
            return session.colour();
    }
}
}  // namespace

bool Inputs::offers(Input which) const {
    const std::vector<Layer> layers = layersOf(*frame_, which);
    return !layers.empty() && !layers[0].empty();
}

const Image& Inputs::get(Input which, Recorder& recorder) {
    Image& image = images_[which];
    if (current_.contains(which)) return image;
    const Frame& f = *frame_;
    if (!offers(which)) throw std::logic_error("gpu::Inputs: the frame lacks input " + std::to_string(int(which)));
    std::vector<Layer> layers = layersOf(f, which);
    std::vector<Rgb> encoded(which == Input::subEncoded ? layers.size() : 0);
    for (size_t i = 0; i < encoded.size(); i++) {
        encode(f.subSamples[i].colorLinear, f.display, {}, encoded[i]);
        layers[i].planes = planesOf(encoded[i]);
    }
    const Format format = formatOf(which, session_);
    if (image.width() != f.width || image.height() != f.height || image.layers() != int(layers.size()) ||
        image.format() != format)
        image = Image(session_.device(), f.width, f.height, format, isArray(which) ? int(layers.size()) : 0);
    const size_t bytes = image.bytes() / layers.size();
    recorder.upload(image, [&](std::byte* to) {
        for (const Layer& layer : layers) {
            layer.ids ? fill(*layer.ids, to) : fill(layer.planes, format, to);
            to += bytes;
        }
    });
    current_.insert(which);
    return image;
}

}  // namespace aa::gpu
