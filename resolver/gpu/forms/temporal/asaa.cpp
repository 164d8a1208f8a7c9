#include "methods/temporal/asaa.h"

#include <algorithm>

#include "gpu/forms.h"
#include "gpu/forms/temporal/temporal_form.h"
#include "methods/temporal/temporal.h"

namespace aa::gpu {
namespace {

// Followed in asaa.comp.
struct Path {
    float perDepth[3][4] = {}, constant[3][4] = {};
    Path() = default;
    explicit Path(const CameraPath& path) {
        for (int r = 0; r < 3; r++)
            for (int i = 0; i < 3; i++) perDepth[r][i] = path.perDepth[r][i], constant[r][i] = path.constant[r][i];
    }
};
struct Quadrant {
    Path path;
    float expectedPerDepth[4] = {}, expectedConstant[4] = {};
    float phiX = 0, phiY = 0, age = 1;
    int32_t layer = -1;
    uint32_t pathMoves = 0, depthKnown = 0;
    uint32_t padding[2] = {};
};
struct Followed {
    Quadrant quadrants[4];
    Path lastFrame;
    float phiX, phiY;
    int32_t nextLayer;
    uint32_t lastFrameMoves;
};
static_assert(sizeof(Quadrant) == 160 && sizeof(Followed) == 752);

// Its histories are four buffers, not the last frame's blend: not a TemporalForm.
class AsaaForm : public GpuMethod {
  public:
    using GpuMethod::GpuMethod;

  private:
    void record(Current& current, Image& out) override {
        const Frame& frame = current.frame();
        const int width = frame.width, height = frame.height;
        history_.begin(frame, "asaa");
        if (history_.fresh()) std::fill(std::begin(writtenIn_), std::end(writtenIn_), -1);
        if (shader_.name().empty()) shader_ = Shader("temporal/asaa", constants());
        fitted(buffers_, width, height, session().colour(), 5);
        fitted(depths_, width, height, Session::value, 5);
        for (Image& image : count_.images) fitted(image, width, height, Session::value);
        fitted(rejection_, keepRejection ? width : 1, keepRejection ? height : 1, Session::value);

        const size_t quadrant = asaaQuadrant(frame.jitterPx);
        const glm::vec2 phi = asaaOffsetPx(quadrant);
        TemporalPush push{};
        push.width = width, push.height = height;
        push.feedbackCeiling = 1;
        push.firstFrame = history_.fresh();
        push.frameNumber = uint32_t(frame.number);
        if (params().flag("unjitter")) {  // to where the quadrant's buffer has its samples
            const glm::dvec2 excess = frame.jitterPx - glm::dvec2(phi);
            push.readX = -float(excess.x), push.readY = -float(excess.y);
        }
        const Followed followed = follow(frame, phi);
        Recorder& recorder = current.recorder();
        recorder.upload(fitted(followed_, sizeof(Followed)), std::as_bytes(std::span(&followed, 1)));
        const Image& colour = current[Input::encoded];
        const Binding images[] = {read(colour),
                                  read(current[Input::motion]),
                                  read(current[Input::depth]),
                                  read(colour),
                                  written(out),
                                  written(out),
                                  written(rejection_),
                                  read(buffers_),
                                  read(depths_),
                                  written(buffers_),
                                  written(depths_),
                                  read(count_.previous()),
                                  written(count_.next()),
                                  memory(followed_)};
        recorder.dispatch(shader_, width, height, images, push);
        std::swap(layer_[quadrant], spare_);
        writtenIn_[quadrant] = history_.framesSinceReset();
        cameras_[quadrant] = frame.camera;
        count_.swap();
        history_.end();
    }
    std::vector<Constant> constants() const {
        const Params& p = params();
        const RejectionTest test = temporal::rejectionTest(p);
        const bool eq331 = p.choice("blurMode") == "eq331";
        return {{4, keepRejection},
                {10, eq331},
                {11, p.choice("motionCount") == "four"},
                {12, !eq331 && temporal::countAtPixel(p)},
                {13, test.depthTolerance},
                {14, test.magnification},
                {15, test.bothSides}};
    }
    Followed follow(const Frame& frame, glm::vec2 phi) const {
        Followed all{};
        for (size_t i = 0; i < 4; i++) {
            if (writtenIn_[i] < 0) continue;
            const Camera* camera = cameras_[i] ? &*cameras_[i] : nullptr;
            const CameraPath path = cameraPath(frame, camera);
            const ExpectedDepth depth = camera ? expectedDepth(frame, *camera) : ExpectedDepth{};
            Quadrant& q = all.quadrants[i];
            q.path = Path(path), q.pathMoves = path.moves, q.depthKnown = depth.known;
            std::copy_n(depth.perDepth, 3, q.expectedPerDepth);
            std::copy_n(depth.constant, 3, q.expectedConstant);
            q.phiX = asaaOffsetPx(i).x, q.phiY = asaaOffsetPx(i).y;
            q.age = float(history_.framesSinceReset() - writtenIn_[i]);
            q.layer = layer_[i];
        }
        const CameraPath last = cameraPath(frame, frame.previousCamera ? &*frame.previousCamera : nullptr);
        all.lastFrame = Path(last), all.lastFrameMoves = last.moves;
        all.phiX = phi.x, all.phiY = phi.y;
        all.nextLayer = spare_;
        return all;
    }
    const Image* rejectionImage() const override { return &rejection_; }

    History history_;  // counts frames and checks their size
    Shader shader_;
    Image buffers_, depths_, rejection_;  // the first two: five layers
    TwoImages count_;
    Buffer followed_;
    int layer_[4] = {0, 1, 2, 3}, spare_ = 4;
    int writtenIn_[4];                  // frames from the reset to the one that wrote the buffer; -1: none
    std::optional<Camera> cameras_[4];  // of the frames that wrote the buffers
};
}  // namespace

std::vector<Form> asaaForms() {
    return {{"asaa", [](Session& s, const Params& p, const ShotInfo&) -> std::unique_ptr<GpuMethod> {
                 return std::make_unique<AsaaForm>(s, p);
             }}};
}

}  // namespace aa::gpu
