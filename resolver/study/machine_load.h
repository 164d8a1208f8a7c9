// What other programs took of this machine's processors while something was timed. Processor time is spared their
// share of the clock, not what they do to shared caches, memory and clock rates.
#pragma once
#include <istream>
#include <optional>

namespace aa {

struct OtherPrograms {
    int processors = 1;  // of the machine
    double busy = 0;     // of them, those that other programs kept busy, in the mean
    // A tenth of the machine: from there on equal runs were seen to differ by more than their quartiles.
    bool disturb() const { return busy > 0.1 * processors; }
};

// Processors that were busy for so many seconds since the machine started, by the system's own count (/proc/stat).
struct BusySeconds {
    int processors = 0;
    double busy = 0;
};
std::optional<BusySeconds> busySeconds(std::istream& stat, double ticksPerSecond);

// Counts from its making on.
class LoadWatch {
  public:
    LoadWatch();
    std::optional<OtherPrograms> sofar() const;  // empty: the system does not say, or too little time has passed

  private:
    std::optional<BusySeconds> busy_;
    double own_, clock_;
};

}  // namespace aa
