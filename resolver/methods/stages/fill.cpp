#include "methods/stages/fill.h"

#include "image/error.h"

namespace aa {
namespace {

class FillStage : public Stage {
  public:
    FillStage(const MethodSpec& filler, const ShotInfo& shot)
        : method_(filler.create(shot)), space_(filler.outputSpace()) {}
    bool needsRejection() const override { return true; }

    void apply(const Frame& frame, const Method& method, Space space, const Exec& exec, Rgb& image) override {
        const PlaneF* rejection = method.rejection();
        if (!rejection || !any(*rejection)) return;
        if (fill_.width() != frame.width || fill_.height() != frame.height) fill_ = Rgb(frame.width, frame.height);
        method_->resolve(frame, exec, fill_);
        if (space_ != space) {
            fill_.fillBorder();
            if (space == Space::encoded)
                encode(fill_, frame.display, exec, converted_);
            else
                decode(fill_, frame.display, exec, converted_);
            std::swap(fill_, converted_);
        }
        forRows(exec, frame.height, [&](int y0, int y1) {
            for (size_t c = 0; c < 3; c++)
                for (int y = y0; y < y1; y++) {
                    const float *reason = rejection->row(y), *from = fill_.c[c].row(y);
                    float* to = image.c[c].row(y);
                    for (int x = 0; x < frame.width; x++)
                        if (reason[x] != 0) to[x] = from[x];
                }
        });
    }
    size_t stateBytes() const override { return method_->stateBytes() + fill_.bytes() + converted_.bytes(); }

  private:
    static bool any(const PlaneF& rejection) {
        for (int y = 0; y < rejection.height(); y++) {
            const float* row = rejection.row(y);
            if (std::any_of(row, row + rejection.width(), [](float reason) { return reason != 0; })) return true;
        }
        return false;
    }
    std::unique_ptr<Method> method_;
    Space space_;
    Rgb fill_, converted_;
};
}  // namespace

StageDescriptor fillStage() {
    return {
        .value = choiceParam("fill", "", {},
                             "a spatial or geometry-aware method that fills the pixels whose history was rejected",
                             "[Stejmar n.d., 6.3.1]"),
        .valueIsMethod = true,
        .create = [](const std::string& value, const MethodSpec& spec, const ShotInfo& shot) -> std::unique_ptr<Stage> {
            const MethodSpec filler = parseMethod(value);
            if (spec.method->family != "temporal")
                throw UsageError("stage 'fill': '" + std::string(spec.method->id) +
                                 "' keeps no history that could be rejected; use it after a temporal method");
            if (filler.method->temporal)
                throw UsageError("stage 'fill': expected a spatial or geometry-aware method, found '" + value +
                                 "', which is temporal");
            return std::make_unique<FillStage>(filler, shot);
        }};
}
}  // namespace aa
