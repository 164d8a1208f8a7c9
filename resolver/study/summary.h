// Several runs side by side: methods over scenes, and runs of one shot against each other.
//
// Scenes differ in how hard they are, so that what is averaged over them is a difference: the gain of a method over
// noaa in the same run, in dB (conventions 13.6). A mean of PSNRs would follow the easiest scene, and is infinite where
// one picture is identical to its truth.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "study/results.h"

namespace aa {

struct NamedRun {
    std::string name;  // of the column: the shot, and the folder where shots share a name
    RunResults results;
    std::string folder = {};
};
// Gives each run its name.
std::vector<NamedRun> namedRuns(std::vector<std::pair<std::string, RunResults>> byFolder);

// One method in one run.
struct SummaryCell {
    size_t method = 0;                 // in that run
    int rank = 0;                      // by MSE in that run, 1 is nearest; 0 without truth
    std::optional<Comparison> gain{};  // over noaa; none of noaa itself and without noaa
};
// A mean gain, in dB, with its 95 % interval over these scenes, from the intervals of each [Zou 2008]. An end that one
// of them leaves open is open here, too: infinite.
struct MeanGain {
    double gainDb = 0, low = 0, high = 0;
    bool resolved = false;            // the interval excludes zero; of one scene what its run says, so is
    std::optional<Unresolved> why{};  // this, which several scenes have not
};
struct SummaryRow {
    std::string text, id, title, family;
    std::vector<std::optional<SummaryCell>> cells{};  // one per run
    // Over the scenes in which the gain is known and finite, each counted once: of several runs of a scene the last in
    // which it is known.
    int scenes = 0, infinite = 0;  // infinite: scenes left out since the method is identical to the truth there
    std::optional<MeanGain> mean{};
    std::optional<double> meanRank{};
    double least = 0, most = 0;  // of the gains
    // 95 % interval of the mean over scenes like these, by Student's t, from 4 scenes up.
    std::optional<std::pair<double, double>> ofSuch{};
};
struct Summary {
    std::vector<SummaryRow> rows;          // best mean gain first, those in fewer scenes after those in more, noaa last
    std::vector<std::string> differences;  // what the runs' protocols and machines do not share
};
Summary summarise(const std::vector<NamedRun>& runs);

// What changed in a method between two runs of one shot.
struct RunChange {
    std::string text;
    double psnrBefore = 0, psnrAfter = 0;
    Comparison comparison;  // of the second run with the first: gains are positive where it came nearer to the truth
    double nsPerPixelBefore = 0, nsPerPixelAfter = 0;
};
struct RunAgainstRun {
    size_t before = 0, after = 0;  // indices of runs
    std::vector<RunChange> changes{};
    std::vector<std::string> onlyBefore{}, onlyAfter{};  // methods
    std::vector<std::string> differences{};              // in protocol, program, machine
};
// Each run against the one before it that is of the same shot and judged the same frames.
std::vector<RunAgainstRun> againstEachOther(const std::vector<NamedRun>& runs);

}  // namespace aa
