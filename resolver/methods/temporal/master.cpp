#include "methods/temporal/master.h"

#include <algorithm>
#include <array>

#include "methods/method.h"
#include "methods/temporal/temporal.h"

namespace aa {
namespace {

constexpr int kMasterRowsPerCall = 64;  // each computes nine rows of its neighbours again, partly

constexpr Choice<DepthUnit> kDepthUnits[] = {
    {"normalised", DepthUnit::normalised}, {"zfar", DepthUnit::zfar}, {"world", DepthUnit::world}};

class Master : public Method {
  public:
    explicit Master(const Params& params) : params_(params), sharpen_(temporal::sharpenKernel(params)) {}

    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        const Params& p = params_;
        TemporalIn in = temporal::frameView(frame, frame.colorEncoded);
        MasterArgs m{};
        m.depthOfTexel = in.depthView;
        m.objectId = frame.objectId.row(0);
        m.expected = expectedDepth(frame);
        if (p.flag("unjitter")) {
            const glm::ivec2 texel = temporal::unjitteredTexel(frame);
            m.texelX = texel.x, m.texelY = texel.y;
            temporal::unjitter(frame, in, m.expected, m.objectId);
        }
        if (sharpen_ == SharpenKernel::none) in.out = view(out);
        history_.begin(frame, "master", in);
        in.feedbackCeiling = temporal::feedbackCeiling(p, history_.framesSinceReset());
        in.dilation = temporal::dilation(p);
        in.filter = temporal::historyFilter(p);
        in.debug = debug_.begin(*this, frame.width, frame.height);
        m.in = in;
        m.albedoEncoded = view(frame.albedoEncoded);
        m.previousDepth = depth_.previous().row(0), m.keptDepth = depth_.next().row(0);
        m.weightAlbedo = p.realf("wU"), m.weightLit = p.realf("wL");
        m.depthUnit = masterDepthUnit(p);
        m.luminance = temporal::luminance(p);
        m.temporalSobel = p.flag("sobelTemporal");
        m.samePixelDepth = p.choice("pastDepth") == "samePixel";
        m.kMin = p.realf("kmin"), m.kMax = p.realf("kmax");
        m.farDepth = masterFarDepth(frame);
        m.depthThreshold = p.realf("depthThreshold");
        m.minAlias = p.realf("minAlias");
        m.clipTarget = temporal::clipTarget(p);
        m.relativeThreshold = p.flag("relativeThreshold");
        m.compensate = p.flag("compensate");
        m.useModel = p.flag("model"), m.useDepth = p.flag("depth"), m.useDepthTemporal = p.flag("depthTemporal");
        m.useSobel = p.flag("sobel");
        if (keepDebugLayers) {
            terms_.resize(5);
            for (auto& plane : terms_) fitted(plane, frame.width, frame.height);
            m.debugAliased = terms_[0].row(0), m.debugSobel = terms_[1].row(0), m.debugModel = terms_[2].row(0);
            m.debugDepth = terms_[3].row(0), m.debugDepthTemporal = terms_[4].row(0);
        }
        if (sharpen_ != SharpenKernel::none) {
            m.sharpened = view(out);
            m.sharpenGain = sharpenGain(sharpen_);
        }
        const std::vector<int> seams = run(m, exec);
        history_.end(temporal::historyStorage(p), exec);
        if (sharpen_ != SharpenKernel::none)
            for (int y : seams) sharpenEncodedRow(history_.latest(), sharpen_, exec, y, out);
    }
    size_t stateBytes() const override { return history_.bytes(); }
    const PlaneF* rejection() const override { return debug_.rejection(); }
    std::vector<DebugLayer> debugLayers() const override {
        std::vector<DebugLayer> layers = debug_.layers();
        const char* const names[] = {"aliasedValue", "sobelAverage", "modelAverage", "depthPseudoVariance",
                                     "depthTemporalPseudoVariance"};
        for (size_t i = 0; i < terms_.size(); i++) layers.push_back({names[i], {terms_[i]}});
        return layers;
    }

  private:
    // Returns the rows beside which another call ended, which are not yet sharpened.
    std::vector<int> run(const MasterArgs& all, const Exec& exec) {
        const auto fn = rowsOf(masterKernelsFor(exec).resolve, exec.precision);
        const int height = all.in.height;
        std::vector<uint8_t> seam(size_t(height), 0);
        Scratch scratch(kMasterScratchRows, all.in.stride);
        forRows(
            exec, height,
            [&](int y0, int y1) {
                MasterArgs m = all;
                m.scratch = scratch.local();
                fn(m, y0, y1);
                if (y0 > 0) seam[size_t(y0)] = 1;
                if (y1 < height) seam[size_t(y1 - 1)] = 1;
            },
            kMasterRowsPerCall);
        std::vector<int> rows;
        for (int y = 0; y < height; y++)
            if (seam[size_t(y)]) rows.push_back(y);
        return rows;
    }

    Params params_;
    SharpenKernel sharpen_;
    ColourHistory history_;
    Kept<PlaneF> depth_{history_};
    TemporalDebugLayers debug_;
    std::vector<PlaneF> terms_;
};
}  // namespace

float masterFarDepth(const Frame& frame) {
    static constexpr float kFar = 1e9f;
    if (frame.camera && frame.camera->farClip > 0) return float(frame.camera->farClip);
    // Several maxima side by side: one alone would wait for itself at every pixel.
    constexpr size_t kLanes = 16;
    std::array<float, kLanes> lanes{};
    for (int y = 0; y < frame.height; y++) {
        const float* row = frame.depthView.row(y);  // padded with its last value to a multiple of kLanes
        for (int x = 0; x < frame.width; x += int(kLanes))
            for (size_t i = 0; i < kLanes; i++) {
                const float z = row[x + int(i)];
                lanes[i] = z < kFar && z > lanes[i] ? z : lanes[i];
            }
    }
    const float farthest = *std::max_element(lanes.begin(), lanes.end());
    return farthest > 0 ? farthest : 1.0f;
}
DepthUnit masterDepthUnit(const Params& params) { return params.chosen("depthUnit", kDepthUnits); }

MethodDescriptor masterDescriptor() {
    return {
        .id = "master",
        .title = "Sobel-improved TAA",
        .family = "temporal",
        .summary =
            "Uncharted TAA whose colour box opens only where Sobel, depth and object ids say that a pixel is aliased.",
        .source = "[Oliveros 2018, 4.3]",
        .passes = Pass::color | Pass::albedo | Pass::depth | Pass::object | Pass::motion,
        .input = Space::encoded,
        .output = Space::encoded,
        .temporal = true,
        .params =
            {temporal::unjitterParam(true, "[Oliveros 2018, appendix B]; decisions 15"),
             temporal::kMinParam("0.925", "[Oliveros 2018, program]; decisions 5"),
             temporal::kMaxParam("0.979", "[Oliveros 2018, program]; decisions 5"),
             temporal::luminanceParam("quarter", "[Oliveros 2018, program]; decisions 9"),
             temporal::sharpenParam("norm", "[Oliveros 2018, eq 4.17]"),
             flagParam("model", true, "use the share of neighbours with another object id", "[Oliveros 2018, eq 4.1]"),
             flagParam("depth", true, "use the depth pseudo-variance", "[Oliveros 2018, eq 4.5]"),
             flagParam("depthTemporal", true, "use the temporal depth pseudo-variance", "[Oliveros 2018, eq 4.6]"),
             flagParam("sobel", true, "use the Sobel value", "[Oliveros 2018, eq 4.10]"),
             flagParam("sobelTemporal", true, "filter the Sobel value over time", "[Oliveros 2018, 4.3.3]", "sobel=on"),
             realParam("wU", "0.3", 0, 10, "weight of the albedo's Sobel magnitude", "[Oliveros 2018, eq 4.9]",
                       "sobel=on"),
             realParam("wL", "0.7", 0, 10, "weight of the lit colour's Sobel magnitude", "[Oliveros 2018, eq 4.9]",
                       "sobel=on"),
             choiceParam("depthUnit", "normalised", kDepthUnits,
                         "unit of all depths here: 2z/(z+far) in 0..1, z/far in 0..1, scene units",
                         "[Oliveros 2018, program]; decisions 8, 9"),
             realParam("depthThreshold", "0.002", 0, 1e6, "least depth difference that is an edge, in depthUnit",
                       "[Oliveros 2018, 4.3.2]"),
             flagParam("relativeThreshold", false, "depthThreshold times the mean depth, if that exceeds 1", "ours",
                       "depthUnit=world"),
             choiceParam("pastDepth", "samePixel", {"samePixel", "reprojected"},
                         "where the depth of the last frame is read", "[Oliveros 2018, program]; decisions 8",
                         "depthTemporal=on"),
             flagParam("compensate", false, "subtract the depth change that the camera alone makes",
                       "decisions 8 (recommended; off as printed)", "depthTemporal=on"),
             realParam("minAlias", "0", 0, 1, "floor of aliasedValue; 0 lets flat interiors keep the jitter", "ours"),
             temporal::clipTargetParam("aabbCentre", "decisions 6"),
             temporal::dilationParam("closest3x3", "[Oliveros 2018, 3.6.3]"),
             temporal::historyFilterParam("bilinear", "conventions 7.1"),
             temporal::historyClampParam(),
             temporal::warmupParam(),
             temporal::historyBitsParam(Space::encoded),
             temporal::ditherParam(Space::encoded)},
        .create = [](const Params& p, const ShotInfo&) {
            temporal::requireOrdered("master", p);
            return std::make_unique<Master>(p);
        }};
}
}  // namespace aa
