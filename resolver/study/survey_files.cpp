// The survey's two files, key and answers.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "image/error.h"
#include "image/json_text.h"
#include "image/readable.h"
#include "study/json_number.h"
#include "study/survey.h"

namespace aa {
namespace {
namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

constexpr int kVersion = 1;
constexpr const char* kKeyFormat = "aaresolve-survey-key";
constexpr const char* kAnswersFormat = "aaresolve-survey-answers";

// A value in a file, which knows where it stands: what is wrong with it is said with file and place.
class Place {
  public:
    Place(const json& value, std::string file, std::string path = {})
        : value_(value), file_(std::move(file)), path_(std::move(path)) {}
    [[noreturn]] void refuse(const std::string& expected, const std::string& found) const {
        throw InputError(file_ + ": " + (path_.empty() ? "" : path_ + ": ") + "expected " + expected + ", found " +
                         found);
    }
    [[noreturn]] void refuse(const std::string& expected) const { refuse(expected, shortened()); }
    bool has(const char* key) const { return value_.is_object() && value_.contains(key); }
    Place at(const char* key) const {
        if (!value_.is_object()) refuse("an object with \"" + std::string(key) + "\"");
        if (!value_.contains(key)) refuse("a member \"" + std::string(key) + "\"", "none");
        return {value_.at(key), file_, path_.empty() ? key : path_ + "." + key};
    }
    std::string text() const {
        if (!value_.is_string()) refuse("a text");
        return value_.get<std::string>();
    }
    int whole(int least, int most) const {
        if (!value_.is_number_integer() || value_.get<double>() < least || value_.get<double>() > most)
            refuse("a whole number from " + std::to_string(least) + " to " + std::to_string(most));
        return value_.get<int>();
    }
    double number() const {
        if (!value_.is_number() && !(value_.is_string() && (value_ == "Inf" || value_ == "-Inf" || value_ == "NaN")))
            refuse("a number");
        return numberOf(value_);
    }
    std::vector<Place> list() const {
        if (!value_.is_array()) refuse("a list");
        std::vector<Place> all;
        for (size_t i = 0; i < value_.size(); i++)
            all.push_back({value_[i], file_, path_ + "[" + std::to_string(i) + "]"});
        return all;
    }
    std::vector<std::pair<std::string, Place>> members() const {
        if (!value_.is_object()) refuse("an object");
        std::vector<std::pair<std::string, Place>> all;
        for (const auto& [key, value] : value_.items()) all.push_back({key, {value, file_, path_ + "." + key}});
        return all;
    }
    void mustBe(const std::string& what, const std::string& why) const {
        if (text() != what) refuse("\"" + what + "\"" + why);
    }

  private:
    std::string shortened() const {
        constexpr size_t kMost = 60;
        const std::string all = jsonText(value_, -1);
        return all.size() <= kMost ? all : all.substr(0, kMost) + "...";
    }
    const json& value_;
    std::string file_, path_;
};

json parsed(const fs::path& file, const std::string& what) {
    return parseJson(requiredText(file, "; expected " + what), file.string(), "expected " + what);
}
void checkFormat(const Place& top, const char* format, const std::string& what) {
    top.at("format").mustBe(format, ", " + what);
    top.at("version").whole(kVersion, kVersion);
}

Figures figuresOf(const Place& place) {
    Figures figures;
    for (const auto& [name, value] : place.members()) figures[name] = value.number();
    return figures;
}
QuestionKind kindOf(const Place& place) {
    for (const auto kind : {QuestionKind::rank, QuestionKind::pair, QuestionKind::rating})
        if (place.text() == name(kind)) return kind;
    place.refuse("\"rank\", \"pair\" or \"rating\"");
}
SurveyQuestion questionOf(const Place& q) {
    constexpr int kMost = 1 << 30;
    SurveyQuestion question;
    question.id = q.at("id").text();
    question.kind = kindOf(q.at("kind"));
    question.text = q.at("text").text();
    question.run = q.at("run").text();
    question.shot = q.at("shot").text();
    for (const Place& f : q.at("frames").list()) question.frames.push_back(f.whole(-kMost, kMost));
    const auto region = q.at("region").list();
    if (region.size() != question.region.size()) q.at("region").refuse("x, y, width and height");
    for (size_t i = 0; i < region.size(); i++) question.region[i] = region[i].whole(0, kMost);
    question.zoom = q.at("zoom").whole(1, kMost);
    question.framesPerSecond = q.at("framesPerSecond").number();
    for (const Place& p : q.at("pictures").list())
        question.pictures.push_back(
            {p.at("code").text(), p.at("method").text(), figuresOf(p.at("shown")), figuresOf(p.at("run"))});
    const size_t n = question.pictures.size();
    if (n == 0 || (question.kind == QuestionKind::pair && n != 2) || (question.kind == QuestionKind::rank && n < 2))
        q.at("pictures").refuse("two pictures or more, of a pair two, of a rating one", std::to_string(n));
    return question;
}

// What was given to each picture, in the key's order.
std::vector<int> valuesOf(const Place& given, const SurveyQuestion& q, int most, const std::string& what) {
    std::vector<int> values(q.pictures.size(), 0);
    for (const auto& [code, value] : given.members()) {
        const size_t i = q.indexOf(code);
        if (i == values.size()) given.refuse("pictures of question " + q.id + " alone", "\"" + code + "\"");
        values[i] = value.whole(1, most);
    }
    for (size_t i = 0; i < values.size(); i++)
        if (values[i] == 0) given.refuse("a " + what + " of every picture", "none of \"" + q.pictures[i].code + "\"");
    return values;
}
std::vector<int> valuesOf(const Place& answer, const SurveyQuestion& q) {
    const int n = int(q.pictures.size());
    if (q.kind == QuestionKind::rating) return valuesOf(answer.at("ratings"), q, kBestRating, "rating");
    if (q.kind == QuestionKind::rank) {
        const std::vector<int> ranks = valuesOf(answer.at("ranks"), q, n, "rank");
        for (int r = 1; r <= n; r++)
            if (const auto times = std::count(ranks.begin(), ranks.end(), r); times > 1)
                answer.at("ranks").refuse("every rank from 1 to " + std::to_string(n) + " once",
                                          "rank " + std::to_string(r) + " " + std::to_string(times) + " times");
        return ranks;
    }
    const Place better = answer.at("better");
    const size_t i = q.indexOf(better.text());
    if (i == q.pictures.size()) better.refuse("a picture of question " + q.id);
    std::vector<int> values(q.pictures.size(), 0);
    values[i] = 1;
    return values;
}
std::vector<size_t> shownIn(const Place& answer, const SurveyQuestion& q) {
    std::vector<size_t> shown;
    for (const Place& code : answer.at("shown").list()) {
        shown.push_back(q.indexOf(code.text()));
        if (shown.back() == q.pictures.size()) code.refuse("a picture of question " + q.id);
    }
    if (std::set<size_t>(shown.begin(), shown.end()).size() != q.pictures.size() || shown.size() != q.pictures.size())
        answer.at("shown").refuse("every picture of question " + q.id + " once");
    return shown;
}
}  // namespace

json toJson(const Figures& figures) {
    json j = json::object();
    for (const auto& [name, value] : figures) j[name] = jsonNumber(value);
    return j;
}

const char* name(QuestionKind kind) {
    return kind == QuestionKind::rank ? "rank" : kind == QuestionKind::pair ? "pair" : "rating";
}
size_t SurveyQuestion::indexOf(std::string_view code) const {
    return size_t(std::find_if(pictures.begin(), pictures.end(), [&](auto& p) { return p.code == code; }) -
                  pictures.begin());
}

std::string toJsonText(const SurveyKey& key) {
    json j = {{"format", kKeyFormat},   {"version", kVersion}, {"survey", key.survey},
              {"program", key.program}, {"title", key.title},  {"questions", json::array()}};
    for (const auto& q : key.questions) {
        json question = {{"id", q.id},
                         {"kind", name(q.kind)},
                         {"text", q.text},
                         {"run", q.run},
                         {"shot", q.shot},
                         {"frames", q.frames},
                         {"region", q.region},
                         {"zoom", q.zoom},
                         {"framesPerSecond", q.framesPerSecond},
                         {"pictures", json::array()}};
        for (const auto& p : q.pictures)
            question["pictures"].push_back(
                {{"code", p.code}, {"method", p.method}, {"shown", toJson(p.shown)}, {"run", toJson(p.run)}});
        j["questions"].push_back(std::move(question));
    }
    return jsonText(j) + "\n";
}

fs::path keyBeside(const fs::path& page) { return fs::path(page).replace_extension(".key.json"); }

SurveyKey readSurveyKey(const fs::path& given) {
    const bool isPage = given.extension() == ".html";
    const fs::path file = isPage ? keyBeside(given) : given;
    const std::string what = "the key that `aaresolve survey make` wrote beside its page";
    const json j = parsed(file, what);
    const Place top(j, file.string());
    checkFormat(top, kKeyFormat, what);
    SurveyKey key{top.at("survey").text(), top.at("title").text(), top.at("program").text(), {}};
    for (const Place& q : top.at("questions").list()) key.questions.push_back(questionOf(q));
    if (key.questions.empty()) top.at("questions").refuse("a question");
    return key;
}

Participant readParticipant(const fs::path& file, const SurveyKey& key) {
    const std::string what = "answers that the survey's page saved";
    const json j = parsed(file, what);
    const Place top(j, file.string());
    checkFormat(top, kAnswersFormat, what);
    top.at("survey").mustBe(key.survey, " as in the key, for these answers belong to another survey");
    Participant p{file.string(), top.at("participant").text(), {}, {}};
    if (p.id.empty()) top.at("participant").refuse("a name or number");
    if (top.has("remarks")) p.remarks = top.at("remarks").text();
    p.answers.resize(key.questions.size());
    for (const Place& answer : top.at("answers").list()) {
        const Place id = answer.at("question");
        const auto q = std::find_if(key.questions.begin(), key.questions.end(),
                                    [&](const SurveyQuestion& question) { return question.id == id.text(); });
        if (q == key.questions.end())
            id.refuse("a question of the survey, " + key.questions.front().id + " to " + key.questions.back().id);
        SurveyAnswer& to = p.answers[size_t(q - key.questions.begin())];
        if (!to.values.empty()) id.refuse("each question once", "a second answer to " + q->id);
        to = {valuesOf(answer, *q), shownIn(answer, *q), answer.at("seconds").number()};
    }
    for (size_t q = 0; q < p.answers.size(); q++)
        if (p.answers[q].values.empty())
            top.at("answers").refuse("an answer to every question", "none to " + key.questions[q].id);
    return p;
}

Answers readAnswers(const std::vector<std::string>& files, const SurveyKey& key) {
    Answers all;
    for (const auto& file : files) {
        Participant p = readParticipant(file, key);
        const auto same = std::find_if(all.participants.begin(), all.participants.end(),
                                       [&](const Participant& other) { return other.id == p.id; });
        if (same == all.participants.end()) {
            all.participants.push_back(std::move(p));
            continue;
        }
        for (size_t q = 0; q < key.questions.size(); q++)
            if (same->answers[q].values != p.answers[q].values)
                throw InputError(file + ": participant: expected the answers of " + same->file +
                                 ", which are of the same participant (" + p.id + "), found others to " +
                                 key.questions[q].id + "; keep one of the two files");
        all.notes.push_back(file + ": the same answers as " + same->file + ", counted once");
    }
    return all;
}

}  // namespace aa
