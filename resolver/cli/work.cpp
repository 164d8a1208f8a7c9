#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "cli/cli.h"
#include "image/error.h"
#include "kernels/dispatch.h"

namespace aa {

void addWorkOptions(Command& command, WorkOptions& work) {
    command.option("-j,--threads", work.threads, "threads; 0 = all processors").range(0, 1024);
    command.option("--isa", work.isa, "instruction set; every one gives the same bits")
        .oneOf({"auto", "v2", "v3", "v4"});
    command.option("--precision", work.precision, "fast = float lanes, scalar = float, double = the oracle")
        .oneOf({"fast", "scalar", "double"});
}

Exec WorkOptions::exec() const {
    Exec e;
    if (isa != "auto") e.isa = isa == "v4" ? Isa::v4 : isa == "v3" ? Isa::v3 : Isa::v2;
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
