// Parameter sweeps: every combination of some parameters' values is one method of one run. The frames are read once
// for as many variants as the memory allows.
#pragma once
#include <string>
#include <vector>

#include "study/run.h"

namespace aa {

struct SweepOptions {
    std::vector<std::string> methods;          // with what stays the same
    std::vector<std::string> vary;             // "NAME=VALUE,VALUE,...", a value also FIRST..LAST:STEP
    std::vector<std::string> with = {"noaa"};  // methods to compare with, as they are; none = without
    double memoryMb = 2048;                    // that all variants may hold at a time
};
// A parameter and its values, as they are written.
struct SweepAxis {
    std::string name;
    std::vector<std::string> values;
};
std::vector<SweepAxis> axesOf(const SweepOptions& options);  // throws UsageError: malformed
// Throws UsageError: malformed, a parameter varied twice or fixed and varied, more than 256 combinations, a value that
// the method refuses.
std::vector<MethodSpec> variantsOf(const SweepOptions& options);

// The variants in parts, each of which holds its memory at the same time.
class Sweep {
  public:
    // `run.methods` are the variants, the first of them the compared methods.
    Sweep(const ShotReader& shot, const RunOptions& run, const SweepOptions& options);
    size_t steps() const { return steps_; }          // of progress
    size_t passes() const { return parts_.size(); }  // over the frames
    // Runs, writes the images, results.json and results.csv. When interrupted, the results are those of the parts that
    // saw all frames, or of the frames of the first part.
    RunResults run(const Progress& progress);

  private:
    const ShotReader& shot_;
    RunOptions run_;
    std::vector<MethodSpec> reference_;  // none or one: the method that the others are held against, in every part
    std::vector<std::vector<MethodSpec>> parts_;
    size_t steps_ = 0;
};

// A variant among the results.
struct SweepVariant {
    size_t method;           // in RunResults::methods
    std::string base;        // as SweepOptions::methods gives it
    std::vector<size_t> at;  // its value on every axis
};
// Those that the results hold, which of an interrupted sweep are not all.
std::vector<SweepVariant> sweepVariants(const RunResults& run, const SweepOptions& options);

}  // namespace aa
