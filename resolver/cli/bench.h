// What the two halves of `bench` share: the processor's (bench.cpp) and the graphics device's (bench_device.cpp).
#pragma once
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "cli/bench_frames.h"
#include "cli/cli.h"

namespace aa {

struct BenchOptions {
    std::vector<std::string> methods, sizes = {"1920x1080"};
    std::string shot, scene, nonFinite = "sanitise";
    int frames = 8, repeats = 3, runs = 200;
    bool json = false, markdown = false, everyIsa = false, noError = false;
    WorkOptions work = {.threads = 1};
};
void benchDevice(const BenchOptions& options, const std::vector<MethodSpec>& methods);

// Of one value over all timed frames.
struct Spread {
    double median = 0, low = 0, high = 0, least = 0;  // low, high: the quartiles
};
inline Spread spreadOf(std::vector<double> v) {
    std::sort(v.begin(), v.end());
    const auto at = [&](double share) { return v[size_t(share * double(v.size() - 1) + 0.5)]; };
    return {at(0.5), at(0.25), at(0.75), v.front()};
}

}  // namespace aa
