#include "methods/temporal/asaa.h"

#include <utility>

#include "methods/method.h"
#include "methods/temporal/temporal.h"
#include "methods/working.h"

namespace aa {
namespace {

class Asaa : public Method {
  public:
    explicit Asaa(const Params& params) : params_(params) {}

    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        history_.begin(frame, "asaa");

        const size_t quadrant = asaaQuadrant(frame.jitterPx);
        const glm::vec2 phi = asaaOffsetPx(quadrant);
        AsaaArgs args{};
        args.in = temporal::frameView(frame, frame.colorEncoded);
        const auto unjittered = unjittered_.take();
        if (params_.flag("unjitter")) {  // to where the quadrant's buffer has its samples
            temporal::unjitter(frame.colorEncoded, frame.jitterPx - glm::dvec2(phi), exec, *unjittered);
            args.in.color = view(std::as_const(*unjittered));
        }
        args.in.out = view(out);
        args.in.next = buffers_.next(quadrant).row(0);
        args.lastFrame = cameraPath(frame, frame.previousCamera ? &*frame.previousCamera : nullptr);
        for (size_t i = 0; i < 4; i++) {
            const RgbaPlane& image = buffers_.previous(i);
            if (!buffers_.filled(i)) continue;
            args.anyHistory = true;
            const Camera* camera = cameras_[i] ? &*cameras_[i] : nullptr;
            const glm::vec2 offset = asaaOffsetPx(i);
            args.buffer[i] = {image.row(0), offset.x, offset.y, float(buffers_.age(i)), cameraPath(frame, camera), {}};
            if (camera) args.buffer[i].expected = expectedDepth(frame, *camera);
        }
        args.phiX = phi.x, args.phiY = phi.y;
        args.previousCount = count_.previous().row(0);
        args.nextCount = count_.next().row(0);
        args.eq331 = params_.choice("blurMode") == "eq331";
        args.fourInMotion = params_.choice("motionCount") == "four";
        args.countAtPixel = !args.eq331 && temporal::countAtPixel(params_);
        args.rejection = temporal::rejectionTest(params_);
        args.in.debug = debug_.begin(*this, frame.width, frame.height);
        runKernel(asaaKernelsFor(exec).resolve, exec, args, frame.height);
        cameras_[quadrant] = frame.camera;
        history_.end();
    }
    size_t stateBytes() const override { return history_.bytes() + unjittered_.bytes(); }
    const PlaneF* rejection() const override { return debug_.rejection(); }
    std::vector<DebugLayer> debugLayers() const override {
        std::vector<DebugLayer> layers = debug_.layers();
        if (!layers.empty()) layers.push_back({"sampleCount", {count_.latest()}});
        return layers;
    }

  private:
    Params params_;
    History history_;
    Kept<RgbaPlane> buffers_{history_, 4};
    Kept<PlaneF> count_{history_};
    std::optional<Camera> cameras_[4];  // of the frames that wrote the buffers
    Working<Rgb> unjittered_;
    TemporalDebugLayers debug_;
};
}  // namespace

// (-.25, -.25), (-.25, .25), (.25, -.25), (.25, .25)
size_t asaaQuadrant(glm::dvec2 jitterPx) { return size_t(jitterPx.x >= 0) * 2 + size_t(jitterPx.y >= 0); }
glm::vec2 asaaOffsetPx(size_t quadrant) { return {quadrant & 2 ? 0.25f : -0.25f, quadrant & 1 ? 0.25f : -0.25f}; }
CameraPath cameraPath(const Frame& frame, const Camera* other) {
    CameraPath path;
    const auto rays = viewRays(frame);
    if (!rays || !other || other->kind != frame.camera->kind) return path;
    path.moves = other->view != frame.camera->view || other->projection != frame.camera->projection;
    glm::dmat4 m = other->projection * other->view * glm::inverse(frame.camera->view);
    for (int i = 0; i < 4; i++) {  // jittered as this frame: a sample at p + jitter that did not move then lies at p
        m[i][0] -= 2 * frame.jitterPx.x / frame.width * m[i][3];
        m[i][1] += 2 * frame.jitterPx.y / frame.height * m[i][3];
    }
    const int rows[3] = {0, 1, 3};
    for (int r = 0; r < 3; r++) {
        const int i = rows[r];
        const glm::dvec3 d = m[0][i] * rays->perDepth[0] + m[1][i] * rays->perDepth[1] - glm::dvec3(0, 0, m[2][i]);
        const glm::dvec3 c = m[0][i] * rays->constant[0] + m[1][i] * rays->constant[1] + glm::dvec3(0, 0, m[3][i]);
        for (int k = 0; k < 3; k++) path.perDepth[r][k] = float(d[k]), path.constant[r][k] = float(c[k]);
    }
    return path;
}

MethodDescriptor asaaDescriptor() {
    return {
        .id = "asaa",
        .title = "Amortized supersampling",
        .family = "temporal",
        .summary = "Four sub-pixel buffers followed through camera and object motion, summed with tent weights.",
        .source = "[Yang 2009]; [Stejmar n.d., 3.8 and 4.4.1]",
        .passes = Pass::color | Pass::depth | Pass::motion,
        .input = Space::encoded,
        .output = Space::encoded,
        .temporal = true,
        .params = {temporal::unjitterParam(false, "conventions 7.0: by the normally distributed part of the jitter"),
                   choiceParam("blurMode", "thesis", {"thesis", "eq331"},
                               "limit of blur in motion: 4 samples, or eq 3.31 with the threshold 0.12 above the "
                               "filter's variance and the sample count of eq 3.29",
                               "decisions 23"),
                   choiceParam("motionCount", "atMost", {"atMost", "four"},
                               "sample count of a moving pixel: at most 4 as the text says, or 4 as its listing "
                               "4.11 sets it",
                               "[Stejmar n.d., 4.4.1]", "blurMode=thesis"),
                   temporal::countAtParam(
                       "[Stejmar n.d., 4.4.1]; eq331 reads it where the surface was, as eq 3.29 does",
                       "blurMode=thesis"),
                   temporal::depthToleranceParam(), temporal::bothSidesParam(),
                   temporal::magnificationParam("1", "[Stejmar n.d., figures 4.10 and 4.11]; decisions 18")},
        .create = [](const Params& p, const ShotInfo&) { return std::make_unique<Asaa>(p); },
        .publishedMemory = {{0, 86.5, "[Stejmar n.d., table 5.6]"}}};
}
}  // namespace aa
