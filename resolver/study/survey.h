// A survey among viewers, after [Stejmar n.d., 4.5.2 and appendix A]: what was asked about which pictures, and what the
// participants answered. Its page knows pictures by codes alone; the key, a file of its own that stays with who asks,
// says which method is behind a code. docs/survey.md describes both files.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace aa {

enum class QuestionKind {
    rank,    // two to five pictures, 1 is best, no rank twice
    pair,    // the better of two
    rating,  // each picture for itself, 1 (bad) to 5 (excellent)
};
const char* name(QuestionKind kind);
inline constexpr int kMostRanked = 5;  // of [Stejmar n.d., 4.5.2]: nine were too many for one question
inline constexpr int kBestRating = 5;

using Figures = std::map<std::string, double, std::less<>>;  // by name
nlohmann::ordered_json toJson(const Figures& figures);       // as files of a survey hold them

struct SurveyPicture {
    std::string code;    // what page and answers call it
    std::string method;  // as the run writes it; "truth"
    Figures shown;       // against the truth, of the shown part and frames alone
    Figures run;         // of the whole run
};
struct SurveyQuestion {
    std::string id;  // "q1"
    QuestionKind kind = QuestionKind::rank;
    std::string text;  // what is asked, beside the standing words of its kind
    std::string run, shot;
    std::vector<int> frames;         // one: a still; several: played
    std::array<int, 4> region = {};  // x, y, width, height, px
    int zoom = 1;
    double framesPerSecond = 0;  // of a played question
    std::vector<SurveyPicture> pictures;
    bool isPlayed() const { return frames.size() > 1; }
    size_t indexOf(std::string_view code) const;  // pictures.size() when it has no such picture
};
struct SurveyKey {
    std::string survey;  // its id, in page, key and answers alike
    std::string title, program;
    std::vector<SurveyQuestion> questions;
};
std::string toJsonText(const SurveyKey& key);
// `file` is a key, or the page that it lies beside (NAME.html: NAME.key.json). Throws InputError: missing, damaged, no
// key.
SurveyKey readSurveyKey(const std::filesystem::path& file);
// Where the key of a page lies.
std::filesystem::path keyBeside(const std::filesystem::path& page);

// One participant's answer to one question: by picture of the key its rank, its rating, or 1 for the better of a pair.
struct SurveyAnswer {
    std::vector<int> values;
    std::vector<size_t> shown;  // pictures in the order of the screen
    double seconds = 0;
};
struct Participant {
    std::string file, id;
    std::vector<SurveyAnswer> answers;  // by question of the key
    std::string remarks;
};
struct Answers {
    std::vector<Participant> participants;
    std::vector<std::string> notes;  // what was left out: a file given twice
};
// Answers of one file; `survey` names the key in messages. Throws InputError with file, place, expected and found.
Participant readParticipant(const std::filesystem::path& file, const SurveyKey& key);
// Of all files. The same answers of the same participant count once, with a note; throws InputError when a participant
// answered differently in two files.
Answers readAnswers(const std::vector<std::string>& files, const SurveyKey& key);

}  // namespace aa
