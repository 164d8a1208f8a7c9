#include "report/survey.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "image/error.h"
#include "image/io.h"
#include "image/json_text.h"
#include "report/canvas.h"
#include "report/html.h"
#include "report/page.h"
#include "report/survey_questions.h"
#include "report/web/web_files.h"
#include "study/megabyte.h"

namespace aa {
namespace {
namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

constexpr size_t kLargePage = 50'000'000;  // bytes, beyond what goes by mail

void mustBeUtf8(const std::string& text, const std::string& what) {
    try {
        (void)json(text).dump();
    } catch (const json::exception&) {
        throw UsageError(what + ": expected UTF-8, found other bytes");
    }
}

// ---- figures ----
// Against the truth, of the shown part: what viewers saw is what is measured.
class ShownFigures {
  public:
    void add(const Rgb& test, const Rgb& truth, const Exec& exec) {
        FrameMetrics f = frameMetrics(squaredError(test, truth, exec));
        for (const char* name : kNames) addFigures(f, *findFigure(name).metric, {test, truth}, exec);
        mse_ += f.mse, frames_++;
        for (const char* name : kNames) sums_[name] += *f.figure(name);
    }
    Figures figures() const {
        if (frames_ == 0) return {};
        Figures all = {{"psnr", psnr(mse_ / frames_)}};
        for (const auto& [name, sum] : sums_) all[name] = sum / frames_;
        return all;
    }

  private:
    static constexpr const char* kNames[] = {"ssimLuma", "flip", "fmagMse"};
    double mse_ = 0, frames_ = 0;
    Figures sums_;
};
Figures runFigures(const RunResults& run, const std::string& method) {
    Figures all;
    for (const auto& m : run.methods) {
        if (m.text != method) continue;
        if (m.pooled) {
            all["psnr"] = m.pooled->mean.psnr;
            for (const auto& [name, value] : m.pooled->mean.others) all[std::string(name)] = value;
        }
        if (!m.temporal) continue;
        const auto add = [&](const char* name, const std::optional<double>& v) {
            if (v) all[name] = *v;
        };
        add("tPsnr", m.temporal->tPsnr), add("flickerStatic", m.temporal->flickerStatic);
        add("flickerMoving", m.temporal->flickerMoving), add("ghostMse", m.temporal->ghostMse);
    }
    return all;
}

// ---- codes ----
// Words by chance or from a seed: nothing of a method's name or place is in them.
class Codes {
  public:
    explicit Codes(uint64_t seed) : random_(seed) {}
    std::string next(int digits) {
        std::string code;
        while (int(code.size()) < digits) code += "0123456789abcdef"[random_() >> 60];
        return code;
    }

  private:
    std::mt19937_64 random_;  // the same everywhere, unlike distributions
};
uint64_t anySeed() {
    std::random_device device;
    return uint64_t(device()) << 32 | device();
}
// FNV-1a: two surveys of one seed are two surveys.
uint64_t digest(const std::string& text, uint64_t state = 0xcbf29ce484222325ull) {
    for (const char c : text) state = (state ^ uint64_t(static_cast<unsigned char>(c))) * 0x100000001b3ull;
    return state;
}

// ---- putting it together ----
class Maker {
  public:
    Maker(const SurveyOptions& options, const Exec& exec)
        : options_(options), exec_(exec), codes_(options.seed.value_or(anySeed())) {
        for (const auto& folder : options.runs) {
            RunResults results = readResults(folder);
            std::string name = fs::path(folder).filename().string();
            if (name.empty() || name == ".") name = fs::weakly_canonical(folder).filename().string();
            if (name.empty()) name = fs::weakly_canonical(folder).parent_path().filename().string();
            // Two folders of one name are told apart by what was given.
            if (std::any_of(runs_.begin(), runs_.end(), [&](const SurveyRun& r) { return r.name == name; }))
                name = folder;
            auto frames = framesWithPictures(results);
            runs_.push_back({name, folder, std::move(results), std::move(frames)});
        }
    }
    // Pictures that will be read and measured. What is wrong with a question is said before the long work.
    size_t steps() {
        size_t steps = 0;
        forQuestions([&](const QuestionWish& wish, const SurveyRun& run) {
            steps += methodsOf(wish, run, options_.methods).size() * framesOf(wish, run).size();
        });
        return steps;
    }
    Survey made(const Progress& progress) {
        progress_ = &progress;
        forQuestions([&](const QuestionWish& wish, const SurveyRun& run) { askOf(wish, run); });
        return progress.interrupted() ? Survey{} : finished();
    }

  private:
    template <class Ask>
    void forQuestions(Ask ask) {
        for (const auto& q : options_.questions) {
            try {
                forRuns(wishOf(q.text), ask);
            } catch (const UsageError& e) {
                const std::string message = q.place + ": " + e.what();
                if (q.inFile) throw InputError(message);
                throw UsageError(message);
            }
        }
        if (options_.questions.empty()) forRuns({}, ask);
    }
    template <class Ask>
    void forRuns(const QuestionWish& wish, Ask ask) {
        bool asked = false;
        for (size_t r = 0; r < runs_.size(); r++)
            if (wish.run.empty() || wish.run == runs_[r].name || wish.run == std::to_string(r + 1))
                ask(wish, runs_[r]), asked = true;
        if (asked) return;
        std::vector<std::string> names;
        for (const SurveyRun& r : runs_) names.push_back(r.name);
        throw UsageError("run: expected one of " + joined(names) + " or its number, found '" + wish.run + "'");
    }
    void askOf(const QuestionWish& wish, const SurveyRun& run) {
        const auto methods = methodsOf(wish, run, options_.methods);
        const auto groups = shared(methods, wish.kind);
        const auto frames = framesOf(wish, run);
        // Only the pictures that are asked for are read.
        RunResults few = run.results;
        std::erase_if(few.methods, [&](const MethodResult& m) {
            return std::find(methods.begin(), methods.end(), m.text) == methods.end();
        });
        const bool withTruth = few.methods.size() < methods.size();
        if (const auto& reference = run.results.protocol.reference; withTruth && !reference.empty())
            throw InputError(run.folder.string() + ": judged against " + reference +
                             ", so it has no images of the truth; run the shot without --reference");
        if (few.methods.empty()) throw UsageError("expected a method beside truth");
        std::vector<ShownFigures> figures(few.methods.size());
        std::vector<std::vector<std::string>> files(methods.size());  // by method and frame, data URIs
        Window region;
        bool allHaveTruth = true;
        for (const int frame : frames) {
            if (progress_->interrupted()) return;
            const Pictures p = loadPictures(few, run.folder, frame, exec_);
            if (frame == frames[0]) region = regionOf(wish.region, p);
            if (p.truth.empty() && withTruth)
                throw InputError(run.folder.string() + ": no image of the truth of frame " + std::to_string(frame));
            const Rgb truth = p.truth.empty() ? Rgb() : cropped(p.truth, region);
            allHaveTruth = allHaveTruth && !truth.empty();
            for (size_t m = 0; m < methods.size(); m++) {
                const auto found = std::find_if(few.methods.begin(), few.methods.end(),
                                                [&](const MethodResult& r) { return r.text == methods[m]; });
                const auto i = size_t(found - few.methods.begin());
                const Rgb shown = found == few.methods.end() ? truth : cropped(p.methods[i], region);
                if (found != few.methods.end() && !truth.empty() && !few.isReference(*found))
                    figures[i].add(shown, truth, exec_);
                files[m].push_back("data:image/png;base64," + base64(pngBytes(shown)));
                progress_->step(run.name + ", frame " + std::to_string(frame) + ", " + methods[m]);
            }
        }
        std::map<std::string, SurveyPicture> pictures;
        for (size_t m = 0; m < methods.size(); m++) {
            const auto found = std::find_if(few.methods.begin(), few.methods.end(),
                                            [&](const MethodResult& r) { return r.text == methods[m]; });
            SurveyPicture& p = pictures[methods[m]];
            p = {codeOf(run, methods[m], frames, region, files[m]), methods[m], {}, runFigures(few, methods[m])};
            if (allHaveTruth && found != few.methods.end())
                p.shown = figures[size_t(found - few.methods.begin())].figures();
        }
        for (const auto& group : groups) {
            SurveyQuestion q;
            q.id = "q" + std::to_string(survey_.key.questions.size() + 1);
            q.kind = wish.kind == "rank"     ? QuestionKind::rank
                     : wish.kind == "rating" ? QuestionKind::rating
                                             : QuestionKind::pair;
            q.text = wish.text, q.run = run.name, q.shot = run.results.shot, q.frames = frames;
            q.region = {region.x, region.y, region.width, region.height};
            q.zoom = wish.zoom, q.framesPerSecond = frames.size() > 1 ? wish.framesPerSecond : 0;
            for (const auto& m : group) q.pictures.push_back(pictures[m]);
            mustBeUtf8(q.text, "text of " + q.id);
            noteSame(q);
            noteNamed(q.text, q.id);
            survey_.key.questions.push_back(std::move(q));
        }
    }
    // The same pictures of two questions are kept once.
    std::string codeOf(const SurveyRun& run, const std::string& method, const std::vector<int>& frames,
                       const Window& region, const std::vector<std::string>& files) {
        const std::string what =
            run.folder.string() + '\0' +
            jsonText(json({method, frames, {region.x, region.y, region.width, region.height}}), -1);
        auto& code = known_[what];
        if (!code.empty()) return code;
        constexpr int kDigits = 8;
        do code = codes_.next(kDigits);
        while (images_.contains(code));
        images_[code] = files;
        for (const auto& f : files) survey_.bytes += f.size();
        survey_.pictures += files.size();
        return code;
    }
    void noteSame(const SurveyQuestion& q) {
        for (size_t a = 0; a < q.pictures.size(); a++)
            for (size_t b = a + 1; b < q.pictures.size(); b++)
                if (images_[q.pictures[a].code] == images_[q.pictures[b].code])
                    survey_.notes.push_back(q.id + ": " + q.pictures[a].method + " and " + q.pictures[b].method +
                                            " have the same pixels here; viewers can only guess");
    }
    // A text that names a method tells what is to be hidden.
    void noteNamed(const std::string& text, const std::string& where) {
        std::istringstream in(text);
        for (std::string word; in >> word;) {
            while (!word.empty() && !std::isalnum(static_cast<unsigned char>(word.back()))) word.pop_back();
            for (const SurveyRun& run : runs_)
                for (const auto& m : run.results.methods)
                    if (word == m.text || word == m.id) {
                        survey_.notes.push_back(where + ": its text names the method " + word +
                                                ", which participants should not know");
                        return;
                    }
        }
    }
    Survey finished() {
        SurveyKey& key = survey_.key;
        key.title = options_.title, key.program = AA_VERSION;
        mustBeUtf8(options_.title, "title"), mustBeUtf8(options_.intro, "introduction");
        noteNamed(options_.title, "title"), noteNamed(options_.intro, "introduction");
        // Of what the page holds, codes in their own order: nothing of the key's order.
        json page = {{"title", options_.title}, {"intro", options_.intro}, {"questions", json::array()}};
        for (const auto& q : key.questions) {
            std::vector<std::string> codes;
            for (const auto& p : q.pictures) codes.push_back(p.code);
            std::sort(codes.begin(), codes.end());
            page["questions"].push_back({{"id", q.id},
                                         {"kind", name(q.kind)},
                                         {"text", q.text},
                                         {"size", {q.region[2], q.region[3]}},
                                         {"zoom", q.zoom},
                                         {"framesPerSecond", q.framesPerSecond},
                                         {"pictures", codes}});
        }
        page["images"] = images_;
        uint64_t all = digest(jsonText(page, -1));
        constexpr int kDigits = 10;
        std::string& id = key.survey;
        for (; int(id.size()) < kDigits; all <<= 4) id += "0123456789abcdef"[all >> 60];
        page["survey"] = id;
        survey_.page = filled(web::surveyHtml, {{"head", pageHead(options_.title, {web::css, web::surveyCss})},
                                                {"common", web::common},
                                                {"surveyJs", web::surveyJs},
                                                {"data", forScript(page)}});
        if (survey_.bytes > kLargePage)
            survey_.notes.push_back("the page has " + std::to_string(size_t(double(survey_.page.size()) / kMegabyte)) +
                                    " MB; region= shows less of a picture, frames= fewer");
        return std::move(survey_);
    }

    const SurveyOptions& options_;
    const Exec& exec_;
    const Progress* progress_ = nullptr;
    Codes codes_;
    std::vector<SurveyRun> runs_;
    Survey survey_;
    std::map<std::string, std::string> known_;                // what it shows -> code
    std::map<std::string, std::vector<std::string>> images_;  // code -> data URIs
};
}  // namespace

Survey makeSurvey(const SurveyOptions& options, const Exec& exec, const std::function<Progress(size_t)>& progressOf) {
    Maker maker(options, exec);
    const Progress progress = progressOf ? progressOf(maker.steps()) : Progress{};
    return maker.made(progress);
}

}  // namespace aa
