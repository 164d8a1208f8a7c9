// Which text of a kernel runs: instruction set and precision, chosen at run time, and the scheduling of its rows.
//
// NAME.kernel.cpp is compiled once per instruction set (-march=x86-64-v2|v3|v4, AA_ARCH=v2|v3|v4; on Arm AA_ARCH=neon)
// and exports one table of RowKernels (kernels/table.h). All instruction sets and both float precisions give the same
// bits.
#pragma once
#include <functional>
#include <memory>
#include <string_view>

#include "kernels/table.h"

namespace aa {

bool isaSupported(Isa isa);  // whether this build holds it and this processor runs it
std::string_view name(Isa isa);

// Processor time of the thread that makes it and, meanwhile, of the threads to which it gives rows by parallelRows():
// neither other programs on the machine nor the threads that read files lengthen it. One at a time per thread.
class ProcessorTime {
  public:
    ProcessorTime();
    ~ProcessorTime();
    double seconds() const;

  private:
    double start_;
};

// task(0) .. task(count - 1), side by side where `exec` allows it and in order where not. Each may give rows to others
// and waits for its own alone, so that what one measures is its own. The first exception ends them all.
void sideBySide(const Exec& exec, size_t count, const std::function<void(size_t)>& task);

// Blocks of `grain` rows on all threads of the caller's arena. TBB stands behind dispatch.cpp alone: its headers cost
// each file that includes them as much to compile as all else.
void parallelRows(int height, int grain, const std::function<void(int y0, int y1)>& rows);
// Runs a row function over [0, height) in blocks of rows; the result cannot depend on the split.
template <class Fn>
void forRows(const Exec& exec, int height, const Fn& rows, int grain = 8) {
    if (!exec.parallel || height <= grain) {
        rows(0, height);
        return;
    }
    parallelRows(height, grain, [&](int y0, int y1) { rows(y0, y1); });
}
// The form of a kernel that serves the precision asked for: fn(args, y0, y1).
template <class Args>
auto rowsOf(const RowKernel<Args>& kernel, Precision precision) {
    return precision == Precision::fast ? kernel.fast : precision == Precision::scalar ? kernel.scalar : kernel.oracle;
}
// `height` rows, or blocks of rows where the kernel's table says so: those with grain 1.
template <class Args>
void runKernel(const RowKernel<Args>& kernel, const Exec& exec, const Args& args, int height, int grain = 8) {
    const auto fn = rowsOf(kernel, exec.precision);
    forRows(
        exec, height, [&](int y0, int y1) { fn(args, y0, y1); }, grain);
}

// Working memory of a kernel's calls, one per thread: `rows` rows of a plane's stride in any precision.
class Scratch {
  public:
    Scratch(int rows, int stride);
    ~Scratch();
    void* local();

  private:
    struct Memory;
    std::unique_ptr<Memory> memory_;
};

}  // namespace aa
