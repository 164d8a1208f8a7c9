#include "gpu/forms/temporal/temporal_form.h"

#include <algorithm>

#include "methods/temporal/temporal.h"

namespace aa::gpu {

TemporalForm::TemporalForm(Session& session, const Params& params, std::string_view id, Space space)
    : GpuMethod(session, params), id_(id), space_(space) {
    if (!has("historyBits")) return;
    const HistoryStorage storage = temporal::historyStorage(params);
    wide_ = !session.fast() || storage.format == HistoryFormat::byte;
    if (storage.format == HistoryFormat::byte || (storage.format == HistoryFormat::half && wide_))
        narrow_ =
            Shader("temporal/narrow_history", {{10, storage.format == HistoryFormat::byte}, {11, storage.dither}});
}

std::vector<Constant> TemporalForm::constants(std::vector<Constant> own) const {
    const Params& p = params();
    std::vector<Constant> all = {{3, session().fast()}, {4, keepRejection}, {5, storesResult()}};
    if (has("dilation")) all.push_back({0, temporal::dilation(p)});
    if (has("history")) all.push_back({1, temporal::historyFilter(p)});
    if (has("outside")) all.push_back({2, p.choice("outside") == "clamp"});
    all.insert(all.end(), own.begin(), own.end());
    return all;
}

std::vector<Binding> TemporalForm::bindings(Current& current, Image& out) {
    const Image& colour = current[space_ == Space::encoded ? Input::encoded : Input::colour];
    const Image& depth = current.frame().depthView.empty() ? colour : current[Input::depth];
    const bool linear = session().fast();
    return {read(colour),
            read(current[Input::motion]),
            read(depth),
            linear ? filtered(blend_.previous()) : read(blend_.previous()),
            written(blend_.next()),
            written(storesResult() ? out : unused_),
            written(rejection_)};
}

TemporalPush TemporalForm::begin(const Frame& frame) {
    history_.begin(frame, id_);
    TemporalPush push{};
    push.width = frame.width, push.height = frame.height;
    push.jitterX = float(frame.jitterPx.x), push.jitterY = float(frame.jitterPx.y);
    push.feedbackCeiling = has("warmup") ? temporal::feedbackCeiling(params(), history_.framesSinceReset()) : 1.0f;
    push.firstFrame = history_.fresh();
    push.frameNumber = uint32_t(frame.number);
    ExpectedDepth e = expectedDepth(frame);
    if (has("unjitter") && params().flag("unjitter")) {
        const glm::ivec2 texel = temporal::unjitteredTexel(frame);
        push.texelX = texel.x, push.texelY = texel.y;
        e = readBeside(e, texel);
        push.readX = -push.jitterX, push.readY = -push.jitterY;
        push.jitterX = push.jitterY = 0;
    }
    push.depthKnown = e.known;
    std::copy_n(e.perDepth, 3, push.perDepth);
    std::copy_n(e.constant, 3, push.constant);
    return push;
}

void TemporalForm::record(Current& current, Image& out) {
    const Frame& frame = current.frame();
    const TemporalPush push = begin(frame);
    for (Image& image : blend_.images)
        fitted(image, frame.width, frame.height, wide_ ? Format::rgba32f : session().colour());
    if (!storesResult()) fitted(unused_, 1, 1, session().colour());
    fitted(rejection_, keepRejection ? frame.width : 1, keepRejection ? frame.height : 1, Session::value);
    if (!history_.fresh() && !narrow_.name().empty()) {
        struct {
            int32_t width, height;
            uint32_t frame;
        } narrowed{frame.width, frame.height, lastNumber_};
        const Binding images[] = {written(blend_.previous())};
        current.recorder().dispatch(narrow_, frame.width, frame.height, images, narrowed);
    }
    lastNumber_ = uint32_t(frame.number);
    recordTemporal(current, push, out);
    history_.end();
    blend_.swap();
}

}  // namespace aa::gpu
