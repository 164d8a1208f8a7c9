// `survey make` and `survey score`: what viewers say of a run's pictures.
#include "report/survey.h"

#include <cstdio>
#include <iostream>
#include <optional>
#include <sstream>

#include "cli/cli.h"
#include "cli/one_line.h"
#include "cli/progress.h"
#include "image/error.h"
#include "image/io.h"
#include "image/json_text.h"
#include "image/readable.h"
#include "methods/choosing.h"
#include "report/survey_questions.h"
#include "study/megabyte.h"

namespace aa {
namespace {
namespace fs = std::filesystem;

constexpr const char* kIntro =
    "You will see pictures of the same view, each made in another way. Judge how good they look: are edges smooth or "
    "stepped, are thin lines whole or broken, is fine detail there or blurred, and, where pictures move, are they calm "
    "or do they flicker, crawl or leave trails?\n"
    "What counts is your impression; there is no right answer.";

// ---- make ----
struct MakeOptions {
    SurveyOptions survey;
    std::vector<std::string> questions, methods;
    std::string out, file, introFile, seed;
    bool overwrite = false, quiet = false;
    WorkOptions work;
};
// A key that is lost leaves the answers to its survey without a meaning.
void refuseAnotherKey(const fs::path& file, const std::string& survey) {
    if (!fs::exists(file)) return;
    requireReadable(file);
    std::string found = "a damaged one";
    try {
        found = "survey " + readSurveyKey(file).survey;
    } catch (const InputError&) {
    }
    if (found != "survey " + survey)
        throw InputError(file.string() + ": expected no other survey's key, found that of " + found +
                         ", which its answers need; give another -o, or --overwrite");
}
// -q was --question once: what stood behind it would be taken for a run.
void refuseQuestionsAsRuns(const MakeOptions& o) {
    for (const auto& run : o.survey.runs)
        if (o.quiet && isQuestion(run) && !fs::exists(run))
            throw UsageError("survey make: '" + run + "' is a question and no run's folder; give it by --question");
}
void make(MakeOptions& o, Context& context) {
    const Exec exec = o.work.exec();
    refuseQuestionsAsRuns(o);
    for (const auto& text : o.methods)
        for (auto& method : splitMethods(text)) o.survey.methods.push_back(std::move(method));
    for (const auto& q : o.questions) o.survey.questions.push_back({q, "--question '" + q + "'", false});
    if (!o.file.empty()) {
        std::istringstream lines(requiredText(o.file));
        std::string line;
        for (int number = 1; std::getline(lines, line); number++) {
            const size_t from = line.find_first_not_of(" \t\r");
            if (from == std::string::npos || line[from] == '#') continue;
            line.erase(line.find_last_not_of(" \t\r") + 1);
            o.survey.questions.push_back({line, o.file + ": line " + std::to_string(number), true});
        }
        if (o.survey.questions.empty()) throw InputError(o.file + ": expected a question per line, found none");
    }
    o.survey.intro = o.introFile.empty() ? kIntro : requiredText(o.introFile);
    if (!o.seed.empty()) {
        char* end = nullptr;
        o.survey.seed = std::strtoull(o.seed.c_str(), &end, 10);
        if (*end || o.seed[0] == '-') throw UsageError("--seed: expected a whole number, found '" + o.seed + "'");
    }
    fs::path page = o.out;
    if (page.extension() != ".html") page /= "survey.html";
    if (page.has_parent_path()) makeWritableFolder(page.parent_path());
    Survey survey;
    {
        std::optional<TerminalProgress> progress;  // ends its line before the results
        withThreads(o.work.threads, [&] {
            survey = makeSurvey(o.survey, exec,
                                [&](size_t steps) { return progress.emplace("survey", steps, o.quiet).callbacks(); });
        });
    }
    if (survey.page.empty()) {  // Ctrl-C: part of a survey is none
        context.exitCode = 130;
        return;
    }
    if (!o.overwrite) refuseAnotherKey(keyBeside(page), survey.key.survey);
    writeText(page, survey.page);
    writeText(keyBeside(page), toJsonText(survey.key));
    for (const auto& note : survey.notes)
        std::fprintf(stderr, "aaresolve: survey: note: %s\n", onOneLine(note).c_str());
    std::printf("%zu questions, %zu pictures, %.1f MB\n", survey.key.questions.size(), survey.pictures,
                double(survey.page.size()) / kMegabyte);
    for (const auto& q : survey.key.questions) {
        std::printf("%-4s %-6s %s, ", q.id.c_str(), name(q.kind), q.run.c_str());
        if (q.isPlayed())
            std::printf("frames %d to %d", q.frames.front(), q.frames.back());
        else
            std::printf("frame %d", q.frames[0]);
        std::printf(", %dx%d at %d,%d, x%d:", q.region[2], q.region[3], q.region[0], q.region[1], q.zoom);
        for (const auto& p : q.pictures) std::printf(" %s", p.method.c_str());
        std::printf("\n");
    }
    std::printf("page, for participants: %s\nkey, not for them:      %s\n", page.c_str(), keyBeside(page).c_str());
}

// ---- score ----
struct ScoreOptions {
    std::vector<std::string> answers;
    std::string survey, out;
    bool json = false;
};
std::string shownScore(const ScoredSet& set, const Estimate& e) {
    char text[64];
    const double by = set.isShare() ? 100 : 1;
    if (e.low)
        std::snprintf(text, sizeof text, "%7.2f  %6.2f to %6.2f", by * e.value, by * *e.low, by * *e.high);
    else
        std::snprintf(text, sizeof text, "%7.2f  %16s", by * e.value, "-");
    return text;
}
void printScores(const SurveyScores& scores) {
    std::printf("%s: %zu participant%s\n", scores.key->title.c_str(), scores.participants,
                scores.participants == 1 ? "" : "s");
    for (const ScoredSet& set : scores.sets) {
        std::string ids;
        for (const auto* q : set.questions) ids += (ids.empty() ? "" : " ") + q->id;
        const char* what = set.kind == QuestionKind::rank     ? "mean rank, 1 is best"
                           : set.kind == QuestionKind::rating ? "mean rating, 5 is best"
                           : set.isBradleyTerry()             ? "Bradley-Terry, more is better"
                                                              : "wins, %";
        std::printf("\n%s (%s, %s)", ids.c_str(), set.questions[0]->run.c_str(), what);
        if (set.kendallW) std::printf(", Kendall's W %.2f", *set.kendallW);
        std::printf("\n");
        size_t width = 6;
        for (const auto& p : set.pictures) width = std::max(width, p.picture->method.size());
        std::printf("  %-*s   score  %-16s  counts\n", int(width), "method", "95 %");
        for (const size_t a : set.order) {
            const ScoredPicture& p = set.pictures[a];
            std::printf("  %-*s %s  ", int(width), p.picture->method.c_str(), shownScore(set, p.score).c_str());
            if (set.kind == QuestionKind::pair)
                std::printf("%zu of %zu", p.counts[0], p.counts[1]);
            else
                for (size_t r = 0; r < p.counts.size(); r++) std::printf("%s%zu", r ? " " : "", p.counts[r]);
            std::printf("%s\n", p.toNext && !p.resolved ? "  not resolved from the one above" : "");
        }
    }
    bool head = false;
    for (const Agreement& a : scores.pooled) {
        if (!a.kendall || !a.spearman) continue;
        if (!head) std::printf("\nagreement with viewers, pooled    pairs     tau  95 %%                rho  95 %%\n");
        head = true;
        const auto shown = [](const Estimate& e) {
            char text[64];
            if (e.low)
                std::snprintf(text, sizeof text, "%+6.2f  %+.2f to %+.2f", e.value, *e.low, *e.high);
            else
                std::snprintf(text, sizeof text, "%+6.2f  %14s", e.value, "-");
            return std::string(text);
        };
        std::printf("  %-30s %6zu  %s   %s\n", (a.title + (a.ofShown ? ", shown" : ", run")).c_str(), a.pairs,
                    shown(*a.kendall).c_str(), shown(*a.spearman).c_str());
    }
}
void score(const ScoreOptions& o) {
    const SurveyKey key = readSurveyKey(o.survey);
    const Answers answers = readAnswers(o.answers, key);
    const SurveyScores scores = scoreSurvey(key, answers);
    std::vector<fs::path> written;
    const auto write = [&](const fs::path& file, const std::string& text) {
        writeText(file, text);
        written.push_back(file);
    };
    const auto page = [&] {
        return scoresHtml(scores, fs::path(o.survey).extension() == ".html" && fs::exists(o.survey)
                                      ? requiredText(o.survey)
                                      : std::string());
    };
    const fs::path out = o.out;
    const std::string kind = out.extension().string();
    if (kind == ".html") {
        write(out, page());
    } else if (kind == ".json") {
        write(out, toJsonText(scores));
    } else if (kind == ".csv") {
        write(out, toCsvText(scores));
    } else if (!o.out.empty()) {
        makeWritableFolder(out);
        write(out / "scores.html", page());
        write(out / "scores.json", toJsonText(scores));
        write(out / "scores.csv", toCsvText(scores));
    }
    for (const auto& note : scores.notes)
        std::fprintf(stderr, "aaresolve: survey: note: %s\n", onOneLine(note).c_str());
    if (o.json) {
        std::cout << toJsonText(scores);
        return;
    }
    printScores(scores);
    for (const auto& p : answers.participants)
        if (!p.remarks.empty()) std::printf("\nremark of %s: %s\n", p.id.c_str(), p.remarks.c_str());
    for (const auto& file : written) std::printf("%s%s\n", &file == &written[0] ? "\n" : "", file.c_str());
}

void addMake(Command& survey, Context& context) {
    auto o = std::make_shared<MakeOptions>();
    Command c = survey.command("make", "A page on which viewers judge pictures of runs, and its key");
    o->survey.title = "Which picture is better?";
    c.option("RUN", o->survey.runs, "output folders of `aaresolve run`, with images").required().typeName("RUN");
    c.option("-o,--out", o->out, "the page, NAME.html, or a folder for survey.html; the key NAME.key.json beside it")
        .required()
        .typeName("FILE");
    c.option("-Q,--question", o->questions, std::string("one question; repeat for more:\n") + kQuestionForm).oneEach();
    c.option("--questions", o->file, "a file with a question per line, in the same form; # begins a comment")
        .typeName("FILE");
    c.option("-m,--method", o->methods,
             "methods for questions that name none, comma-separated, or repeat the option; default all")
        .oneEach()
        .typeName("METHOD");
    c.option("--title", o->survey.title, "what participants read first");
    c.option("--intro", o->introFile, "a text file in place of the page's introduction, a paragraph per line")
        .typeName("FILE");
    c.option("--seed", o->seed, "number from which the codes of pictures follow; default by chance");
    c.flag("--overwrite", o->overwrite, "replace the key of another survey: answers to it can then not be scored");
    c.flag("-q,--quiet", o->quiet, "no progress");
    addWorkOptions(c, o->work);
    c.run([o, &context] { make(*o, context); });
}
void addScore(Command& survey) {
    auto o = std::make_shared<ScoreOptions>();
    Command c = survey.command("score", "Scores with intervals from the saved answers, beside the run's metrics");
    c.option("ANSWERS", o->answers, "JSON files that participants saved, one each").required().typeName("FILE");
    c.option("--survey", o->survey,
             "the page, which brings its pictures into the scores' page and whose key lies beside it; or the key")
        .required()
        .typeName("FILE");
    c.option("-o,--out", o->out, "NAME.html, NAME.json or NAME.csv, or a folder for all three; default none")
        .typeName("FILE");
    c.flag("--json", o->json, "print the scores' JSON instead of the table");
    c.run([o] { score(*o); });
}
}  // namespace

void addSurvey(CommandLine& line, Context& context) {
    Command survey = line.command("survey", "What viewers say: make a survey of a run's pictures, score its answers");
    addMake(survey, context);
    addScore(survey);
}

}  // namespace aa
