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

// The planes behind an input that is a picture of floats, layer by layer; empty for ids.
std::vector<std::vector<const PlaneF*>> planesOf(const Frame& f, Input which, std::vector<Rgb>& converted) {
    std::vector<std::vector<const PlaneF*>> layers;
    switch (which) {
        case Input::colour:
            return {planesOf(f.colorLinear)};
        case Input::encoded:
            return {planesOf(f.colorEncoded)};
        case Input::albedo:
            return {planesOf(f.albedoLinear)};
        case Input::albedoEncoded:
            return {planesOf(f.albedoEncoded)};
        case Input::depth:
            return {{&f.depthView}};
        case Input::normal:
            return {planesOf(f.normalWorld)};
        case Input::motion:
            return {{&f.motionXPx, &f.motionYPx}};
        case Input::edges:
            return {{&f.edgeXPx, &f.edgeYPx}};
        case Input::subColour:
            for (const SubSample& s : f.subSamples) layers.push_back(planesOf(s.colorLinear));
            return layers;
        case Input::subEncoded:
            converted.resize(f.subSamples.size());
            for (size_t i = 0; i < converted.size(); i++) {
                encode(f.subSamples[i].colorLinear, f.display, {}, converted[i]);
                layers.push_back(planesOf(converted[i]));
            }
            return layers;
        case Input::subNormal:
            for (const SubSample& s : f.subSamples) layers.push_back(planesOf(s.normalWorld));
            return layers;
        case Input::subDepth:
            for (const SubSample& s : f.subSamples) layers.push_back({&s.depthView});
            return layers;
        case Input::objectId:
        case Input::mask:
        case Input::subId:
            return {};
    }
    return {};
}
std::vector<const PlaneU*> idsOf(const Frame& f, Input which) {
    if (which == Input::objectId) return {&f.objectId};
    if (which == Input::mask) return {&f.subSampleMask};
    std::vector<const PlaneU*> layers;
    for (const SubSample& s : f.subSamples) layers.push_back(&s.objectId);
    return layers;
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
    const Frame& f = *frame_;
    const auto all = [&](auto member) { return !f.subSamples.empty() && !(f.subSamples[0].*member).empty(); };
    switch (which) {
        case Input::colour:
            return !f.colorLinear.empty();
        case Input::encoded:
            return !f.colorEncoded.empty();
        case Input::albedo:
            return !f.albedoLinear.empty();
        case Input::albedoEncoded:
            return !f.albedoEncoded.empty();
        case Input::depth:
            return !f.depthView.empty();
        case Input::normal:
            return !f.normalWorld.empty();
        case Input::objectId:
            return !f.objectId.empty();
        case Input::mask:
            return !f.subSampleMask.empty();
        case Input::motion:
            return !f.motionXPx.empty();
        case Input::edges:
            return !f.edgeXPx.empty();
        case Input::subColour:
        case Input::subEncoded:
            return all(&SubSample::colorLinear);
        case Input::subNormal:
            return all(&SubSample::normalWorld);
        case Input::subDepth:
            return all(&SubSample::depthView);
        case Input::subId:
            return all(&SubSample::objectId);
    }
    return false;
}

const Image& Inputs::get(Input which, Recorder& recorder) {
    Image& image = images_[which];
    if (!current_.insert(which).second) return image;
    const Frame& f = *frame_;
    if (!offers(which)) throw std::logic_error("gpu::Inputs: the frame lacks input " + std::to_string(int(which)));
    std::vector<Rgb> converted;
    const auto planes = planesOf(f, which, converted);
    const auto ids = planes.empty() ? idsOf(f, which) : std::vector<const PlaneU*>{};
    const bool array = which == Input::subColour || which == Input::subEncoded || which == Input::subNormal ||
                       which == Input::subDepth || which == Input::subId;
    const size_t layers = planes.empty() ? ids.size() : planes.size();
    const Format format = formatOf(which, session_);
    if (image.width() != f.width || image.height() != f.height || image.layers() != int(layers) ||
        image.format() != format)
        image = Image(session_.device(), f.width, f.height, format, array ? int(layers) : 0);
    const size_t bytes = image.bytes() / layers;
    recorder.upload(image, [&](std::byte* to) {
        for (size_t i = 0; i < layers; i++, to += bytes)
            planes.empty() ? fill(*ids[i], to) : fill(planes[i], format, to);
    });
    return image;
}

}  // namespace aa::gpu
