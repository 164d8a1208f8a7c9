#include "methods/reference/accum.h"

#include "image/error.h"

namespace aa {
namespace {

class Accum : public Method {
  public:
    Accum(int samples, bool encoded) : samples_(samples), encoded_(encoded) {}

    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        if (frame.reset || sum_[0].width() != frame.width || sum_[0].height() != frame.height) {
            for (auto& plane : sum_) plane = Plane<double>(frame.width, frame.height);
            count_ = 0;
        }
        const bool adds = count_ < samples_;
        if (adds) count_++;
        const double n = count_;
        forRows(exec, frame.height, [&](int y0, int y1) {
            for (size_t c = 0; c < 3; c++)
                for (int y = y0; y < y1; y++) {
                    double* sum = sum_[c].row(y);
                    const float* color = (encoded_ ? frame.colorEncoded : frame.colorLinear).c[c].row(y);
                    float* o = out.c[c].row(y);
                    for (int x = 0; x < frame.width; x++) {
                        if (adds) sum[x] += double(color[x]);
                        o[x] = float(sum[x] / n);
                    }
                }
        });
    }
    size_t stateBytes() const override { return 3 * sum_[0].bytes(); }

  private:
    int samples_, count_ = 0;
    bool encoded_;
    std::array<Plane<double>, 3> sum_;
};

}  // namespace

MethodDescriptor accumDescriptor() {
    return {.id = "accum",
            .title = "Accumulation buffer",
            .family = "reference",
            .summary = "Mean of the jittered frames of a static scene.",
            .source = "[Haeberli 1990]",
            .passes = Pass::color,
            .temporal = true,
            .fixedSet = true,
            .params = {intParam("samples", "128", 1, 100000, "frames averaged; later frames leave the mean as it is",
                                "[Oliveros 2018, 4.1.3]"),
                       averagedSpaceParam()},
            .create = [](const Params& p, const ShotInfo& shot) -> std::unique_ptr<Method> {
                if (!shot.isStatic)
                    throw InputError(
                        "accum: averages the frames of a static shot, and this shot moves; use accumReject, or "
                        "ssaa on sub-sample colours");
                return std::make_unique<Accum>(p.integer("samples"), p.choice("space") == "encoded");
            },
            .outputSpace = averagedSpace};
}
}  // namespace aa
