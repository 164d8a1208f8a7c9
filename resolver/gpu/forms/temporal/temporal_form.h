// What the GPU forms of temporal methods share: shaders/common/temporal.glsl from the host's side.
#pragma once
#include "gpu/method.h"
#include "methods/temporal/history.h"
#include "methods/temporal/temporal_kernels.h"

namespace aa::gpu {

// The push constants of every temporal shader.
struct TemporalPush {
    int32_t width, height;
    int32_t texelX = 0, texelY = 0;
    float jitterX, jitterY;
    float readX = 0, readY = 0;
    float feedbackCeiling;
    uint32_t firstFrame;
    uint32_t frameNumber;
    uint32_t depthKnown = 0;
    float perDepth[4] = {0, 0, 1, 0}, constant[4] = {0, 0, 0, 0};
};

class TemporalForm : public GpuMethod {
  public:
    // `space`: in which the method reads its frame.
    TemporalForm(Session& session, const Params& params, std::string_view id, Space space);

  protected:
    void record(Current& current, Image& out) final;
    // One frame: bindings() come first in every dispatch, the form's own after them. next() becomes previous()
    // afterwards.
    virtual void recordTemporal(Current& current, const TemporalPush& push, Image& out) = 0;

    // Whether what is shown is the blend itself, so that one store serves both. Asked after the constructor.
    virtual bool showsBlend() const { return false; }
    // Whether the shaders store it beside the blend: not where a later pass makes what is shown either.
    virtual bool storesResult() const { return !showsBlend(); }
    // Bindings 0 to 6. Where a method has no use for depth, any image stands there.
    std::vector<Binding> bindings(Current& current, Image& out);
    // Constants 0 to 5 and the form's own.
    std::vector<Constant> constants(std::vector<Constant> own = {}) const;
    const History& history() const { return history_; }
    TwoImages& blend() { return blend_; }
    const Image* rejectionImage() const override { return &rejection_; }
    const Image* shownImage() const override { return showsBlend() ? &blend_.images[1 - blend_.now] : nullptr; }
    // Whether the method has such a parameter.
    bool has(std::string_view name) const { return params().all().count(name) > 0; }

  private:
    TemporalPush begin(const Frame& frame);
    std::string_view id_;
    Space space_;
    History history_;  // counts frames and checks their size
    TwoImages blend_;
    Image rejection_, unused_;
    Shader narrow_;      // of a history that is kept in 32 bits and rounded to fewer
    bool wide_ = false;  // it is
    uint32_t lastNumber_ = 0;
};

}  // namespace aa::gpu
