#include "methods/spatial/smaa.h"

#include <algorithm>

#include "image/colour.h"
#include "methods/spatial/smaa_areas.h"

namespace aa {

namespace {
constexpr Choice<SmaaEdges> kEdges[] = {
    {"luma", SmaaEdges::luma}, {"colour", SmaaEdges::colour}, {"depth", SmaaEdges::depth}};
constexpr Choice<SmaaPredication> kPredications[] = {
    {"off", SmaaPredication::off}, {"depth", SmaaPredication::depth}, {"object", SmaaPredication::object}};
struct Preset {
    std::string_view name;
    float threshold;
    int searchSteps, diagonalSteps;
    float cornerRounding;  // percent; negative: off
};
const Preset kSmaaPresets[] = {{"LOW", 0.15f, 4, 0, -1},  // [Jimenez 2012, v2.8]
                               {"MEDIUM", 0.10f, 8, 0, -1},
                               {"HIGH", 0.10f, 16, 8, 25},
                               {"ULTRA", 0.05f, 32, 16, 25}};
Preset chosen(const Params& p) {
    for (const auto& preset : kSmaaPresets)
        if (p.choice("preset") == preset.name) return preset;
    return {"custom", p.realf("threshold"), p.integer("searchSteps"), p.integer("diagonalSteps"),
            p.realf("cornerRounding")};
}
}  // namespace

SmaaSettings smaaSettings(const Params& p) {
    const Preset preset = chosen(p);
    SmaaSettings s;
    s.edge.kind = p.chosen("edges", kEdges);
    s.edge.predication = p.chosen("predication", kPredications);
    s.edge.consistent = p.choice("colourContrast") == "consistent";
    s.edge.threshold = s.edge.kind == SmaaEdges::depth ? p.realf("depthThreshold") : preset.threshold;
    s.edge.localContrast = p.realf("localContrast");
    s.edge.predicationThreshold = p.realf("predicationThreshold");
    s.edge.predicationScale = p.realf("predicationScale");
    s.edge.predicationStrength = p.realf("predicationStrength");
    s.blend.searchSteps = preset.searchSteps;
    s.blend.diagonalSteps = preset.diagonalSteps;
    s.blend.cornerRounding = preset.cornerRounding < 0 ? -1 : preset.cornerRounding / 100;
    s.blend.unorm8 = p.choice("weights") == "unorm8";
    s.published = p.choice("areas") == "table";
    return s;
}

Smaa::Smaa(const Params& p) {
    const SmaaSettings s = smaaSettings(p);
    edge_ = s.edge, blend_ = s.blend, published_ = s.published;
    border_ = std::max(2 * blend_.searchSteps, blend_.diagonalSteps) + 4;
    static_assert(kMaxDiagonal + 2 < kBitRows);
}

// Rows that are computed together: what they need of their neighbours is a few rows more, computed twice.
constexpr int kBlockRows = 32;

// Exact areas come from a table where it stays in the second-level cache: 0.5 MB at ULTRA's 32 steps.
constexpr int kMostTabled = 32;

const Smaa::Tables& Smaa::tablesFor(glm::dvec2 samplePx) {
    const auto found =
        std::find_if(tables_.begin(), tables_.end(), [&](const Tables& t) { return t.samplePx == samplePx; });
    if (found != tables_.end()) {
        tables_.splice(tables_.end(), tables_, found);
        return tables_.back();
    }
    Tables t;
    t.samplePx = samplePx;
    if (published_) {
        t.orthogonal[0] = orthogonalTable(-samplePx.y);
        t.orthogonal[1] = orthogonalTable(-samplePx.x);
    } else if (blend_.searchSteps <= kMostTabled) {
        t.orthogonal[0] = exactTable(double(-float(samplePx.y)), 2 * blend_.searchSteps);
        if (samplePx.x != samplePx.y) t.orthogonal[1] = exactTable(double(-float(samplePx.x)), 2 * blend_.searchSteps);
    }
    if (blend_.diagonalSteps > 0)
        for (const bool falling : {false, true})
            t.diagonal[falling] = diagonalTableAt({samplePx.x, samplePx.y}, falling, published_);
    if (tables_.size() == 64) tables_.pop_front();  // jitter without a period
    tables_.push_back(std::move(t));
    return tables_.back();
}

void Smaa::findEdges(const Frame& frame, const Rgb& colorEncoded, glm::dvec2 samplePx, const Exec& exec, size_t image) {
    findEdges(frame, &colorEncoded, false, samplePx, exec, edges_[image]);
}
void Smaa::findEdgesOfLinear(const Frame& frame, const Rgb& colorLinear, glm::dvec2 samplePx, const Exec& exec,
                             size_t image) {
    const bool colour = edge_.kind == SmaaEdges::colour;
    if (colour) encode(colorLinear, frame.display, exec, encoded_);
    findEdges(frame, colour ? &encoded_ : &colorLinear, !colour, samplePx, exec, edges_[image]);
}
void Smaa::findEdges(const Frame& frame, const Rgb* color, bool encodes, glm::dvec2 samplePx, const Exec& exec,
                     Edges& edges) {
    width_ = color->width(), height_ = color->height();
    edges.samplePx = samplePx;
    edges.top.resize(width_, height_, border_);
    edges.left.resize(width_, height_, border_);
    edges.topByColumn.resize(height_, width_, border_);
    edges.leftByColumn.resize(height_, width_, border_);
    SmaaEdgeArgs all = edge_;
    all.color = view(*color);
    all.encodes = encodes, all.display = displayArgs(frame.display);
    if (all.kind == SmaaEdges::depth || all.predication == SmaaPredication::depth)
        all.depthView = frame.depthView.row(0);
    if (all.predication == SmaaPredication::object) all.objectId = frame.objectId.row(0);
    all.top = edges.top.row(0);
    all.left = edges.left.row(0);
    all.stride = paddedStride(width_);
    all.bitStride = edges.top.stride();
    all.width = width_, all.height = height_;
    const auto& kernels = smaaKernelsFor(exec);
    const auto fn = rowsOf(kernels.edges, exec.precision);
    Scratch scratch(kSmaaEdgeScratchRows, all.stride);
    forRows(
        exec, height_,
        [&](int y0, int y1) {
            SmaaEdgeArgs args = all;
            args.scratch = scratch.local();
            fn(args, y0, y1);
        },
        kBlockRows);
    for (auto [from, to] : {std::pair{&edges.top, &edges.topByColumn}, std::pair{&edges.left, &edges.leftByColumn}}) {
        from->repeatBorder();
        runKernel(kernels.transpose, exec,
                  SmaaTransposeArgs{from->row(0), to->row(0), from->stride(), to->stride(), height_}, (width_ + 7) / 8);
        to->repeatBorder();
    }
}

SmaaImage Smaa::imageOf(Edges& e) {
    if (keepDebugLayers) {
        const size_t pixels = size_t(width_) * size_t(height_);
        for (auto* plane : {&e.topWeights, &e.leftWeights, &e.topLengths, &e.leftLengths}) plane->assign(2 * pixels, 0);
        e.isDiagonal.assign(pixels, 0);
    }
    const Tables& tables = tablesFor(e.samplePx);
    SmaaImage image{};
    for (size_t k = 0; k < 2; k++) image.diagonalTable[k] = tables.diagonal[k].data();
    const auto debug = [&](std::vector<float>& plane) { return keepDebugLayers ? plane.data() : nullptr; };
    const auto axis = [&](const BitPlane& along, const BitPlane& cross, const BitPlane& crossTransposed,
                          double samplePx, const std::vector<float>& table, std::vector<float>& weights,
                          std::vector<float>& lengths) {
        const bool exact = !published_ && !table.empty();
        return SmaaAxis{along.row(0),
                        cross.row(0),
                        crossTransposed.row(0),
                        along.stride(),
                        crossTransposed.stride(),
                        crossTransposed.rows(),
                        -float(samplePx),
                        published_ ? table.data() : nullptr,
                        exact ? table.data() : nullptr,
                        debug(weights),
                        debug(lengths)};
    };
    const bool oneTable = tables.orthogonal[1].empty();
    image.top = axis(e.top, e.left, e.leftByColumn, e.samplePx.y, tables.orthogonal[0], e.topWeights, e.topLengths);
    image.left = axis(e.leftByColumn, e.topByColumn, e.top, e.samplePx.x, tables.orthogonal[oneTable ? 0 : 1],
                      e.leftWeights, e.leftLengths);
    image.isDiagonal = keepDebugLayers ? e.isDiagonal.data() : nullptr;
    return image;
}
void Smaa::blend(std::span<const Rgb* const> images, Rgb& out, const Exec& exec, const std::optional<Motion>& motion,
                 const RowsDone& done) {
    SmaaBlendArgs all = blend_;
    all.images = int(images.size());
    for (size_t k = 0; k < images.size(); k++) {
        all.image[k] = imageOf(edges_[k]);
        all.image[k].color = view(*images[k]);
    }
    for (size_t c = 0; c < 3; c++) all.out[c] = out.c[c].row(0);
    for (size_t c = 0; motion && c < 2; c++)
        all.motion[c] = motion->in[c]->row(0), all.out[3 + c] = motion->out[c]->row(0);
    all.channels = motion ? kSmaaChannels : 3;
    all.stride = images[0]->stride();
    all.width = width_;
    all.height = height_;
    const auto fn = rowsOf(smaaBlendKernelsFor(exec).blend, exec.precision);
    Scratch scratch(kSmaaBlendScratchRows, all.stride);
    forRows(
        exec, height_,
        [&](int begin, int end) {
            SmaaBlendArgs args = all;
            args.scratch = scratch.local();
            for (int y0 = begin; y0 < end; y0 += kBlockRows) {
                const int y1 = std::min(y0 + kBlockRows, end);
                fn(args, y0, y1);
                if (done) done(y0, y1);
            }
        },
        kBlockRows);
}

size_t Smaa::bytes() const {
    size_t tables = 0, planes = 0;
    for (const auto& t : tables_)
        for (const auto* v : {&t.orthogonal[0], &t.orthogonal[1], &t.diagonal[0], &t.diagonal[1]}) tables += v->size();
    for (const Edges& e : edges_)
        planes += e.top.bytes() + e.left.bytes() + e.topByColumn.bytes() + e.leftByColumn.bytes();
    return encoded_.bytes() + planes + tables * sizeof(float);
}

std::vector<DebugLayer> Smaa::debugLayers(size_t image) const {
    if (!keepDebugLayers) return {};
    const Edges& e = edges_[image];
    DebugLayer edges{"edges", std::vector<PlaneF>(3, PlaneF(width_, height_))};  // left, top, diagonal
    DebugLayer top = {"weights.top", edges.planes}, left = {"weights.left", edges.planes};
    DebugLayer topSearch = {"search.top", edges.planes}, leftSearch = {"search.left", edges.planes};
    for (int y = 0; y < height_; y++)
        for (int x = 0; x < width_; x++) {
            const size_t pixel = size_t(y) * size_t(width_) + size_t(x);
            edges.planes[0].at(x, y) = e.left.at(x, y);
            edges.planes[1].at(x, y) = e.top.at(x, y);
            edges.planes[2].at(x, y) = e.isDiagonal[pixel];
            for (size_t i = 0; i < 2; i++) {  // own, opposite; distance to either end, px
                top.planes[i].at(x, y) = e.topWeights[2 * pixel + i];
                topSearch.planes[i].at(x, y) = e.topLengths[2 * pixel + i];
                left.planes[i].at(x, y) = e.leftWeights[2 * pixel + i];
                leftSearch.planes[i].at(x, y) = e.leftLengths[2 * pixel + i];
            }
        }
    return {edges, top, left, topSearch, leftSearch};
}

std::vector<ParamSpec> smaaParams() {
    return {
        choiceParam("preset", "HIGH", {"LOW", "MEDIUM", "HIGH", "ULTRA", "custom"},
                    "threshold, search lengths, diagonals and corners", "[Jimenez 2012, v2.8]"),
        realParam("threshold", "0.1", 0.0009765625, 0.5, "luma or colour difference that makes an edge",
                  "[Jimenez 2012, v2.8]", "preset=custom"),
        intParam("searchSteps", "16", 1, 112, "search length to either side, in steps of 2 px", "[Jimenez 2012, v2.8]",
                 "preset=custom"),
        intParam("diagonalSteps", "8", 0, kMaxDiagonal, "diagonal search length in px, 0 off", "[Jimenez 2012, v2.8]",
                 "preset=custom"),
        realParam("cornerRounding", "25", -1, 100, "how much sharp corners are rounded, percent; -1 off",
                  "[Jimenez 2012, v2.8]", "preset=custom"),
        choiceParam("edges", "luma", kEdges, "what makes an edge", "[Jimenez 2012, v2.8]"),
        realParam("depthThreshold", "0.01", 0.0009765625, 1, "relative depth difference that makes an edge",
                  "ours: the shader compares device depth", "edges=depth"),
        realParam("localContrast", "2", 1, 1000, "an edge goes where a neighbouring edge is this many times as strong",
                  "[Jimenez 2012, v2.8]", "edges=luma|colour"),
        choiceParam("colourContrast", "reference", {"reference", "consistent"},
                    "second neighbour of colour edges: against the centre as in the shader, or against the first",
                    "decisions 39", "edges=colour"),
        choiceParam("predication", "off", kPredications, "raise the threshold where this pass has no edge",
                    "[Jimenez 2012, v2.8]", "edges=luma|colour"),
        realParam("predicationThreshold", "0.01", 0, 1, "relative depth difference that is an edge of that pass",
                  "[Jimenez 2012, v2.8]", "predication=depth"),
        realParam("predicationScale", "2", 1, 5, "factor on the threshold", "[Jimenez 2012, v2.8]",
                  "predication=depth|object"),
        realParam("predicationStrength", "0.4", 0, 1, "share taken off again at edges of that pass",
                  "[Jimenez 2012, v2.8]", "predication=depth|object"),
        choiceParam("blendSpace", "linear", {"linear", "encoded"}, "space in which pixels are blended",
                    "[Jimenez 2012, v2.8], sRGB reads"),
        choiceParam("areas", "analytic", {"analytic", "table"},
                    "weights exact, or looked up in the 8-bit area table as the shader does", "[Jimenez 2012]"),
        choiceParam("weights", "float", {"float", "unorm8"}, "storage of the blending weights",
                    "ours; unorm8: [Jimenez 2012, v2.8]"),
    };
}

PassSet smaaPasses(const Params& p) {
    PassSet passes;
    if (p.choice("edges") == "depth" || p.choice("predication") == "depth") passes |= Pass::depth;
    if (p.choice("predication") == "object") passes |= Pass::object;
    return passes;
}

namespace {
class Smaa1x : public Method {
  public:
    explicit Smaa1x(const Params& p) : smaa_(p), linear_(p.choice("blendSpace") == "linear") {}
    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        smaa_.keepDebugLayers = keepDebugLayers;
        smaa_.findEdges(frame, frame.colorEncoded, {0, 0}, exec);
        const Rgb* const images[] = {linear_ ? &frame.colorLinear : &frame.colorEncoded};
        smaa_.blend(images, out, exec);
    }
    size_t stateBytes() const override { return smaa_.bytes(); }
    std::vector<DebugLayer> debugLayers() const override { return smaa_.debugLayers(); }

  private:
    Smaa smaa_;
    bool linear_;
};
}  // namespace

MethodDescriptor smaa1xDescriptor() {
    return {.id = "smaa1x",
            .title = "SMAA 1x",
            .family = "spatial",
            .summary = "Revectorises edges from their length and crossing edges, with diagonals and corners.",
            .source = "[Jimenez 2012, v2.8]",
            .passes = Pass::color,
            .input = Space::encoded,
            .output = Space::linear,
            .params = smaaParams(),
            .create = [](const Params& p, const ShotInfo&) { return std::make_unique<Smaa1x>(p); },
            .morePasses = smaaPasses,
            .outputSpace =
                [](const Params& p) { return p.choice("blendSpace") == "linear" ? Space::linear : Space::encoded; },
            .reachPx = 66};  // conventions 12; preset=custom reaches 2 * searchSteps + 2
}

}  // namespace aa
