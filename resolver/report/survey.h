// Makes the survey of study/survey.h from runs: the page that participants open, and its key.
#pragma once
#include <cstdint>
#include <optional>

#include "report/gallery.h"
#include "study/progress.h"
#include "study/survey_scores.h"

namespace aa {

struct SurveyOptions {
    std::vector<std::string> runs;
    // One per question, "KIND [METHOD...] [run=R] [frame=N] ...", see kQuestionForm; empty: one ranking per run.
    struct Question {
        std::string text, place;  // place: where it was written, for messages
        bool inFile = false;      // a mistake is bad input, else wrong usage
    };
    std::vector<Question> questions;
    std::vector<std::string> methods;  // of questions that name none; empty: all of the run
    std::string title, intro;
    std::optional<uint64_t> seed;  // of the codes; none: by chance
};
// The form of a question, for help.
inline constexpr const char* kQuestionForm =
    "KIND METHOD... run=R frame=N region=X,Y,W,H zoom=Z text=WORDS"
    "\n  KIND      rank (1 is best), pair (the better of two), pairs (a question for every"
    "\n            two), rating (1 bad to 5 excellent)"
    "\n  METHOD    as the run writes it, commas or spaces between; truth = ground truth; none"
    "\n            = those of --method; more than five to rank become several questions, the"
    "\n            first method in each"
    "\n  run=      a run by its folder's name or its number, from 1; without: of every run"
    "\n  frame=    one frame, default the last with pictures; frames=A-B or frames=all plays them"
    "\n  fps=      of played frames, default 24"
    "\n  region=   the part that is shown, default all that the run measured; auto or auto:WxH ="
    "\n            where these methods differ most"
    "\n  zoom=     screen pixels per pixel, 1 to 16, default 1"
    "\n  text=     what to look at; all that follows";

struct Survey {
    SurveyKey key;
    std::string page;
    size_t pictures = 0, bytes = 0;  // embedded files
    std::vector<std::string> notes;  // what would mislead: same pixels, a method named in a text, a large page
};
// `progressOf` is told how many pictures there are to read. When interrupted, the page is empty. Throws UsageError (a
// question on the command line), InputError (in a file; a run, method, frame that is not there).
Survey makeSurvey(const SurveyOptions& options, const Exec& exec,
                  const std::function<Progress(size_t steps)>& progressOf = {});

// The page of the scores. With the survey's own page (empty: without) it shows the pictures beside them.
std::string scoresHtml(const SurveyScores& scores, const std::string& surveyPage);

}  // namespace aa
