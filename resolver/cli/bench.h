// What the two halves of `bench` share: the processor's (bench.cpp) and the graphics device's (bench_device.cpp).
#pragma once
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
    bool json = false, markdown = false;
    WorkOptions work = {.threads = 1};
};
void benchDevice(const BenchOptions& options, const std::vector<MethodSpec>& methods);

}  // namespace aa
