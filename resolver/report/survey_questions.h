// The questions of a survey as they are written, and what each asks of a run. Everything throws UsageError with what
// was expected and found.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "report/gallery.h"

namespace aa {

struct SurveyRun {
    std::string name;  // of its folder
    std::filesystem::path folder;
    RunResults results;
    std::vector<int> frames;  // of which every method has a picture
};
// A question as it was asked for.
struct QuestionWish {
    std::string kind = "rank", run, text;
    std::vector<std::string> methods;
    std::string frame, frames, region;
    int zoom = 1;
    double framesPerSecond = 24;
};

// Whether a text begins with a kind of question.
bool isQuestion(const std::string& text);
// Of "KIND [METHOD...] [run=R] ...", see kQuestionForm.
QuestionWish wishOf(const std::string& text);
// Frames with pictures; of a run without any an InputError.
std::vector<int> framesOf(const QuestionWish& wish, const SurveyRun& run);
// `standing`: for questions that name none; empty: all of the run.
std::vector<std::string> methodsOf(const QuestionWish& wish, const SurveyRun& run,
                                   const std::vector<std::string>& standing);
// The methods of one question each: every two of `pairs`; more than five to rank in groups, the first in each.
std::vector<std::vector<std::string>> shared(const std::vector<std::string>& methods, const std::string& kind);
// Of "" (all that the run measured), "X,Y,W,H", "auto", "auto:WxH".
Window regionOf(const std::string& text, const Pictures& pictures);
// "a, b, c"
std::string joined(const std::vector<std::string>& texts);

}  // namespace aa
