// msaa, csaa: multisampling and coverage sampling, emulated from sub-sample geometry.
//
// Source: [Akeley 1993], [Young 2006]. Linear light, or displayed values
// (`space=encoded`: the colours go through the display chain before they are averaged, conventions 4). Every surface in
// a pixel is shaded once: the centre sample's surface has the pixel's colour, any other the colour of its sub-sample
// nearest to the pixel centre (a renderer would shade it at its centroid). out = sum of coverage x colour. A pixel of
// one surface keeps its colour: multisampling does not touch shading aliasing.
//
// Surface key: no triangle ids are exported, so samples share a surface when they share the object, their normals agree
// and they lie in one tangent plane (key=surface, the limits of SBAA); key=object takes whole objects.
// filter: another resolve than the mean: every sub-sample gets its surface's colour, and the filters of resolve weigh
// those of the neighbourhood; quincunx is two samples per pixel, half of the centre and an eighth of each corner.
// csaa: only the first `slots` sub-samples hold a colour; the others count for the stored surface that they lie on, or
// for the nearest slot when there is none (real slot patterns are undisclosed). Of the D3D patterns the first four
// positions lie near the centre and miss most edges: 7.6 / 5.8 dB on half-planes for 8 / 16 samples; spread over the
// pixel the same four slots reach 11.0 / 14.8. A surface whose colour is not finite is left out (conventions 11).
#pragma once
#include "kernels/display_args.h"
#include "kernels/subsample_args.h"
#include "kernels/surface_rule.h"

namespace aa {
struct MethodDescriptor;
MethodDescriptor msaaDescriptor();
MethodDescriptor csaaDescriptor();

inline constexpr int kMsaaMaxSamples = 32;
struct MsaaArgs {
    RgbIn color;   // linear
    RgbIn copied;  // what a pixel of one surface keeps: `color`, or its displayed values
    RgbOut out;
    const GeometryArgs* geometry;
    SurfaceRule rule;
    int slots;                   // sub-samples 0..slots-1 hold a colour; msaa: all of them
    const int* order;            // sub-samples by distance from the pixel centre
    const int* nearestSlot;      // of each sub-sample
    bool byGeometry;             // surfaces are objects split by geometry, or whole objects
    bool centroid;               // shade a partly covered surface at a covered sub-sample even if it covers the centre
    bool encoded;                // average displayed values
    DisplayArgs display;         // what makes them
    bool inverseLuminance;       // weight 1 / (1 + luminance)
    const RgbOut* sampleColors;  // per sub-sample: where its surface's colour goes; null when no filter follows
    float *surfacesLayer, *coverageLayer;  // debug layers; null when not kept
};
struct MsaaKernels {
    RowKernel<MsaaArgs> resolve;
};

}  // namespace aa
AA_KERNEL_TABLE(aa::MsaaKernels, msaaKernels)
