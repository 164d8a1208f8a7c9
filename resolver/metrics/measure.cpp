#include "metrics/measure.h"

#include "metrics/error_bar.h"
#include "metrics/flip.h"

namespace aa {

Reference makeReference(const Rgb& halfA, const Rgb& halfB, const DisplayChain& display, const Exec& exec,
                        bool eightBit) {
    const int w = halfA.width(), h = halfA.height();
    Reference r{Rgb(w, h), {}};
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < h; y++) {
            const float *a = halfA.c[c].row(y), *b = halfB.c[c].row(y);
            float* mean = r.linear.c[c].row(y);
            for (int x = 0; x < w; x++) mean[x] = 0.5f * a[x] + 0.5f * b[x];
        }
    r.linear.fillBorder();
    encode(r.linear, display, exec, r.encoded);
    if (display.transfer == Transfer::identity) {
        r.clippedPixels = clippedPixels(r.linear, display);
        r.linear = r.encoded;
    }
    if (eightBit) quantise8(r.encoded, exec);
    Rgb encodedA, encodedB;
    encode(halfA, display, exec, encodedA);
    encode(halfB, display, exec, encodedB);
    r.noise = truthNoise(squaredError(encodedA, encodedB, exec).mse);
    return r;
}

FrameMetrics measure(const Rgb& encoded, const Rgb* linear, const Reference& reference, const MeasureOptions& options,
                     const Exec& exec, TileErrors& pool) {
    const TileErrors errors = tileErrors(encoded, reference.encoded, exec);
    pool += errors;
    const SquaredError e = errors.squaredError();
    FrameMetrics m;
    m.mse = e.mse;
    m.reference = e.reference;
    m.psnr = psnr(e.mse);
    m.snr = snr(e);
    m.ssimLuma = ssimLuma(encoded, reference.encoded, exec);
    if (linear) m.relMse = relMse(*linear, reference.linear, exec);
    if (options.ssimRgb) m.ssimRgb = ssimRgb(encoded, reference.encoded, exec);
    if (options.flip) m.flip = flip(encoded, reference.encoded, exec);
    return m;
}

}  // namespace aa
