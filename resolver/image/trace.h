// What the program does when, thread by thread: a file that chrome://tracing and ui.perfetto.dev show. Off, a span
// costs a comparison.
#pragma once
#include <chrono>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace aa {

class Trace {
  public:
    // From its making to its end; null: off. `detail`: the frame, the method.
    class Span {
      public:
        Span(Trace* trace, std::string_view stage, std::string_view detail = {}) : trace_(trace) {
            if (trace_) stage_ = stage, detail_ = detail, start_ = Clock::now();
        }
        ~Span() {
            if (trace_) trace_->add(*this);
        }
        Span(const Span&) = delete;
        Span& operator=(const Span&) = delete;

      private:
        friend class Trace;
        Trace* trace_;
        std::string stage_, detail_;
        std::chrono::steady_clock::time_point start_;
    };
    // In the format of trace events (JSON object format). Throws InputError where the file cannot be written.
    void write(const std::filesystem::path& file) const;

  private:
    using Clock = std::chrono::steady_clock;
    struct Event {
        std::string stage, detail;
        size_t thread;
        double start, length;  // microseconds since the trace began
    };
    void add(const Span& span);
    const Clock::time_point began_ = Clock::now();
    mutable std::mutex mutex_;
    std::map<std::thread::id, size_t> threads_;  // numbered as they appear
    std::vector<Event> events_;
};

}  // namespace aa
