#include "image/trace.h"

#include "image/io.h"
#include "image/json_text.h"

namespace aa {

void Trace::add(const Span& span) {
    using Microseconds = std::chrono::duration<double, std::micro>;
    const auto now = Clock::now();
    const std::lock_guard one(mutex_);
    const size_t thread = threads_.emplace(std::this_thread::get_id(), threads_.size() + 1).first->second;
    events_.push_back({span.stage_, span.detail_, thread, Microseconds(span.start_ - began_).count(),
                       Microseconds(now - span.start_).count()});
}

void Trace::write(const std::filesystem::path& file) const {
    const std::lock_guard one(mutex_);
    auto events = nlohmann::ordered_json::array();
    for (size_t thread = 1; thread <= threads_.size(); thread++)
        events.push_back({{"ph", "M"},
                          {"name", "thread_name"},
                          {"pid", 1},
                          {"tid", thread},
                          {"args", {{"name", "thread " + std::to_string(thread)}}}});
    for (const Event& e : events_)
        events.push_back({{"ph", "X"},
                          {"name", e.detail.empty() ? e.stage : e.stage + " " + e.detail},
                          {"cat", e.stage},
                          {"pid", 1},
                          {"tid", e.thread},
                          {"ts", e.start},
                          {"dur", e.length}});
    const nlohmann::ordered_json all{{"displayTimeUnit", "ms"}, {"traceEvents", std::move(events)}};
    writeText(file, jsonText(all, -1) + "\n");
}

}  // namespace aa
