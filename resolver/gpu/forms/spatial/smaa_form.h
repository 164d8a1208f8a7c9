// What the GPU forms of the SMAA family share: the three passes of shaders/spatial/smaa_*.comp from the host's side.
#pragma once
#include <glm/glm.hpp>

#include "gpu/method.h"
#include "methods/spatial/smaa.h"

namespace aa::gpu {

class SmaaForm : public GpuMethod {
  public:
    SmaaForm(Session& session, const Params& params);

  protected:
    // Edges and weights of an image that was sampled at `samplePx` from the pixel centres (y down). `encoded` may be
    // null where edges are those of depth.
    void findEdges(Current& current, const Image* encoded, glm::dvec2 samplePx);
    // Blends `in` by the weights of the edges found last and, where `velocity` is not null, the frame's motion into it.
    struct Blended {
        Image* colour;
        Image* velocity = nullptr;
    };
    void blend(Current& current, const Image& in, Blended out) { blend(current, in, out, nullptr); }
    // Two sub-samples of the frame, each through the passes with its edges moved back, averaged.
    void blendTwo(Current& current, const ShotInfo& shot, SmaaSamples samples, Blended out);

    bool linear() const { return linear_; }
    bool needsEncoded() const { return settings_.edge.kind != SmaaEdges::depth; }
    Format velocityFormat() const { return session().fast() ? Format::rg16f : Format::rg32f; }

  private:
    struct Areas {
        glm::dvec2 samplePx;
        Buffer memory;
    };
    const Buffer& areasFor(Current& current, glm::dvec2 samplePx);  // made on first use
    // `first`: what `out` averages with; null: nothing.
    void blend(Current& current, const Image& in, Blended out, const Blended* first);
    const Image& separate(Current& current, Input samples, size_t layer, Image& to);

    SmaaSettings settings_;
    bool linear_;
    Shader edgesShader_, weightsShader_, blendShader_, velocityShader_, separateShader_;
    Image edges_, weights_, noIds_;
    Image encoded_, colour_;       // of one sub-sample
    Image first_, firstVelocity_;  // of the first of two
    std::vector<Areas> areas_;
    size_t latest_ = size_t(-1);  // of areas_, a ring
};

}  // namespace aa::gpu
