#include "report/survey_questions.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <sstream>

#include "image/error.h"
#include "methods/choosing.h"
#include "study/survey.h"

namespace aa {
namespace {
constexpr const char* kTruth = "truth";
constexpr std::string_view kKinds[] = {"rank", "pair", "pairs", "rating"};
bool isKind(std::string_view word) { return std::find(std::begin(kKinds), std::end(kKinds), word) != std::end(kKinds); }

// Of "4,8,15,16" or "1-9", split at `separator`; nothing unless they are `count` whole numbers.
std::optional<std::vector<int>> numbersOf(std::string_view text, char separator, size_t count) {
    std::vector<int> numbers;
    const char *at = text.data(), *end = at + text.size();
    while (true) {
        int v = 0;
        const auto [next, error] = std::from_chars(at, end, v);
        if (error != std::errc()) return {};
        numbers.push_back(v);
        if (next == end) break;
        if (*next != separator) return {};
        at = next + 1;
    }
    return numbers.size() == count ? std::optional(numbers) : std::nullopt;
}
}  // namespace

std::string joined(const std::vector<std::string>& texts) {
    std::string all;
    for (const auto& t : texts) all += (all.empty() ? "" : ", ") + t;
    return all;
}
bool isQuestion(const std::string& text) { return isKind(text.substr(0, text.find(' '))); }
QuestionWish wishOf(const std::string& text) {
    QuestionWish wish;
    std::istringstream in(text);
    in >> wish.kind;
    if (!isKind(wish.kind)) {
        const std::string near = suggestion(wish.kind, {std::begin(kKinds), std::end(kKinds)});
        throw UsageError("expected rank, pair, pairs or rating first, found '" + wish.kind + "'" +
                         (near.empty() ? "" : "; did you mean '" + near + "'?"));
    }
    std::string word;
    while (in >> word) {
        const size_t equals = word.find('=');
        const std::string name = word.substr(0, equals),
                          value = equals == std::string::npos ? "" : word.substr(equals + 1);
        if (equals == std::string::npos || name.find_first_of(":+") != std::string::npos) {
            for (auto& method : splitMethods(word)) wish.methods.push_back(std::move(method));
        } else if (name == "text") {
            std::getline(in, wish.text);
            wish.text = value + wish.text;
        } else if (name == "run") {
            wish.run = value;
        } else if (name == "frame") {
            wish.frame = value;
        } else if (name == "frames") {
            wish.frames = value;
        } else if (name == "region") {
            wish.region = value;
        } else if (name == "zoom") {
            const auto zoom = numbersOf(value, ',', 1);
            constexpr int kMost = 16;
            if (!zoom || (*zoom)[0] < 1 || (*zoom)[0] > kMost)
                throw UsageError("zoom: expected a whole number from 1 to 16, found '" + value + "'");
            wish.zoom = (*zoom)[0];
        } else if (name == "fps") {
            char* end = nullptr;
            wish.framesPerSecond = std::strtod(value.c_str(), &end);
            if (value.empty() || *end || !(wish.framesPerSecond >= 0.1 && wish.framesPerSecond <= 240))
                throw UsageError("fps: expected 0.1 to 240, found '" + value + "'");
        } else {
            const std::string near = suggestion(name, {"run", "frame", "frames", "fps", "region", "zoom", "text"});
            throw UsageError("unknown '" + name + "='" + (near.empty() ? "" : "; did you mean '" + near + "='?"));
        }
    }
    if (!wish.frame.empty() && !wish.frames.empty()) throw UsageError("frame= and frames= exclude each other");
    return wish;
}

std::vector<int> framesOf(const QuestionWish& wish, const SurveyRun& run) {
    if (run.frames.empty())
        throw InputError(run.folder.string() + ": no frame of which every method has an image; " +
                         howToWriteAll(run.results));
    if (!wish.frame.empty()) {
        const auto one = numbersOf(wish.frame, ',', 1);
        if (!one) throw UsageError("frame: expected a whole number, found '" + wish.frame + "'");
        if (std::find(run.frames.begin(), run.frames.end(), (*one)[0]) == run.frames.end())
            throw UsageError("frame: expected one of " + std::to_string(run.frames.front()) + " to " +
                             std::to_string(run.frames.back()) + " with images in " + run.name + ", found " +
                             wish.frame);
        return *one;
    }
    if (wish.frames.empty()) return {run.frames.back()};
    std::vector<int> range = {run.frames.front(), run.frames.back()};
    if (wish.frames != "all") {
        const auto given = numbersOf(wish.frames, '-', 2);
        if (!given) throw UsageError("frames: expected A-B or all, found '" + wish.frames + "'");
        range = *given;
    }
    std::vector<int> frames;
    for (const int f : run.frames)
        if (f >= range[0] && f <= range[1]) frames.push_back(f);
    if (frames.size() < 2)
        throw UsageError("frames: expected two or more with images, found " + std::to_string(frames.size()) + " in " +
                         run.name + " (" + howToWriteAll(run.results) + ")");
    return frames;
}
std::vector<std::string> methodsOf(const QuestionWish& wish, const SurveyRun& run,
                                   const std::vector<std::string>& standing) {
    std::vector<std::string> methods = wish.methods.empty() ? standing : wish.methods;
    std::vector<std::string_view> known = {kTruth};
    for (const auto& m : run.results.methods) known.push_back(m.text);
    if (methods.empty())
        for (const auto& m : run.results.methods) methods.push_back(m.text);
    for (size_t i = 0; i < methods.size(); i++) {
        if (std::find(known.begin(), known.end(), methods[i]) == known.end()) {
            const std::string near = suggestion(methods[i], known);
            throw UsageError("no method '" + methods[i] + "' in " + run.name +
                             (near.empty() ? "" : "; did you mean '" + near + "'?"));
        }
        if (std::find(methods.begin(), methods.begin() + long(i), methods[i]) != methods.begin() + long(i))
            throw UsageError("method '" + methods[i] + "' is named twice");
    }
    return methods;
}
std::vector<std::vector<std::string>> shared(const std::vector<std::string>& methods, const std::string& kind) {
    const size_t n = methods.size();
    if (kind != "rating" && n < 2)
        throw UsageError(kind + ": expected two methods or more, found " + std::to_string(n));
    if (kind == "pair" && n != 2) throw UsageError("pair: expected two methods, found " + joined(methods));
    if (kind == "rating" || (kind == "rank" && n <= size_t(kMostRanked)) || kind == "pair") return {methods};
    std::vector<std::vector<std::string>> all;
    if (kind == "pairs") {
        for (size_t a = 0; a < n; a++)
            for (size_t b = a + 1; b < n; b++) all.push_back({methods[a], methods[b]});
        return all;
    }
    const size_t others = n - 1, most = size_t(kMostRanked) - 1, count = (others + most - 1) / most;
    for (size_t k = 0; k < count; k++) {
        all.push_back({methods[0]});
        for (size_t i = k * others / count; i < (k + 1) * others / count; i++) all.back().push_back(methods[i + 1]);
    }
    return all;
}
Window regionOf(const std::string& text, const Pictures& p) {
    const int w = p.methods[0].width(), h = p.methods[0].height();
    const Window all = p.region.value_or(Window{0, 0, w, h});
    if (text.empty()) return all;
    if (text.starts_with("auto")) {
        Window size{all.x, all.y, std::min(all.width, 480), std::min(all.height, 270)};
        if (text != "auto") {
            const auto given =
                text.starts_with("auto:") ? numbersOf(std::string_view(text).substr(5), 'x', 2) : std::nullopt;
            if (!given || (*given)[0] < 1 || (*given)[1] < 1)
                throw UsageError("region: expected X,Y,W,H, auto or auto:WxH, found '" + text + "'");
            size.width = std::min(all.width, (*given)[0]), size.height = std::min(all.height, (*given)[1]);
        }
        const auto windows = mostTellingWindows(p, size.width, size.height, 1);
        return windows.empty() ? size : windows[0];
    }
    return windowFrom(text, "region", "the run", w, h);
}

}  // namespace aa
