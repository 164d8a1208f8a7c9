#include "methods/stages/motion_blur.h"

#include <cmath>

namespace aa {
namespace {

constexpr int kMaxSamples = 32;  // [Chapman 2012]

class MotionBlurStage : public Stage {
  public:
    explicit MotionBlurStage(float scale) : scale_(scale) {}

    void apply(const Frame& frame, const Method&, Space, const Exec& exec, Rgb& image) override {
        if (blurred_.width() != frame.width || blurred_.height() != frame.height)
            blurred_ = Rgb(frame.width, frame.height);
        forRows(exec, frame.height, [&](int y0, int y1) {
            for (int y = y0; y < y1; y++)
                for (int x = 0; x < frame.width; x++) blurPixel(frame, image, x, y);
        });
        std::swap(image, blurred_);
    }
    size_t stateBytes() const override { return blurred_.bytes(); }

  private:
    void blurPixel(const Frame& frame, const Rgb& image, int x, int y) {
        const float longest = 0.5f * float(std::max(frame.width, frame.height));
        const float motionX = frame.motionXPx.at(x, y), motionY = frame.motionYPx.at(x, y);
        // Not (> 2 pictures): neither is NaN a motion (conventions 9).
        const bool known =
            std::fabs(motionX) <= float(2 * frame.width) && std::fabs(motionY) <= float(2 * frame.height);
        float vx = motionX * scale_, vy = motionY * scale_;
        const float length = std::sqrt(vx * vx + vy * vy);
        if (length > longest) vx *= longest / length, vy *= longest / length;
        const int n = known && length >= 2 ? std::clamp(int(std::min(length, longest)), 1, kMaxSamples) : 1;
        float sum[3];
        for (size_t c = 0; c < 3; c++) sum[c] = image.c[c].at(x, y);
        for (int i = 1; i < n; i++) {
            const float t = float(i) / float(n - 1) - 0.5f;
            const float u = std::clamp(float(x) + vx * t, 0.0f, float(frame.width - 1)),
                        v = std::clamp(float(y) + vy * t, 0.0f, float(frame.height - 1));
            const int ix = int(u), iy = int(v);
            const float fx = u - float(ix), fy = v - float(iy);
            for (size_t c = 0; c < 3; c++) {
                const float *a = image.c[c].row(iy) + ix, *b = image.c[c].row(iy + 1) + ix;
                const float top = a[0] + (a[1] - a[0]) * fx, bottom = b[0] + (b[1] - b[0]) * fx;
                sum[c] += top + (bottom - top) * fy;
            }
        }
        for (size_t c = 0; c < 3; c++) blurred_.c[c].at(x, y) = n == 1 ? sum[c] : sum[c] / float(n);
    }
    float scale_;
    Rgb blurred_;
};
}  // namespace

StageDescriptor motionBlurStage() {
    return {.value = realParam("motionBlur", "0.5", 0, 16,
                               "length of the blur in frame intervals; 0.5 = half-open shutter", "[Chapman 2012]"),
            .passes = Pass::motion,
            .create = [](const std::string& value, const MethodSpec&, const ShotInfo&) -> std::unique_ptr<Stage> {
                return std::make_unique<MotionBlurStage>(float(numberOf(value)));
            }};
}
}  // namespace aa
