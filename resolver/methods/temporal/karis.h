// karis, salvi, falcor, donut: one skeleton in linear HDR, four published sets of choices.
//
//  1. current colour: 3x3 samples weighted by their distance to the pixel centre (Blackman-Harris fit
//     exp(-2.29 d^2), d = |neighbour + jitter|) and by 1 / (1 + luminance)
//  2. colour box in YCoCg: min/max (rounded), variance about the centre pixel, or their intersection
//  3. history is clipped into it toward the filtered centre (karis), the mean (salvi), or clamped (falcor, donut)
//  4. weight of the current colour, with an anti-flicker rule; 5. blend with weights 1 / (1 + luminance)
// karis: [Karis 2014] (Unreal Engine 4); its anti-flicker is the public engine's. salvi: [Salvi 2016], variance
// clipping.
// falcor: the TAA pass of [Falcor 2022] (longest motion, clamp, no filter, plain blend). donut: that of [Donut 2021]
// (values PQ-encoded at nominal 10000; clamp to mean -+ sigma). Outside the image: the (filtered) current colour.
// Input and output: linear light, >= 0; depth planar; motion in px.
#pragma once
#include "kernels/pq_tables.h"
#include "methods/temporal/temporal_kernels.h"

namespace aa {
struct MethodDescriptor;
MethodDescriptor karisDescriptor();
MethodDescriptor salviDescriptor();
MethodDescriptor falcorDescriptor();
MethodDescriptor donutDescriptor();

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
// KarisArgs::filter for the jitter of the colours as they are read, px.
void karisFilter(float jitterXPx, float jitterYPx, float (&filter)[9]);
struct KarisKernels {
    RowKernel<KarisArgs> resolve;
    void (*fillPqTables)(PqTables&);  // the same bits on every instruction set
};
}  // namespace aa
AA_KERNEL_TABLE(aa::KarisKernels, karisKernels)
