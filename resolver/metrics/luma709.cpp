#include "metrics/luma709.h"

#include "metrics/measure.h"

namespace aa {
namespace {
// In all three channels, so that figures of pictures serve.
Rgb lumaOf(const Rgb& encoded, const Exec& exec) {
    Rgb luma(encoded.width(), encoded.height());
    forRows(exec, encoded.height(), [&](int y0, int y1) {
        for (int y = y0; y < y1; y++) {
            const float *r = encoded.c[0].row(y), *g = encoded.c[1].row(y), *b = encoded.c[2].row(y);
            float* out = luma.c[0].row(y);
            for (int x = 0; x < encoded.width(); x++) out[x] = 0.2126f * r[x] + 0.7152f * g[x] + 0.0722f * b[x];
        }
    });
    luma.c[0].fillBorder();
    luma.c[2] = luma.c[1] = luma.c[0];
    return luma;
}
}  // namespace

Luma709 luma709(const Rgb& test, const Rgb& reference, const Exec& exec) {
    const Rgb t = lumaOf(test, exec), r = lumaOf(reference, exec);
    // Luma 601 of grey is that grey.
    return {squaredError(t, r, exec).mse, ssimLuma(t, r, exec)};
}

Metric luma709Metric() {
    return {.figures = {{"psnrLuma709", "PSNR 709", "PSNR of BT.709 luma, dB", FigureForm::decibels, true, nullptr,
                         [](const FrameMetrics& m) { return psnr(m.others.at("mseLuma709")); }},
                        {"mseLuma709", "MSE 709", "mean squared error of BT.709 luma"},
                        {"ssimLuma709", "SSIM 709", "SSIM of BT.709 luma", FigureForm::similarity, true}},
            .nsPerPixel = 12,
            .source = "conventions 13.2",
            .measure = [](const ImagePair& i, const Exec& exec) {
                const Luma709 l = luma709(i.testEncoded, i.referenceEncoded, exec);
                return std::vector{psnr(l.mse), l.mse, l.ssim};
            }};
}

}  // namespace aa
