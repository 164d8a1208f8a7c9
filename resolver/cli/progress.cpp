#include "cli/progress.h"

#include <unistd.h>

#include <csignal>
#include <cstdio>

namespace aa {
namespace {
volatile std::sig_atomic_t stopAsked = 0;  // written by the signal handler, which can reach nothing else
void askToStop(int) {
    stopAsked = 1;
    std::signal(SIGINT, SIG_DFL);  // a second Ctrl-C ends at once
}
std::string clock(double seconds) {
    char text[32];
    std::snprintf(text, sizeof text, "%d:%02d", int(seconds) / 60, int(seconds) % 60);
    return text;
}
}  // namespace

TerminalProgress::TerminalProgress(std::string title, size_t steps, bool quiet)
    : title_(std::move(title)), steps_(steps), quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {
    stopAsked = 0;
    std::signal(SIGINT, askToStop);
}

TerminalProgress::~TerminalProgress() {
    std::signal(SIGINT, SIG_DFL);
    if (!quiet_ && terminal_ && done_ > 0) std::fputc('\n', stderr);
}

void TerminalProgress::step(const std::string& note) {
    done_++;
    if (quiet_) return;
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    if (!terminal_) {
        std::fprintf(stderr, "%s %zu/%zu %s\n", title_.c_str(), done_, steps_, note.c_str());
        return;
    }
    constexpr size_t width = 30;
    const size_t filled = width * done_ / std::max<size_t>(steps_, 1);
    const std::string bar = std::string(filled, '#') + std::string(width - filled, '.');
    std::fprintf(stderr, "\r%s [%s] %zu/%zu %s, %s left \x1b[K", title_.c_str(), bar.c_str(), done_, steps_,
                 note.c_str(), clock(elapsed / double(done_) * double(steps_ - done_)).c_str());
}

bool TerminalProgress::interrupted() const { return stopAsked != 0; }

Progress TerminalProgress::callbacks() {
    return {[this](const std::string& note) { step(note); }, [this] { return interrupted(); }};
}

}  // namespace aa
