// A run that goes on with what its folder holds: after an interruption, or with more methods. The result is, but for
// times, the bytes that one run of all would have written.
//
// Methods that are finished are left alone. The others see every frame again, because their history and the figures
// over time need it, but what is known of a frame is neither measured nor written a second time.
#pragma once
#include "study/run.h"

namespace aa {

struct Resumption {
    RunResults before;
    std::vector<MethodSpec> all;    // those of the earlier run, then those that are new
    std::vector<std::string> kept;  // of these, what need not run
};
// Sets options.methods to what has to run and options.known to what is known of it. `earlier` are the results in
// options.out. Throws InputError where they were made otherwise: another shot, program, protocol, frames or choice of
// what is measured and written.
Resumption goOnWith(RunResults earlier, const ShotReader& shot, RunOptions& options);
// The results of what ran now and the kept ones in one, with their tile errors, in the order of Resumption::all.
void merge(const Resumption& resumption, RunResults& results, std::vector<TileErrors>& errors);

// Earlier results in options.out, which this run replaces: not before a picture of its own is written, so that a full
// disk takes nothing.
class Earlier {
  public:
    explicit Earlier(const RunOptions& options);
    // Whether results so far may be written in their place.
    bool mayBeReplacedBy(const RunResults& sofar) const;
    // Once replaced: removes the pictures and maps that they name and that have not been written anew, and folders that
    // are empty then.
    void clear();
    // The methods that do not run now, and files made from those results (a sheet, a report), which stay.
    void tell(RunResults& results) const;

  private:
    std::vector<std::string> methods_, files_;
    std::vector<std::pair<std::filesystem::path, uint64_t>> pictures_;  // and the inode of each
    std::vector<std::filesystem::path> emptied_;                        // of methods and maps that are not made now
    bool isCleared_ = false;
};

}  // namespace aa
