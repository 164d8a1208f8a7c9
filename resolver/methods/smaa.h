// SMAA: enhanced subpixel morphological anti-aliasing (Jimenez et al. 2012, reference shader v2.8; methods/03 s.3.2).
//
// 1. Edge bits per pixel (left, top) where luma, colour or depth differ, kept only where no neighbouring edge is twice
// as
//    strong. 2. For every edge pixel the distances to the ends of its line and the edges that cross there; the line is
//    revectorised through half the height of the crossing edges and the areas that it cuts off are the blending
//    weights; diagonals and sharp corners have their own rules. 3. Every pixel is blended with its two neighbours
//    across the stronger of its axes.
// Edges are found on encoded colour; blending is in linear light by default. Distances in px.
// Deviations: areas are exact at the integer distances instead of a lookup in an 8-bit texture of square distances
// (areas=table gives that); left edges are processed as top edges of the transposed edge plane.
#pragma once
#include "methods/method.h"
#include "methods/smaa_kernels.h"

namespace aa {

// A plane of bytes whose border repeats the edge pixels `border` far in both axes.
class EdgePlane {
  public:
    void resize(int width, int height, int border);
    void clear();
    void fillBorder();
    uint8_t* row(int y) { return bytes_.data() + (ptrdiff_t(y) + border_) * stride_ + border_; }
    const uint8_t* row(int y) const { return bytes_.data() + (ptrdiff_t(y) + border_) * stride_ + border_; }
    int stride() const { return stride_; }
    size_t bytes() const { return bytes_.size(); }

  private:
    int width_ = 0, height_ = 0, border_ = 0, stride_ = 0;
    std::vector<uint8_t> bytes_;
};

// Sub-sample of a frame: across which offset its edges are revectorised (methods/03 s.3.3-3.5).
struct SmaaSubSample {
    float leftEdgeOffset = 0, topEdgeOffset = 0;
    std::array<std::array<double, 2>, 2> diagonalOffsets = {};  // of the two diagonal directions, y up
};

// The three passes, for one image at a time.
class Smaa {
  public:
    Smaa(const Params& params, const SmaaSubSample& subSample);
    // Finds edges in `colorEncoded` (or frame.depthView) and the weights of `edges()`.
    void findWeights(const Frame& frame, const Rgb& colorEncoded, const Exec& exec);
    // Blends `channels` planes of stride `stride` by the weights found last; borders of the input are filled.
    void blend(const float* const in[3], float* const out[3], int channels, int stride, const Exec& exec) const;
    void blend(const Rgb& in, Rgb& out, const Exec& exec) const;
    size_t bytes() const;
    bool keepDebugLayers = false;
    std::vector<DebugLayer> debugLayers() const;

  private:
    void findEdges(const Frame& frame, const Rgb& colorEncoded, const Exec& exec);
    SmaaEdgeArgs edge_{};
    SmaaWeightArgs weight_{};
    std::vector<float> orthoTables_[2], diagonalTables_[2];  // top and left edges; the two directions
    float topOffset_, leftOffset_;
    int width_ = 0, height_ = 0, border_;
    PlaneF luma_;
    EdgePlane edges_, transposed_;
    std::vector<float> topWeights_, leftWeights_, topLengths_, leftLengths_;
};

// Parameters of the SMAA family: preset, edges, thresholds, areas.
std::vector<ParamSpec> smaaParams();
PassSet smaaPasses(const Params& params);

MethodDescriptor smaa1xDescriptor();

}  // namespace aa
