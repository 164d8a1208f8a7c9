#include "methods/spatial/deaa.h"

#include "gpu/forms.h"
#include "gpu/forms/spatial/spatial_form.h"

namespace aa::gpu {
namespace {

class DeaaForm : public GpuMethod {
  public:
    DeaaForm(Session& session, const Params& p, const ShotInfo& shot) : GpuMethod(session, p) {
        std::vector<double> xPx, yPx;
        for (const auto& o : shot.subSamplePositionsPx) {
            xPx.push_back(o.x), yPx.push_back(o.y);
            offsetsPx_.push_back(float(o.x)), offsetsPx_.push_back(float(o.y));
        }
        DeaaArgs args{};
        args.xPx = xPx.data(), args.yPx = yPx.data(), args.sampleCount = int(xPx.size());
        setNormalMatrix(args);
        fits_ = args.invXX != 0 || args.invYY != 0;
        mark_ = Shader("spatial/deaa_mark", {{10, args.sampleCount}, {11, p.realf("sameColour")}});
        filter_ = Shader("spatial/deaa", {{10, args.sampleCount},
                                          {11, p.realf("fitTolerance")},
                                          {12, p.realf("maxLength")},
                                          {13, float(args.invXX)},
                                          {14, float(args.invXY)},
                                          {15, float(args.invYY)}});
    }

  private:
    void record(Current& current, Image& out) override {
        const SpatialPush push(current);
        const Image& samples = current[Input::subColour];
        Image& edge = fitted(edgeImage_, push.width, push.height, Format::r32ui);
        const Binding marked[] = {read(samples), written(out), written(edge)};
        current.recorder().dispatch(mark_, push.width, push.height, marked, push);
        if (!fits_) return;  // all samples on a line
        if (offsets_.empty())
            current.recorder().upload(fitted(offsets_, offsetsPx_.size() * sizeof(float)),
                                      std::as_bytes(std::span(offsetsPx_)));
        const Binding images[] = {read(samples), written(out), read(edge), memory(offsets_)};
        current.recorder().dispatch(filter_, push.width, push.height, images, push);
    }
    std::vector<float> offsetsPx_;  // x, y of each sample
    bool fits_;
    Shader mark_, filter_;
    Image edgeImage_;
    Buffer offsets_;
};
std::unique_ptr<GpuMethod> deaa(Session& session, const Params& p, const ShotInfo& shot) {
    return std::make_unique<DeaaForm>(session, p, shot);
}
}  // namespace

std::vector<Form> deaaForms() { return {{"deaa", deaa}}; }

}  // namespace aa::gpu
