#pragma once
#include "kernels/pq_tables.h"
#include "methods/temporal_kernels.h"

namespace aa {
enum class BoxKind { minmax, variance, intersection };
enum class HistoryConstraint { clipFiltered, clipMean, clamp };
enum class AntiFlicker { none, karis, falcor };
struct KarisArgs {
    TemporalIn in;
    float alpha;      // weight of the current colour
    float filter[9];  // weights of the 3x3 current samples by distance, row-major; ignored without `filtered`
    bool filtered, toneWeighted, hdr4, ycocg, inverseLuminance;
    BoxKind box;
    HistoryConstraint constraint;
    Neighbourhood neighbourhood;
    float gamma;
    AntiFlicker antiFlicker;
};
// Pointwise PQ transfer of three planes (donut).
struct PqArgs {
    RgbIn in;
    RgbOut out;
    int stride, width;
    const PqTables* tables;
};
struct KarisKernels {
    RowKernel<KarisArgs> resolve;
    RowKernel<PqArgs> pqEncode, pqDecode;
    void (*fillPqTables)(PqTables&);  // the same bits on every instruction set
};
}  // namespace aa
AA_KERNEL_TABLE(aa::KarisKernels, karisKernels)
