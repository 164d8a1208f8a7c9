#include "gpu/forms/geometry/geometry_form.h"

namespace aa::gpu {

GeometryPush GeometryForm::push(const Frame& frame) const {
    const DisplayArgs display = displayArgs(frame.display);
    GeometryPush push{};
    push.width = frame.width, push.height = frame.height;
    push.toneMap = display.toneMap, push.srgb = display.srgb, push.displayScale = display.scale;
    if (!needs_.camera) return push;
    const GeometryViews views(frame, {.depth = false, .camera = true}, reader_);
    const GeometryArgs& g = views.args();
    for (int i = 0; i < 3; i++) {
        push.ray[i] = g.ray[i], push.rayX[i] = g.rayX[i], push.rayY[i] = g.rayY[i];
        push.originX[i] = g.originX[i], push.originY[i] = g.originY[i];
    }
    return push;
}

Image& GeometryForm::unread(Format format, int layers) {
    return fitted(unread_[format == Format::r32ui][layers], 1, 1, format, layers);
}

std::vector<Binding> GeometryForm::bindings(Current& current, Image& out, std::initializer_list<Binding> own) {
    const auto image = [&](bool reads, Input which, Format format, int layers) {
        return read(reads ? current[which] : unread(format, layers));
    };
    std::vector<float> offsetsPx;
    for (const glm::dvec2& p : current.frame().subSamplePositionsPx)
        offsetsPx.insert(offsetsPx.end(), {float(p.x), float(p.y)});
    current.recorder().upload(fitted(offsets_, bytesOf(offsetsPx).size()), bytesOf(offsetsPx));
    std::vector<Binding> all = {read(current[Input::colour]),
                                written(out),
                                image(needs_.depth, Input::depth, Format::r32f, 0),
                                image(needs_.normals, Input::normal, Format::r32f, 0),
                                image(needs_.ids, Input::objectId, Format::r32ui, 0),
                                image(needs_.depth, Input::subDepth, Format::r32f, 1),
                                image(needs_.normals, Input::subNormal, Format::r32f, 1),
                                image(needs_.ids, Input::subId, Format::r32ui, 1),
                                image(needs_.colors, Input::subColour, Format::r32f, 1),
                                memory(offsets_)};
    all.insert(all.end(), own.begin(), own.end());
    return all;
}

std::vector<Constant> GeometryForm::constants(const ShotInfo& shot, std::vector<Constant> own) {
    own.emplace_back(0u, int(shot.subSamplePositionsPx.size()));
    return own;
}

}  // namespace aa::gpu
