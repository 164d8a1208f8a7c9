// A gate: what got worse from one run to another of the same methods, protocol and frames, by more than a tolerance and
// by more than chance. Figures of an unchanged program are the same bits on any machine, so that an unchanged run
// passes always; times are held only where they are asked for.
//
// The change of a figure is paired wherever the results allow it: PSNR, MSE and SNR tile by tile (metrics/error_bar.h),
// figures over time and all others frame by frame, in blocks of frames that follow each other. Where there is nothing
// to pair (one frame, a few tiles) the tolerance decides alone.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "study/results.h"

namespace aa {

// How much worse a figure may get: in its own unit, or as a share of what it was.
struct Tolerance {
    double value = 0;
    bool isShare = false;
};
struct GateOptions {
    std::map<std::string, Tolerance, std::less<>> tolerances;  // by figure; "time" is held only with one of its own
    bool allowMissing = false;
};
// "psnr=0.1", "flip=5%", "time=50%". Throws UsageError.
void addTolerance(GateOptions& options, const std::string& text);
// "\n  psnr  0.05 dB" of every figure that is held, for help.
std::string listOfTolerances();

enum class Verdict {
    same,        // to the last bit
    within,      // not worse, or by no more than the tolerance
    unresolved,  // worse by more than the tolerance, but the interval holds zero
    better,      // by more than the tolerance
    worse,
    missing,  // there before, not now
    added,    // there now alone
};
const char* name(Verdict verdict);

struct GateRow {
    std::string method, figure;
    std::optional<double> before{}, now{};
    double worsening = 0;  // in the unit of `tolerance`: positive is worse
    Tolerance tolerance{};
    std::optional<double> low{},
        high{};                  // 95 % interval of the worsening, in the figure's unit or in dB: see intervalUnit
    std::string intervalUnit{};  // "dB" where it is of the decibels of the figure, otherwise empty
    Verdict verdict = Verdict::same;
    std::string rerun{};  // the line that makes the row of the new run again; empty where the results do not say
    // "psnr 30.02 dB, was 32.10 dB: 2.08 dB worse (95 %: 1.8 to 2.3 dB), tolerance 0.05 dB"
    std::string inWords() const;
};
struct GateReport {
    std::string shot;
    std::vector<GateRow> rows;       // a missing method or figure has one
    std::vector<std::string> notes;  // what differs between the runs and is no figure: the shot, program, parameters
    size_t count(Verdict verdict) const;
    bool passed() const { return count(Verdict::worse) + count(Verdict::missing) == 0; }
};
// Throws InputError for what cannot be compared: an interrupted run, other shot, frames, resolution or protocol, a base
// without figures.
GateReport gate(const RunResults& base, const RunResults& now, const GateOptions& options);

std::string toJsonText(const GateReport& report);
// JUnit's XML as GitLab, Jenkins and GitHub's actions read it: a suite per method, a case per figure.
std::string toJunitText(const GateReport& report);

}  // namespace aa
