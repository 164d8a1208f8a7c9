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
#include <functional>
#include <list>
#include <optional>
#include <span>

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

// The three passes, of one image or of two whose results are averaged.
class Smaa {
  public:
    // Motion that is blended by the same weights: two planes in, two out.
    struct Motion {
        const PlaneF* in[2];
        PlaneF* out[2];
    };
    using RowsDone = std::function<void(int y0, int y1)>;

    explicit Smaa(const Params& params);
    // Finds edges in `colorEncoded` (or frame.depthView). The image was sampled at `samplePx` from the pixel centres (y
    // down); its revectorised edges are moved back by that much (decisions 40).
    void findEdges(const Frame& frame, const Rgb& colorEncoded, glm::dvec2 samplePx, const Exec& exec,
                   size_t image = 0);
    // The same for linear colours, which the frame's display chain encodes.
    void findEdgesOfLinear(const Frame& frame, const Rgb& colorLinear, glm::dvec2 samplePx, const Exec& exec,
                           size_t image = 0);
    // Blends planes of one stride by the weights of the edges found last: the colours of each image and, when given,
    // the motion. Borders of the input are filled. done(y0, y1) is called when these rows of the output hold their
    // results, and still lie in the cache.
    void blend(std::span<const Rgb* const> images, Rgb& out, const Exec& exec, const std::optional<Motion>& motion = {},
               const RowsDone& done = {});
    size_t bytes() const;
    bool keepDebugLayers = false;
    std::vector<DebugLayer> debugLayers(size_t image = 0) const;

  private:
    // Area tables for one sample position: of top and left edges, and of the two diagonal directions.
    struct Tables {
        glm::dvec2 samplePx;
        std::vector<float> orthogonal[2], diagonal[2];
    };
    struct Edges {
        glm::dvec2 samplePx{0.0};
        BitPlane top, left, topByColumn, leftByColumn;
        std::vector<float> topWeights, leftWeights, topLengths, leftLengths;  // debug
        std::vector<uint8_t> isDiagonal;
    };
    const Tables& tablesFor(glm::dvec2 samplePx);  // made on first use
    // `color` is encoded, or linear for edges of luma and `encodes`; null where edges are those of depth.
    void findEdges(const Frame& frame, const Rgb* color, bool encodes, glm::dvec2 samplePx, const Exec& exec,
                   Edges& edges);
    // The image without its colours.
    SmaaImage imageOf(Edges& edges);
    SmaaEdgeArgs edge_{};
    SmaaBlendArgs blend_{};
    bool published_;            // areas as in the shader's texture
    std::list<Tables> tables_;  // the last one was used last
    int width_ = 0, height_ = 0, border_;
    Edges edges_[kSmaaImages];
    Rgb encoded_;  // of linear colours, where their edges are those of colour
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
