#pragma once
#include "kernels/pq_tables.h"
#include "methods/temporal_kernels.h"

namespace aa {
enum class BoxKind { minmax, variance, intersection };
enum class HistoryConstraint { clipFiltered, clipMean, clamp };
enum class AntiFlicker { none, karis, falcor };
inline constexpr int kKarisScratchRows = 16;
struct KarisArgs {
    TemporalIn in;       // linear colour; history as the box sees it, but RGB
    const PqTables* pq;  // the box and the history hold PQ values; null: linear ones
    float alpha;         // weight of the current colour
    float filter[9];     // weights of the 3x3 current samples by distance, row-major; ignored without `filtered`
    bool filtered, toneWeighted, hdr4, ycocg, inverseLuminance;
    BoxKind box;
    HistoryConstraint constraint;
    Neighbourhood neighbourhood;
    float gamma;
    AntiFlicker antiFlicker;
    void* scratch;  // kKarisScratchRows rows
};
struct KarisKernels {
    RowKernel<KarisArgs> resolve;
    void (*fillPqTables)(PqTables&);  // the same bits on every instruction set
};
}  // namespace aa
AA_KERNEL_TABLE(aa::KarisKernels, karisKernels)
