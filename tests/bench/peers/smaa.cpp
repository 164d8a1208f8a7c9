// smaa-cpp's SMAA HIGH of a picture of raw RGBA floats: seconds of processor time, once.
#include <cstdio>
#include <cstdlib>
#include <ctime>
// Its headers rely on those above.
#include <smaa.h>
#include <smaa_types.h>

using namespace SMAA;

int main(int, char** argv) {
    const int w = std::atoi(argv[2]), h = std::atoi(argv[3]);
    Image picture(w, h), edges(w, h), weights(w, h), out(w, h);
    std::FILE* const file = std::fopen(argv[1], "rb");
    float v[4];
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            if (!file || std::fread(v, sizeof v, 1, file) != 1) return 1;
            picture.putPixel(x, y, v);
        }
    PixelShader shader(CONFIG_PRESET_HIGH);
    const auto pass = [&](Image& to, auto compute) {
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++) {
                compute(x, y);
                to.putPixel(x, y, v);
            }
    };
    const std::clock_t start = std::clock();
    pass(edges, [&](int x, int y) { shader.lumaEdgeDetection(x, y, &picture, nullptr, v); });
    pass(weights, [&](int x, int y) { shader.blendingWeightCalculation(x, y, &edges, nullptr, v); });
    pass(out, [&](int x, int y) { shader.neighborhoodBlending(x, y, &picture, &weights, nullptr, v); });
    std::printf("%.9f\n", double(std::clock() - start) / CLOCKS_PER_SEC);
}
