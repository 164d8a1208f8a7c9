#include "study/machine_load.h"

#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string>

namespace aa {
namespace {
constexpr double kShortest = 0.2;  // s: the system counts in hundredths

double secondsOf(clockid_t clock) {
    timespec t{};
    clock_gettime(clock, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}
std::optional<BusySeconds> busyNow() {
    std::ifstream stat("/proc/stat");
    return busySeconds(stat, double(sysconf(_SC_CLK_TCK)));
}
}  // namespace

std::optional<BusySeconds> busySeconds(std::istream& stat, double ticksPerSecond) {
    BusySeconds found;
    bool isThere = false;
    for (std::string line; std::getline(stat, line) && line.starts_with("cpu");) {
        if (!line.starts_with("cpu ")) {
            found.processors++;
            continue;
        }
        std::array<double, 8> ticks{};  // user nice system idle iowait irq softirq steal (man 5 proc)
        isThere = std::sscanf(line.c_str(), "cpu %lf %lf %lf %lf %lf %lf %lf %lf", &ticks[0], &ticks[1], &ticks[2],
                              &ticks[3], &ticks[4], &ticks[5], &ticks[6], &ticks[7]) == 8;
        for (const size_t i : {0u, 1u, 2u, 5u, 6u, 7u}) found.busy += ticks[i] / ticksPerSecond;
    }
    if (!isThere || found.processors == 0) return {};
    return found;
}

LoadWatch::LoadWatch()
    : busy_(busyNow()), own_(secondsOf(CLOCK_PROCESS_CPUTIME_ID)), clock_(secondsOf(CLOCK_MONOTONIC)) {}

std::optional<OtherPrograms> LoadWatch::sofar() const {
    const double passed = secondsOf(CLOCK_MONOTONIC) - clock_, own = secondsOf(CLOCK_PROCESS_CPUTIME_ID) - own_;
    const auto now = busyNow();
    if (!busy_ || !now || passed < kShortest) return {};
    return OtherPrograms{now->processors, std::max(0.0, (now->busy - busy_->busy - own) / passed)};
}

}  // namespace aa
