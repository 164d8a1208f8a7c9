// What the FXAA variants share on the host: the luma plane, debug planes and search patterns.
#pragma once
#include <cassert>

#include "methods/method.h"
#include "methods/spatial/fxaa.h"
#include "methods/spatial/luma.h"
#include "methods/working.h"

namespace aa {

struct FxaaPreset {
    std::string_view name;
    std::vector<double> stepsPx;  // increments; the last is a jump whose end is never sampled
};
inline std::vector<std::string_view> presetNames(const std::vector<FxaaPreset>& presets) {
    std::vector<std::string_view> names;
    for (const auto& p : presets) names.push_back(p.name);
    return names;
}
inline void setDistances(FxaaArgs& args, const std::vector<double>& stepsPx) {
    double sumPx = 0;
    args.steps = 0;
    for (const double step : stepsPx) args.distanceHalfPx[args.steps++] = int(2 * (sumPx += step));
    for (int k = 0; k + 1 < args.steps; k++) {  // no pattern samples twice within a pixel, nor beyond 24 px
        const int wholePx = args.distanceHalfPx[k] / 2, window = (wholePx - 1) / 8, bit = (wholePx - 1) % 8;
        assert(window < kFxaaWindows && !(args.sampled[window] >> bit & 1));
        args.sampled[window] |= 1u << bit;
        args.half[window] |= unsigned(args.distanceHalfPx[k] & 1) << bit;
        args.sampledMirrored[window] |= 0x80u >> bit;
        args.halfMirrored[window] |= unsigned(args.distanceHalfPx[k] & 1) << 7 >> bit;
        args.windows = window + 1;
    }
}

// What a method's parameters say, without a frame's planes.
FxaaArgs fxaa311Args(const Params& p);
LumaKind fxaa311Luma(const Params& p);
Fxaa1Args fxaa1Args(const Params& p);
FxaaCsArgs fxaaCsArgs(const Params& p);
FxaaConsoleArgs fxaaConsoleArgs(const Params& p);

// A luma plane with the border that searches need.
class SearchedLuma {
  public:
    SearchedLuma() = default;
    SearchedLuma(int width, int height)
        : width_(width),
          height_(height),
          stride_((width + 15) / 16 * 16 + 2 * kFxaaBorder),
          data_(unsetSamples<float>(size_t(stride_) * size_t(height + 2 * kFxaaBorder))) {}
    bool empty() const { return data_.empty(); }
    float* row(int y) { return data_.data() + ptrdiff_t(y + kFxaaBorder) * stride_ + kFxaaBorder; }
    int stride() const { return stride_; }
    size_t bytes() const { return data_.size() * sizeof(float); }
    void repeatBorder() {  // one row above and below: searches look one pixel across their line
        for (int y = 0; y < height_; y++) {
            float* const r = row(y);
            std::fill(r - kFxaaBorder, r, r[0]);
            std::fill(r + width_, r - kFxaaBorder + stride_, r[width_ - 1]);
        }
        std::copy_n(row(0) - kFxaaBorder, stride_, row(-1) - kFxaaBorder);
        std::copy_n(row(height_ - 1) - kFxaaBorder, stride_, row(height_) - kFxaaBorder);
    }

  private:
    int width_ = 0, height_ = 0, stride_ = 0;
    Samples<float> data_;
};

// What every variant works with: the luma plane and, on request, what it found at each edge pixel.
class FxaaMethod : public Method {
  public:
    size_t stateBytes() const override { return luma_.bytes() + transposed_.bytes(); }
    std::vector<DebugLayer> debugLayers() const override {
        if (!keepDebugLayers) return {};
        // Gold: horizontal; blue: vertical [Lottes 2009].
        std::vector<PlaneF> colour(3, PlaneF(orientation_.width(), orientation_.height()));
        for (int y = 0; y < orientation_.height(); y++)
            for (int x = 0; x < orientation_.width(); x++) {
                const bool horizontal = orientation_.at(x, y) == 1, vertical = orientation_.at(x, y) == 2;
                colour[0].at(x, y) = horizontal ? 1.0f : 0.0f;
                colour[1].at(x, y) = horizontal ? 0.84f : 0.0f;
                colour[2].at(x, y) = vertical ? 1.0f : 0.0f;
            }
        return {{"edges", std::move(colour)}, {"search", {negativePx_, positivePx_, shiftPx_}}};
    }

  protected:
    // A frame's planes, until they go.
    struct Lumas {
        Working<SearchedLuma>::Taken ofRows, ofColumns;
    };
    Lumas findLuma(const Rgb& color, LumaKind kind, const Exec& exec) {
        Lumas lumas{luma_.take(), transposed_.take()};
        SearchedLuma& luma = *lumas.ofRows = SearchedLuma(color.width(), color.height());
        const LumaArgs args{view(color), luma.row(0), color.stride(), luma.stride(), color.width(), kind};
        runKernel(lumaKernelsFor(exec).luma, exec, args, color.height());
        luma.repeatBorder();
        return lumas;
    }
    // The plane for searches along columns, which then read along rows as well.
    static void transposeLuma(const Lumas& lumas, int width, int height, const Exec& exec) {
        SearchedLuma &from = *lumas.ofRows, &to = *lumas.ofColumns = SearchedLuma(height, width);
        const FxaaTransposeArgs args{from.row(0), to.row(0), from.stride(), to.stride(), height};
        runKernel(fxaaKernelsFor(exec).transpose, exec, args, (width + 15) / 16);
        to.repeatBorder();
    }
    // Points `args` at this frame's planes.
    void prepare(FxaaArgs& args, const Lumas& lumas, const Rgb& filtered, Rgb& out) {
        SearchedLuma &rows = *lumas.ofRows, &columns = *lumas.ofColumns;
        args.luma = rows.row(0);
        args.lumaStride = rows.stride();
        args.transposedLuma = columns.empty() ? nullptr : columns.row(0);
        args.transposedStride = columns.stride();
        args.in = view(filtered);
        args.out = view(out);
        args.stride = filtered.stride();
        args.width = filtered.width();
        args.height = filtered.height();
        if (keepDebugLayers) {
            for (PlaneF* p : {&orientation_, &negativePx_, &positivePx_, &shiftPx_})
                *p = PlaneF(filtered.width(), filtered.height());
            args.orientation = orientation_.row(0);
            args.negativePx = negativePx_.row(0);
            args.positivePx = positivePx_.row(0);
            args.shiftPx = shiftPx_.row(0);
        }
    }
    PlaneF orientation_, negativePx_, positivePx_, shiftPx_;

  private:
    Working<SearchedLuma> luma_, transposed_;
};

}  // namespace aa
