#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "cli/cli.h"
#include "gpu/method.h"
#include "image/error.h"
#include "kernels/dispatch.h"

namespace aa {

void addWorkOptions(Command& command, WorkOptions& work) {
    command.option("-j,--threads", work.threads, "threads; 0 = all processors").range(0, 1024);
    command.option("--isa", work.isa, "instruction set; every one gives the same bits")
        .oneOf({"auto", "v2", "v3", "v4", "neon"});
    command.option("--precision", work.precision, "fast = float lanes, scalar = float, double = the oracle")
        .oneOf({"fast", "scalar", "double"});
}

void addDeviceOptions(Command& command, WorkOptions& work) {
    command.option(
        "--device", work.device,
        "cpu, vulkan, vulkan:NUMBER or vulkan:NAME (`aaresolve devices`): where methods run and pictures are compared");
    command
        .option("--gpu-precision", work.gpuPrecision,
                "exact = 32-bit images, filtered in the shader as on the processor; fast = 16-bit colours, motion "
                "and histories, filtered by the texture unit")
        .oneOf({"exact", "fast"});
    command.option("--gpu-shaders", work.gpuShaders,
                   "a folder of SPIR-V, as temporal/karis.spv, that stands for the program's own shaders");
    command.flag("--gpu-validate", work.gpuValidate,
                 "run under Vulkan's validation layer; its first complaint ends the run");
}

void addNonFinite(Command& command, std::string& policy, const std::string& whatSanitiseDoes) {
    command
        .option("--non-finite", policy,
                "NaN, Inf and other values that no method can use: sanitise = " + whatSanitiseDoes +
                    ", strict = refuse, raw = leave and count")
        .oneOf({"sanitise", "strict", "raw"});
}

std::pair<int, int> sizeOf(const std::string& option, const std::string& text) {
    int width = 0, height = 0, read = 0;
    int found = std::sscanf(text.c_str(), "%dx%d%n", &width, &height, &read);
    if (found == 1 && std::sscanf(text.c_str(), "%d%n", &width, &read) == 1) height = width, found = 2;
    if (found != 2 || size_t(read) != text.size() || std::min(width, height) < 1)
        throw UsageError(option + ": expected WIDTHxHEIGHT in one word, as in 480x270, found '" + text + "'");
    return {width, height};
}

std::shared_ptr<gpu::Session> WorkOptions::session() const {
    if (device == "cpu") {
        if (gpuPrecision != "exact" || gpuValidate || !gpuShaders.empty())
            throw UsageError("--gpu-precision, --gpu-validate, --gpu-shaders: no effect without --device vulkan");
        return {};
    }
    if (!gpuShaders.empty() && !std::filesystem::is_directory(gpuShaders))
        throw InputError(gpuShaders + ": expected a folder of SPIR-V files");
    return std::make_shared<gpu::Session>(gpu::Settings{
        device, gpuPrecision == "fast" ? gpu::Precision::fast : gpu::Precision::exact, gpuValidate, gpuShaders});
}

Exec WorkOptions::exec() const {
    Exec e;
    for (const Isa one : kIsas)
        if (name(one).ends_with(isa)) e.isa = one;
    if (!isaSupported(e.isa))
        throw UsageError("--isa " + isa + ": this processor lacks " + std::string(name(e.isa)) + "; leave --isa out");
    e.precision = precision == "double"   ? Precision::oracle
                  : precision == "scalar" ? Precision::scalar
                                          : Precision::fast;
    e.parallel = threads != 1;
    return e;
}

void withThreads(int threads, const std::function<void()>& body) {
    if (threads <= 0) return body();
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(threads));
    tbb::task_arena arena(threads);
    arena.execute(body);
}

}  // namespace aa
