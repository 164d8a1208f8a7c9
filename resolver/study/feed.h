// The frames of a run, ready for its methods: decoded, in the spaces that they read, and on the device where there is
// one. With a device the next frame is made ready and uploaded while the methods work on this one.
#pragma once
#include <functional>
#include <future>

#include "shot/frame_stream.h"

namespace aa {
namespace gpu {
class Session;
}

class Feed {
  public:
    // `prepare(i, frame)` of every frame in order, of a centre-sampled one once: i = -1. It may run on another thread.
    using Prepare = std::function<void(int index, Frame& frame)>;
    Feed(FrameStream& stream, Prepare prepare, gpu::Session* device);
    ~Feed();
    Feed(const Feed&) = delete;
    Feed& operator=(const Feed&) = delete;

    struct Item {
        std::shared_ptr<Frame> frame, centre;  // centre: null where none was wanted
        std::shared_ptr<const Truth> truth;
    };
    // The next frame; nothing after the last. What an earlier call returned must be done with.
    std::optional<Item> next();
    void stop();  // waits for what is being made ready

  private:
    std::optional<Item> make();
    FrameStream& stream_;
    Prepare prepare_;
    gpu::Session* device_;
    int index_ = 0;
    std::weak_ptr<Frame> centre_;  // of the last frame; shared by those of a static shot, and prepared once
    std::future<std::optional<Item>> upcoming_;
};

}  // namespace aa
