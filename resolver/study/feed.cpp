#include "study/feed.h"

#include "gpu/method.h"

namespace aa {

Feed::Feed(FrameStream& stream, Prepare prepare, gpu::Session* device)
    : stream_(stream), prepare_(std::move(prepare)), device_(device) {
    if (device_) upcoming_ = std::async(std::launch::async, [this] { return make(); });
}
Feed::~Feed() { stop(); }
void Feed::stop() {
    if (upcoming_.valid()) upcoming_.wait();
}

std::optional<Feed::Item> Feed::make() {
    auto frame = stream_.next();
    if (!frame) return {};
    Item item{std::make_shared<Frame>(std::move(*frame)), stream_.takeCentre(), stream_.takeTruth()};
    prepare_(index_++, *item.frame);
    const bool isNew = item.centre && item.centre != centre_.lock();
    if (isNew) prepare_(-1, *item.centre);
    if (device_ && item.centre) device_->share(*item.centre, isNew);
    if (device_) device_->share(*item.frame);
    centre_ = item.centre;
    return item;
}

std::optional<Feed::Item> Feed::next() {
    if (!device_) return make();
    if (!upcoming_.valid()) return {};
    auto item = upcoming_.get();
    if (item) upcoming_ = std::async(std::launch::async, [this] { return make(); });
    return item;
}

}  // namespace aa
