// Progress of long work: a bar with the time left on a terminal, one line per step elsewhere. Ctrl-C asks for a stop
// after the current frame, so that finished frames stay valid.
#pragma once
#include <algorithm>
#include <chrono>
#include <string>

#include "study/progress.h"

namespace aa {

class TerminalProgress {
  public:
    TerminalProgress(std::string title, size_t steps, bool quiet);
    ~TerminalProgress();
    void step(const std::string& note);  // one more step is done
    bool interrupted() const;            // Ctrl-C was pressed
    Progress callbacks();                // for a study; this must outlive it

  private:
    std::string title_;
    size_t steps_, done_ = 0;
    bool quiet_, terminal_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace aa
