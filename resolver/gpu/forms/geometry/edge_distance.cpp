#include "gpu/forms.h"
#include "gpu/forms/geometry/geometry_form.h"

namespace aa::gpu {
namespace {

class EdgeBlendForm : public GpuMethod {
  public:
    EdgeBlendForm(Session& session, const Params& p, bool perAxis)
        : GpuMethod(session, p),
          shader_("geometry/gbaa", {{10, perAxis}, {11, perAxis || p.flag("searchNeighbours")}}) {}

  private:
    void record(Current& current, Image& out) override {
        const struct { int32_t width, height; } push{current.width(), current.height()};
        const Binding images[] = {read(current[Input::colour]), read(current[Input::edges]), written(out)};
        current.recorder().dispatch(shader_, push.width, push.height, images, push);
    }
    Shader shader_;
};

class GpaaForm : public GpuMethod {
  public:
    GpaaForm(Session& session, const Params& p)
        : GpuMethod(session, p),
          depthTest_(p.choice("depthTest") != "off"),
          keepNearest_(p.choice("keep") == "nearest"),
          blend_("geometry/gpaa", {{12, keepNearest_}}) {
        const int depthTest = !depthTest_ ? 0 : p.choice("depthTest") == "pixel" ? 1 : 2;
        const auto draw = [&](bool markNearest) {
            return Shader(
                "geometry/gpaa_draw",
                {{10, depthTest}, {11, float(1 + p.real("depthBias"))}, {12, keepNearest_}, {13, markNearest}});
        };
        draw_ = draw(false), markNearest_ = draw(true);
    }

  private:
    struct DrawPush {
        int32_t width, height;
        float jitterX, jitterY;
        uint32_t count, segmentsPerRow, perspective;
    };
    struct BlendPush {
        int32_t width, height;
        float jitterX, jitterY;
    };
    void record(Current& current, Image& out) override {
        const Frame& frame = current.frame();
        Recorder& recorder = current.recorder();
        fitted(winner_, frame.width, frame.height, Format::r32ui);
        fitted(nearest_, keepNearest_ ? frame.width : 1, keepNearest_ ? frame.height : 1, Format::r32ui);
        recorder.upload(fitted(segments_, frame.segments.size() * sizeof(EdgeSegment)), bytesOf(frame.segments));
        recorder.clear(winner_);
        if (keepNearest_) recorder.clear(nearest_);

        // Eight invocations to a segment; more rows of them where one cannot hold all.
        const int count = int(frame.segments.size()), perRow = std::min((count + 7) / 8 * 8, kMostPerRow);
        const float jitterX = float(frame.jitterPx.x), jitterY = float(frame.jitterPx.y);
        const bool perspective = !frame.camera || frame.camera->kind != "orthographic";
        const DrawPush push{frame.width,     frame.height,     jitterX,    jitterY,
                            uint32_t(count), uint32_t(perRow), perspective};
        const Binding drawn[] = {read(depthTest_ ? current[Input::depth] : current[Input::colour]), memory(segments_),
                                 written(winner_), written(nearest_)};
        const auto draw = [&](Shader& shader) {
            if (count > 0) recorder.dispatch(shader, perRow, 8 * ((count + perRow - 1) / perRow), drawn, push);
        };
        if (keepNearest_) draw(markNearest_);
        draw(draw_);

        const Binding blended[] = {read(current[Input::colour]), memory(segments_), read(winner_), written(out)};
        recorder.dispatch(blend_, frame.width, frame.height, blended,
                          BlendPush{frame.width, frame.height, jitterX, jitterY});
    }
    static constexpr int kMostPerRow = 8 * 4096;

    bool depthTest_, keepNearest_;
    Shader draw_, markNearest_, blend_;
    Buffer segments_;
    Image winner_, nearest_;
};

std::unique_ptr<GpuMethod> gbaa(Session& s, const Params& p, const ShotInfo&) {
    return std::make_unique<EdgeBlendForm>(s, p, false);
}
std::unique_ptr<GpuMethod> d2e(Session& s, const Params& p, const ShotInfo&) {
    return std::make_unique<EdgeBlendForm>(s, p, true);
}
std::unique_ptr<GpuMethod> gpaa(Session& s, const Params& p, const ShotInfo&) {
    return std::make_unique<GpaaForm>(s, p);
}
}  // namespace

std::vector<Form> edgeDistanceForms() { return {{"gbaa", gbaa}, {"d2e", d2e}, {"gpaa", gpaa}}; }

}  // namespace aa::gpu
