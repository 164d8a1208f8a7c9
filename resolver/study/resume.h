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

// What earlier results in options.out left: the methods that do not run now, files made from those results (a sheet, a
// report), which stay, and the pictures and maps that they name.
struct Earlier {
    std::vector<std::string> methods, files;
    std::vector<std::pair<std::filesystem::path, uint64_t>> pictures;  // and the inode of each
    std::vector<std::filesystem::path> folders;                        // of methods and maps that are not made now
};
Earlier earlierIn(const RunOptions& options);
// Removes those pictures that have not been written anew, and folders that are empty then.
void clear(const Earlier& earlier);

}  // namespace aa
