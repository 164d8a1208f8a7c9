// A method's GPU form: the same parameters, the same frames and the same state as its CPU form, with its images on the
// device. A form declares the images that it keeps, records its shaders' dispatches, and leaves everything else here.
#pragma once
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>

#include "gpu/device.h"
#include "methods/spec.h"

namespace aa::gpu {

// What an engine would store, measured: exact keeps every image in 32 bits and filters in the shader, as the CPU form
// does; fast keeps colours and histories in 16 bits and lets the texture unit filter.
enum class Precision { exact, fast };

struct Settings {
    std::string device;  // "vulkan", "vulkan:N", "vulkan:NAME"
    Precision precision = Precision::exact;
    bool validate = false;
    std::filesystem::path shaders = {};  // as DeviceOptions::shaders
};

// The passes of one frame as images, each uploaded when it is first asked for. Colours have alpha 1.
enum class Input {
    colour,
    encoded,
    albedoEncoded,  // RGBA 32F, fast: 16F
    depth,          // R32F, planar view z
    normal,         // RGBA 32F, world, unit
    objectId,
    mask,    // R32UI
    motion,  // RG 32F, fast: 16F; px, y down, current - previous
    edges,   // RG 32F, px
    subColour,
    subEncoded,
    subNormal,
    subDepth,
    subId,  // the same, one layer per sub-sample
};
class Session;
class Inputs {
  public:
    explicit Inputs(const Session& session) : session_(session) {}
    void begin(const Frame& frame) { frame_ = &frame, current_.clear(); }
    void end() { frame_ = nullptr, current_.clear(); }
    const Frame* frame() const { return frame_; }  // null: none
    const std::set<Input>& uploaded() const { return current_; }
    bool offers(Input which) const;  // whether the frame has the pass
    // Throws std::logic_error where the frame lacks the pass.
    const Image& get(Input which, Recorder& recorder);

  private:
    const Session& session_;
    const Frame* frame_ = nullptr;
    std::map<Input, Image> images_;
    std::set<Input> current_;
};

// A device in use: shared by all methods of a run, so that each frame is uploaded once.
class Session {
  public:
    explicit Session(const Settings& settings);
    ~Session();
    const Device& device() const { return device_; }
    bool fast() const { return settings_.precision == Precision::fast; }
    // Formats of images that a method makes: colours and histories, and values that no engine keeps in 16 bits (depth,
    // counts, weights).
    Format colour() const { return fast() ? Format::rgba16f : Format::rgba32f; }
    static constexpr Format value = Format::r32f;

    // A frame that several methods will resolve, uploaded once: what they asked of the frames before at once, while the
    // device works on them, the rest when it is asked for. It must not change until forget() or kShared more of these
    // calls. `changed` false: it is the frame that was shared from this address before.
    void share(const Frame& frame, bool changed = true);
    void forget();
    static constexpr size_t kShared = 4;  // this frame and the next, each with its centre-sampled one
    // The shared frame's images; null where `frame` is not shared.
    Inputs* shared(const Frame& frame);

  private:
    Settings settings_;
    Device device_;
    std::array<std::unique_ptr<Inputs>, kShared> inputs_;  // the latest first
    std::set<Input> asked_;                                // of frames that are done
    std::mutex mutex_;
    Recorder uploads_;
};

// What record() sees of its frame.
class Current {
  public:
    Current(Inputs& inputs, Recorder& recorder) : inputs_(inputs), recorder_(recorder) {}
    const Frame& frame() const { return *inputs_.frame(); }
    int width() const { return frame().width; }
    int height() const { return frame().height; }
    const Image& operator[](Input which) { return inputs_.get(which, recorder_); }
    Recorder& recorder() { return recorder_; }

  private:
    Inputs& inputs_;
    Recorder& recorder_;
};

// What runs on a method's output while it is still on the device, and is never fed back: gpu/stages.h.
class DeviceStage {
  public:
    virtual ~DeviceStage() = default;
    // Records what makes `image`, RGBA in the method's output space, to what is shown: an image of the stage's own.
    // `rejection`: where the method did not use its history; null: it keeps none.
    virtual const Image& record(Current& current, const Image& image, const Image* rejection) = 0;
    virtual bool needsRejection() const { return false; }
    virtual size_t stateBytes() const = 0;
};

class GpuMethod : public Method {
  public:
    GpuMethod(Session& session, const Params& params)
        : session_(session), params_(params), recorder_(session.device()), own_(session) {}

    // Before the first frame.
    void addStage(std::unique_ptr<DeviceStage> stage);
    // Records everything that makes `out`, RGBA in the method's output space, of this frame.
    virtual void record(Current& current, Image& out) = 0;

    void resolve(const Frame& frame, const Exec& exec, Rgb& out) final;
    const std::vector<PassTime>& run(const Frame& frame);  // the same, with the picture left on the device
    size_t stateBytes() const final;
    const PlaneF* rejection() const final { return rejection_.empty() ? nullptr : &rejection_; }
    std::optional<double> deviceSeconds() const final;

  protected:
    // Where history was not used (Rejection), R32F; written by methods that have one when keepRejection is set.
    virtual const Image* rejectionImage() const { return nullptr; }
    // After record(): the image that is shown, where it is another than `out`.
    virtual const Image* shownImage() const { return nullptr; }

    const Params& params() const { return params_; }
    Session& session() const { return session_; }
    // An image of this size that the method keeps; made anew, of zeros, where it has another.
    Image& fitted(Image& image, int width, int height, Format format, int layers = 0);
    Buffer& fitted(Buffer& buffer, size_t bytes);

  private:
    const Image& recordFrame(const Frame& frame);  // what is shown
    Session& session_;
    Params params_;
    Recorder recorder_;
    Inputs own_;  // of frames that are not shared
    Image out_;
    std::vector<std::unique_ptr<DeviceStage>> stages_;
    PlaneF rejection_;
    size_t bytes_ = 0;
};

// Two images in turn: what the last frame left and what this one writes.
struct TwoImages {
    Image images[2];
    int now = 0;
    Image& next() { return images[now]; }
    Image& previous() { return images[1 - now]; }
    void swap() { now = 1 - now; }
};

// The GPU form of a method with its stages. Throws UsageError where the method has none (named), and what its CPU form
// throws for the shot.
std::unique_ptr<Method> create(Session& session, const MethodSpec& spec, const ShotInfo& shot);
bool hasForm(std::string_view id);

}  // namespace aa::gpu
