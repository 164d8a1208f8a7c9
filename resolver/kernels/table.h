// What a kernel translation unit and its callers share: plain argument views and the table of entry points.
// Nothing here may instantiate a standard container: kernel objects must not carry symbols that the linker could merge.
#pragma once
#include <cstdint>

namespace aa {

// Views: pointers to pixel (0, 0) of planes that share one stride (in pixels); borders as in image/plane.h.
struct RgbIn {
    const float* c[3];
};
struct RgbOut {
    float* c[3];
};

enum class Isa { v2, v3, v4, neon };  // x86-64-v2, -v3, -v4; 64-bit Arm's
inline constexpr Isa kIsas[] = {Isa::v2, Isa::v3, Isa::v4, Isa::neon};
enum class Precision { fast, scalar, oracle };  // float lanes, float, double arithmetic on float storage

Isa bestIsa();  // the widest set that this build holds and this processor runs

// How work is executed; passed to every method, never global. The number of threads is the caller's TBB arena.
struct Exec {
    Isa isa = bestIsa();
    Precision precision = Precision::fast;
    bool parallel = true;  // false: the calling thread alone
};

// A kernel: a function over rows [y0, y1) of its own argument struct, in three precisions. The one-lane forms are the
// same on every instruction set, so they are built once, for a table of their own (namespace plain), whose `fast` is
// null; theirs are null in the tables of the sets.
template <class Args>
struct RowKernel {
    void (*fast)(const Args&, int, int);
    void (*scalar)(const Args&, int, int);
    void (*oracle)(const Args&, int, int);
};

// A kernel may keep rows of intermediate values in scratch memory (kernels/ring.h): `rows` of them, as wide as a
// plane's stride, after a margin.
inline constexpr int kRingMargin = 16;

}  // namespace aa

// In a method's header: AA_KERNEL_TABLE(FxaaKernels, fxaaKernels) declares v2::, v3::, v4:: and plain::fxaaKernels and
// aa::fxaaKernelsFor(exec). In its .kernel.cpp: AA_DEFINE_TABLE(FxaaKernels, fxaaKernels) = {AA_ROWS(fxaaRows), ...};
// Where the build holds one instruction set alone (AA_ONE_ISA), as every build for Arm does, every isa means that one.
#define AA_DECLARE_TABLE(set, Type, table) \
    namespace set {                        \
    extern const Type table;               \
    }
#ifdef AA_ONE_ISA
#define AA_KERNEL_TABLE(Type, table)                                                     \
    AA_DECLARE_TABLE(plain, Type, table)                                                 \
    AA_DECLARE_TABLE(AA_ONE_ISA, Type, table)                                            \
    namespace aa {                                                                       \
    inline const Type& table##For(const Exec& exec) {                                    \
        return exec.precision == Precision::fast ? ::AA_ONE_ISA::table : ::plain::table; \
    }                                                                                    \
    }
#else
#define AA_KERNEL_TABLE(Type, table)                                  \
    AA_DECLARE_TABLE(plain, Type, table)                              \
    AA_DECLARE_TABLE(v2, Type, table)                                 \
    AA_DECLARE_TABLE(v3, Type, table)                                 \
    AA_DECLARE_TABLE(v4, Type, table)                                 \
    namespace aa {                                                    \
    inline const Type& table##For(const Exec& exec) {                 \
        if (exec.precision != Precision::fast) return ::plain::table; \
        if (exec.isa == Isa::v2) return ::v2::table;                  \
        return exec.isa == Isa::v4 ? ::v4::table : ::v3::table;       \
    }                                                                 \
    }
#endif
#define AA_DEFINE_TABLE(Type, table)       \
    AA_DECLARE_TABLE(AA_ARCH, Type, table) \
    const Type AA_ARCH::table
// AA_WIDE_ROWS: for kernels that compute much per pixel and whose tiles have room for 16 pixels at a time.
#ifdef AA_PLAIN_FORMS
#define AA_FORMS(fast, scalar, oracle) \
    { nullptr, scalar, oracle }
#else
#define AA_FORMS(fast, scalar, oracle) \
    { fast, nullptr, nullptr }
#endif
#define AA_WIDE_ROWS(fn) AA_FORMS((fn<AA_ARCH::Lanes<float, AA_WIDE_LANES>>), fn<float>, fn<double>)
#define AA_ROWS(fn) AA_FORMS((fn<AA_ARCH::Lanes<float, AA_LANES>>), fn<float>, fn<double>)
