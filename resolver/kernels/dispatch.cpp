#include "kernels/dispatch.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <time.h>

#include <atomic>
#include <vector>

namespace aa {
namespace {
int64_t threadNanoseconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return int64_t(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
}
struct Meter {
    bool runs = false;
    std::atomic<int64_t> ofOthers = 0;
};
thread_local Meter meter;
}  // namespace

ProcessorTime::ProcessorTime() : start_(1e-9 * double(threadNanoseconds())) {
    meter.runs = true;
    meter.ofOthers = 0;
}
ProcessorTime::~ProcessorTime() { meter.runs = false; }
double ProcessorTime::seconds() const { return 1e-9 * double(threadNanoseconds() + meter.ofOthers) - start_; }

void parallelRows(int height, int grain, const std::function<void(int, int)>& rows) {
    Meter* const mine = &meter;  // of the caller; a task's own is another
    const bool measured = mine->runs;
    const auto block = [&](const tbb::blocked_range<int>& r) {
        if (!measured || &meter == mine) return rows(r.begin(), r.end());
        const int64_t start = threadNanoseconds();
        rows(r.begin(), r.end());
        mine->ofOthers += threadNanoseconds() - start;
    };
    // Isolated: while it waits for the last rows the caller would else begin another method, as its own time.
    tbb::this_task_arena::isolate([&] {
        tbb::parallel_for(tbb::blocked_range<int>(0, height, size_t(grain)), block, tbb::simple_partitioner{});
    });
}

void sideBySide(const Exec& exec, size_t count, const std::function<void(size_t)>& task) {
    if (exec.parallel)
        tbb::parallel_for(size_t(0), count, task, tbb::simple_partitioner{});
    else
        for (size_t i = 0; i < count; i++) task(i);
}

struct Scratch::Memory {
    tbb::enumerable_thread_specific<std::vector<double>> rows;
};
Scratch::Scratch(int rows, int stride)
    : memory_(new Memory{
          tbb::enumerable_thread_specific<std::vector<double>>(size_t(kRingMargin) + size_t(rows) * size_t(stride))}) {}
Scratch::~Scratch() = default;
void* Scratch::local() { return memory_->rows.local().data(); }

bool isaSupported(Isa isa) {
#ifdef AA_SANITIZED
    if (isa == Isa::v3 || isa == Isa::v4)
        return false;  // only the first of a processor's is instrumented (CMakeLists.txt)
#endif
#ifdef AA_ONE_ISA  // what else was built (CMakeLists.txt, AA_ISAS)
#define AA_TEXT_OF(x) #x
#define AA_TEXT(x) AA_TEXT_OF(x)
    if (!name(isa).ends_with(AA_TEXT(AA_ONE_ISA))) return false;
#endif
#ifdef __aarch64__
    return isa == Isa::neon;  // part of every such processor
#else
    switch (isa) {
        case Isa::v4:
            return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                   __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                   __builtin_cpu_supports("avx512vl");
        case Isa::v3:
            return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
        case Isa::v2:
            return __builtin_cpu_supports("sse4.2");
        case Isa::neon:
            break;
    }
    return false;
#endif
}

Isa bestIsa() {
    static const Isa best = [] {
        Isa widest = kIsas[0];
        for (const Isa isa : kIsas)
            if (isaSupported(isa)) widest = isa;
        return widest;
    }();
    return best;
}

std::string_view name(Isa isa) {
    switch (isa) {
        case Isa::v2:
            return "x86-64-v2";
        case Isa::v3:
            return "x86-64-v3";
        case Isa::v4:
            return "x86-64-v4";
        case Isa::neon:
            return "neon";
    }
    return "";
}

}  // namespace aa
