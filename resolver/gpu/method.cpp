#include "gpu/method.h"

#include <ImathConfig.h>
#include <half.h>

#include <algorithm>

#include "gpu/forms.h"
#include "gpu/stages.h"

namespace aa::gpu {

Session::Session(const Settings& settings)
    : settings_(settings), device_(settings.device, {settings.validate, settings.shaders}), uploads_(device_) {
    for (auto& i : inputs_) i = std::make_unique<Inputs>(*this);
}
Session::~Session() = default;

void Session::share(const Frame& frame, bool changed) {
    const std::lock_guard lock(mutex_);
    uploads_.wait();  // of the frame before
    auto slot = std::find_if(inputs_.begin(), inputs_.end(), [&](const auto& i) { return i->frame() == &frame; });
    const bool known = slot != inputs_.end();
    if (!known) slot = inputs_.end() - 1;
    std::rotate(inputs_.begin(), slot, slot + 1);
    if (known && !changed) return;
    Inputs& inputs = *inputs_.front();
    asked_.insert(inputs.uploaded().begin(), inputs.uploaded().end());  // of a frame that is done
    inputs.begin(frame);
    bool any = false;
    for (const Input input : asked_)
        if (inputs.offers(input)) inputs.get(input, uploads_), any = true;
    if (any) uploads_.submit();
}
void Session::forget() {
    const std::lock_guard lock(mutex_);
    uploads_.wait();
    for (auto& i : inputs_) i->end();
}
Inputs* Session::shared(const Frame& frame) {
    const std::lock_guard lock(mutex_);
    for (auto& i : inputs_)
        if (i->frame() == &frame) return i.get();
    return nullptr;
}

namespace {
template <class T>
void planar(const std::byte* from, size_t channels, std::span<PlaneF* const> planes) {
    const T* in = reinterpret_cast<const T*>(from);
    for (int y = 0; y < planes[0]->height(); y++) {
        const size_t width = size_t(planes[0]->width());
        for (size_t c = 0; c < planes.size(); c++) {
            float* row = planes[c]->row(y);
            for (size_t x = 0; x < width; x++) row[x] = float(in[x * channels + c]);
        }
        in += width * channels;
    }
}
}  // namespace

void GpuMethod::addStage(std::unique_ptr<DeviceStage> stage) {
    keepRejection = keepRejection || stage->needsRejection();
    stages_.push_back(std::move(stage));
}
size_t GpuMethod::stateBytes() const {
    size_t bytes = bytes_;
    for (const auto& stage : stages_) bytes += stage->stateBytes();
    return bytes;
}

const Image& GpuMethod::recordFrame(const Frame& frame) {
    Inputs* inputs = session_.shared(frame);
    if (!inputs) own_.begin(frame), inputs = &own_;
    Current current(*inputs, recorder_);
    fitted(out_, frame.width, frame.height, session_.colour());
    record(current, out_);
    const Image* shown = shownImage() ? shownImage() : &out_;
    for (const auto& stage : stages_) shown = &stage->record(current, *shown, rejectionImage());
    return *shown;
}
const std::vector<PassTime>& GpuMethod::run(const Frame& frame) {
    recordFrame(frame);
    recorder_.run();
    return recorder_.times();
}
void GpuMethod::resolve(const Frame& frame, const Exec&, Rgb& out) {
    const Image& shown = recordFrame(frame);
    if (out.width() != frame.width || out.height() != frame.height) out = Rgb(frame.width, frame.height);
    recorder_.download(shown, [&, format = shown.format()](const std::byte* texels) {
        PlaneF* const planes[] = {&out.c[0], &out.c[1], &out.c[2]};
        format == Format::rgba16f ? planar<half>(texels, 4, planes) : planar<float>(texels, 4, planes);
    });
    if (const Image* rejection = keepRejection ? rejectionImage() : nullptr) {
        if (rejection_.width() != frame.width || rejection_.height() != frame.height)
            rejection_ = PlaneF(frame.width, frame.height);
        recorder_.download(*rejection, [&](const std::byte* texels) {
            PlaneF* const planes[] = {&rejection_};
            planar<float>(texels, 1, planes);
        });
    }
    recorder_.run();
}

std::optional<double> GpuMethod::deviceSeconds() const {
    if (recorder_.times().empty()) return {};
    double sum = 0;
    for (const PassTime& t : recorder_.times()) sum += t.seconds;
    return sum;
}
Image& GpuMethod::fitted(Image& image, int width, int height, Format format, int layers) {
    if (image.width() == width && image.height() == height && image.format() == format &&
        image.isArray() == (layers > 0) && image.layers() == std::max(layers, 1))
        return image;
    if (!image.empty()) bytes_ -= image.bytes();
    image = Image(session_.device(), width, height, format, layers);
    bytes_ += image.bytes();
    return image;
}
Buffer& GpuMethod::fitted(Buffer& buffer, size_t bytes) {
    if (!buffer.empty() && buffer.bytes() >= bytes) return buffer;
    bytes_ -= buffer.bytes();
    buffer = Buffer(session_.device(), bytes);
    bytes_ += buffer.bytes();
    return buffer;
}

bool hasForm(std::string_view id) { return findForm(id) != nullptr; }
std::unique_ptr<Method> create(Session& session, const MethodSpec& spec, const ShotInfo& shot) {
    const Form* form = findForm(spec.method->id);
    if (!form) throw UsageError("--device: '" + std::string(spec.method->id) + "' has no shader; use --device cpu");
    spec.create(shot);  // its errors about the shot, the parameters and the stages
    std::unique_ptr<GpuMethod> method = form->create(session, spec.params(), shot);
    for (const StageSpec& stage : spec.stages) method->addStage(makeStage(session, stage, spec, shot));
    return method;
}

}  // namespace aa::gpu
