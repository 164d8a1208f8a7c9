// SMAA: enhanced subpixel morphological anti-aliasing ([Jimenez 2012], reference shader v2.8).
//
// 1. Edge bits per pixel (left, top) where luma, colour or depth differ, kept only where no neighbouring edge is twice
// as
//    strong. 2. For every edge pixel the distances to the ends of its line and the edges that cross there; the line is
//    revectorised through half the height of the crossing edges and the areas that it cuts off are the blending
//    weights; diagonals and sharp corners have their own rules. 3. Every pixel is blended with its two neighbours
//    across the stronger of its axes.
// Edges are found on encoded colour; blending is in linear light by default. Distances in px.
// Deviations: areas are exact at the integer distances instead of a lookup in an 8-bit texture of square distances
// (areas=table gives that); left edges are processed as top edges of the transposed edge planes.
#pragma once
#include "methods/method.h"
#include "methods/spatial/edge_bits.h"
#include "methods/spatial/smaa_kernels.h"

namespace aa {

// What the parameters say of the passes: thresholds and lengths, no planes yet.
struct SmaaSettings {
    SmaaEdgeArgs edge{};
    SmaaBlendArgs blend{};
    bool published = false;  // areas as in the shader's texture
};
SmaaSettings smaaSettings(const Params& params);

// The three passes, for one image at a time.
class Smaa {
  public:
    explicit Smaa(const Params& params);
    // Finds edges in `colorEncoded` (or frame.depthView). The image was sampled at `samplePx` from the pixel centres (y
    // down); its revectorised edges are moved back by that much (decisions 40).
    void findEdges(const Frame& frame, const Rgb& colorEncoded, glm::dvec2 samplePx, const Exec& exec);
    // The same for linear colours, which the frame's display chain encodes.
    void findEdgesOfLinear(const Frame& frame, const Rgb& colorLinear, glm::dvec2 samplePx, const Exec& exec);
    // Blends planes of one stride by the weights of the edges found last: the colour and, when given, the motion.
    // Borders of the input are filled. `averaged`: the mean of the result and of what `out` and `motionOut` hold.
    void blend(const Rgb& in, Rgb& out, const Exec& exec);
    void blend(const Rgb& in, Rgb& out, const PlaneF* const motion[2], PlaneF* const motionOut[2], bool averaged,
               const Exec& exec);
    size_t bytes() const;
    bool keepDebugLayers = false;
    std::vector<DebugLayer> debugLayers() const;

  private:
    // Area tables for one sample position: of top and left edges, and of the two diagonal directions.
    struct Tables {
        glm::dvec2 samplePx;
        std::vector<float> orthogonal[2], diagonal[2];
    };
    const Tables& tablesFor(glm::dvec2 samplePx);  // made on first use
    // From luma_ where edges are those of luma, and otherwise from `colorEncoded` or the frame's depth.
    void findEdges(const Frame& frame, const Rgb* colorEncoded, int width, int height, glm::dvec2 samplePx,
                   const Exec& exec);
    SmaaEdgeArgs edge_{};
    SmaaBlendArgs blend_{};
    bool published_;  // areas as in the shader's texture
    glm::dvec2 samplePx_{0.0};
    std::vector<Tables> tables_;
    int width_ = 0, height_ = 0, border_;
    PlaneF luma_;
    Rgb encoded_;  // of linear colours, where their edges are those of colour
    BitPlane top_, left_, topByColumn_, leftByColumn_;
    std::vector<float> scratch_;
    std::vector<uint8_t> diagonals_;
    std::vector<float> topWeights_, leftWeights_, topLengths_, leftLengths_;  // debug
    std::vector<uint8_t> isDiagonal_;
};

// Parameters of the SMAA family: preset, edges, thresholds, areas.
std::vector<ParamSpec> smaaParams();
PassSet smaaPasses(const Params& params);
// Indices of the two sub-samples that a frame is made of; smaa4x: in even and in odd frames. Throw InputError where the
// shot lacks them.
using SmaaSamples = std::array<size_t, 2>;
SmaaSamples smaaS2xSamples(const ShotInfo& shot);
std::array<SmaaSamples, 2> smaa4xSamples(const ShotInfo& shot);

MethodDescriptor smaa1xDescriptor();
MethodDescriptor smaaS2xDescriptor();  // two sub-samples, each through SMAA 1x, averaged
MethodDescriptor smaaT2xDescriptor();  // two jittered frames, weighted by velocity
MethodDescriptor smaa4xDescriptor();   // both

}  // namespace aa
