#include "gpu/metrics.h"

#include <cassert>
#include <cstring>

namespace aa::gpu {
namespace {

// SIGNAL of ssim.comp.
enum class SsimShaderSignal { luma, channels, volume };
struct SsimFigure {
    std::string_view name;
    SsimShaderSignal signal;
};
constexpr SsimFigure kSsimFigures[] = {{"ssimLuma", SsimShaderSignal::luma},
                                       {"ssimRgb", SsimShaderSignal::channels},
                                       {"ssimMatlab3D", SsimShaderSignal::volume}};
constexpr std::string_view kFlip = "flip";
const SsimFigure* ssimFigure(std::string_view name) {
    for (const SsimFigure& f : kSsimFigures)
        if (f.name == name) return &f;
    return nullptr;
}

// Workgroups, as the heads of the shaders say.
constexpr int kSquareGroup = 16, kFlipGroupLong = 32, kFlipGroupShort = 8;

void fillTexels(const Rgb& picture, std::byte* to) {
    float* out = reinterpret_cast<float*>(to);
    for (int y = 0; y < picture.height(); y++)
        for (int x = 0; x < picture.width(); x++, out += 4) {
            for (size_t c = 0; c < 3; c++) out[c] = picture.c[c].at(x, y);
            out[3] = 1;
        }
}
PlaneF planeOf(const std::byte* texels, int width, int height) {
    PlaneF plane(width, height);
    for (int y = 0; y < height; y++, texels += 4 * size_t(width)) std::memcpy(plane.row(y), texels, 4 * size_t(width));
    plane.fillBorder();
    return plane;
}
// Every `step`-th float from the first one.
double sumOf(const std::byte* floats, size_t bytes, size_t first, size_t step) {
    double sum = 0;
    for (size_t i = first; i < bytes / sizeof(float); i += step) {
        float value;
        std::memcpy(&value, floats + i * sizeof(float), sizeof value);
        sum += double(value);
    }
    return sum;
}
}  // namespace

bool Metrics::measures(std::string_view figure) { return figure == kFlip || ssimFigure(figure); }

Metrics::Metrics(Session& session, int width, int height)
    : session_(session),
      width_(width),
      height_(height),
      recorder_(session.device()),
      test_(session.device(), width, height, Format::rgba32f),
      reference_(session.device(), width, height, Format::rgba32f),
      squaredError_(makePass("metrics/mse", {}, kSquareGroup, kSquareGroup, 2, false)) {}

Metrics::Pass Metrics::makePass(std::string_view shader, std::vector<Constant> constants, int groupWidth,
                                int groupHeight, int sumsPerGroup, bool hasMap) {
    const size_t groups = size_t(groupsAcross(groupWidth)) * size_t(groupsDown(groupHeight));
    return {Shader(shader, std::move(constants)), groupWidth, groupHeight,
            hasMap ? Image(session_.device(), width_, height_, Format::r32f) : Image(),
            Buffer(session_.device(), groups * size_t(sumsPerGroup) * sizeof(float))};
}
Metrics::Pass& Metrics::passOf(std::string_view figure) {
    if (const auto found = others_.find(figure); found != others_.end()) return found->second;
    const SsimFigure* ssim = ssimFigure(figure);
    assert(measures(figure));
    return others_
        .emplace(figure, ssim ? makePass("metrics/ssim", {{10, ssim->signal}}, kSquareGroup, kSquareGroup, 1, true)
                              : makePass("metrics/flip_along_y", {}, kFlipGroupShort, kFlipGroupLong, 1, true))
        .first->second;
}
// Recorder::dispatch() counts workgroups of 8 x 8.
void Metrics::dispatch(Shader& shader, int groupWidth, int groupHeight, std::span<const Binding> bindings) {
    const struct { int32_t width, height; } size{width_, height_};
    recorder_.dispatch(shader, 8 * groupsAcross(groupWidth), 8 * groupsDown(groupHeight), bindings, size);
}
const Metrics::AlongX& Metrics::filteredAlongX(const Image& picture, AlongX& to) {
    if (flipAlongX_.name().empty()) flipAlongX_ = Shader("metrics/flip_along_x");
    for (Image* image : {&to.contrast, &to.features})
        if (image->empty()) *image = Image(session_.device(), width_, height_, Format::rgba32f);
    const Binding images[] = {read(picture), written(to.contrast), written(to.features)};
    dispatch(flipAlongX_, kFlipGroupLong, kFlipGroupShort, images);
    return to;
}

Metrics::Result Metrics::measure(const Rgb& test, const Rgb& reference, const std::set<std::string_view>& figures,
                                 bool keepMaps) {
    assert(test.width() == width_ && test.height() == height_);
    assert(reference.width() == width_ && reference.height() == height_);
    recorder_.upload(test_, [&](std::byte* to) { fillTexels(test, to); });
    recorder_.upload(reference_, [&](std::byte* to) { fillTexels(reference, to); });
    Result result;
    const double pixels = double(width_) * height_;
    const Binding squares[] = {read(test_), read(reference_), memory(squaredError_.sums)};
    dispatch(squaredError_.shader, squaredError_.groupWidth, squaredError_.groupHeight, squares);
    recorder_.download(squaredError_.sums, [&](const std::byte* sums) {
        const size_t bytes = squaredError_.sums.bytes();
        result.squares = {sumOf(sums, bytes, 0, 2) / (3 * pixels), sumOf(sums, bytes, 1, 2) / (3 * pixels)};
    });

    for (const std::string_view name : figures) {
        Pass& pass = passOf(name);
        Figure& figure = result.others[std::string(name)];
        if (name == kFlip) {
            const AlongX &t = filteredAlongX(test_, testAlongX_), &r = filteredAlongX(reference_, referenceAlongX_);
            const Binding bindings[] = {read(t.contrast), read(t.features),  read(r.contrast),
                                        read(r.features), written(pass.map), memory(pass.sums)};
            dispatch(pass.shader, pass.groupWidth, pass.groupHeight, bindings);
        } else {
            const Binding bindings[] = {read(test_), read(reference_), written(pass.map), memory(pass.sums)};
            dispatch(pass.shader, pass.groupWidth, pass.groupHeight, bindings);
        }
        recorder_.download(pass.sums, [&figure, &pass, pixels](const std::byte* sums) {
            figure.mean = sumOf(sums, pass.sums.bytes(), 0, 1) / pixels;
        });
        if (keepMaps)
            recorder_.download(
                pass.map, [&figure, this](const std::byte* texels) { figure.map = planeOf(texels, width_, height_); });
    }
    recorder_.run();
    if (!recorder_.times().empty()) {
        result.deviceSeconds = 0;
        for (const PassTime& t : recorder_.times()) *result.deviceSeconds += t.seconds;
    }
    return result;
}

}  // namespace aa::gpu
