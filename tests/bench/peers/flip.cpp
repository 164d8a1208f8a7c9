// NVIDIA's LDR-FLIP of two pictures of raw linear RGB floats: seconds of processor time, once.
#include <FLIP.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

int main(int, char** argv) {
    const int w = std::atoi(argv[3]), h = std::atoi(argv[4]);
    std::vector<float> pictures[2];
    for (int i = 0; i < 2; i++) {
        pictures[i].resize(3 * size_t(w) * size_t(h));
        std::FILE* const file = std::fopen(argv[1 + i], "rb");
        if (!file || std::fread(pictures[i].data(), sizeof(float), pictures[i].size(), file) != pictures[i].size())
            return 1;
    }
    FLIP::Parameters parameters;
    float mean = 0;
    float* map = nullptr;
    const std::clock_t start = std::clock();
    FLIP::evaluate(pictures[1].data(), pictures[0].data(), w, h, false, parameters, false, true, mean, &map);
    std::printf("%.9f\n", double(std::clock() - start) / CLOCKS_PER_SEC);
}
