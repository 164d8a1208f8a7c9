#include "report/viewer_data.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "report/html.h"

namespace aa {
namespace {
namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

constexpr int kCropPx = 128;           // side of an embedded crop: a place with room around it
constexpr int kChain = 8;              // frames that are unpacked at most to show one
constexpr double kTypicalBytes = 0.5;  // per pixel of a picture in the page, for the first guess of what fits

size_t textLength(size_t bytes) { return (bytes + 2) / 3 * 4; }

// Words of the pictures of one frame, the truth first where there is one.
struct FrameWords {
    int frame = 0;
    std::vector<int> sources;
    std::vector<Words> words;
    std::vector<bool> displayReferred;
    const Words* of(int source) const {
        const auto at = std::find(sources.begin(), sources.end(), source);
        return at == sources.end() ? nullptr : &words[size_t(at - sources.begin())];
    }
};
FrameWords codesIn(const Pictures& p, const Window& window) {
    FrameWords f{p.frame, {}, {}, {}};
    const auto add = [&](int source, const Rgb& image) {
        f.sources.push_back(source), f.words.push_back(codeWords(cropped(image, window)));
        f.displayReferred.push_back(true);
    };
    if (!p.truth.empty()) add(PackedPicture::kTruth, p.truth);
    for (size_t m = 0; m < p.methods.size(); m++) add(int(m), p.methods[m]);
    return f;
}
FrameWords floatsIn(const LinearPictures& p, int frame, const Window& window) {
    FrameWords f{frame, {}, {}, {}};
    const auto add = [&](int source, const LinearPicture& image) {
        f.sources.push_back(source), f.words.push_back(floatWords(cropped(image.linear, window)));
        f.displayReferred.push_back(image.displayReferred);
    };
    if (p.truth) add(PackedPicture::kTruth, *p.truth);
    for (size_t m = 0; m < p.methods.size(); m++) add(int(m), p.methods[m]);
    return f;
}

// A quarter of the rows, in groups, since MED looks at neighbours: as much as the choice of another picture needs.
Words sampleOf(const Words& w) {
    constexpr int kGroup = 4;
    Words s{w.width, 0, w.bits, {}};
    for (int y = 0; y < w.height; y++) s.height += y / kGroup % 4 == 0;
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < w.height; y++)
            if (y / kGroup % 4 == 0) {
                const auto row = w.values.begin() + ptrdiff_t(c * w.perChannel() + size_t(y) * size_t(w.width));
                s.values.insert(s.values.end(), row, row + w.width);
            }
    return s;
}

// Packs frame after frame of one view. What each picture is coded against is chosen once, when two frames are there to
// choose from, and kept: the same methods resemble each other in every frame.
class Packer {
  public:
    Packer(const Window& window, const Exec& exec) : exec_(exec) { view_.window = window; }

    size_t add(FrameWords frame) {  // returns the length of the added text
        if (choices_.empty() || (frames_ == 1 && !choseAcrossFrames_)) choose(frame);
        std::vector<PackedPicture> pictures(frame.words.size());
        forRows(
            exec_, int(pictures.size()),
            [&](int from, int to) {
                for (int i = from; i < to; i++) pictures[size_t(i)] = pack(frame, size_t(i));
            },
            1);
        size_t length = 0;
        for (auto& p : pictures) length += textLength(p.bytes.size()), view_.pictures.push_back(std::move(p));
        view_.frames.insert(view_.frames.begin(), frame.frame);  // from the last backwards
        before_ = std::move(frame);
        frames_++;
        return length;
    }
    PackedView take() { return std::move(view_); }

  private:
    struct Choice {
        bool alone = true, acrossFrames = false;
        int source = PackedPicture::kTruth;
        Guess guess = Guess::med, guessWithin = Guess::med;
        bool aloneWithin = true;  // where acrossFrames is not to be had
        int sourceWithin = PackedPicture::kTruth;
    };
    void choose(const FrameWords& frame) {
        std::vector<Words> samples;
        for (const Words& w : frame.words) samples.push_back(sampleOf(w));
        choseAcrossFrames_ = frames_ > 0;
        std::vector<Choice> chosen(frame.sources.size());
        forRows(
            exec_, int(chosen.size()),
            [&](int from, int to) {
                for (int i = from; i < to; i++) chosen[size_t(i)] = choice(frame, samples, size_t(i));
            },
            1);
        for (size_t i = 0; i < chosen.size(); i++) choices_[frame.sources[i]] = chosen[i];
    }
    // Against none, or one that comes before it in its frame (so that no two wait for each other), or its own next
    // frame.
    Choice choice(const FrameWords& frame, const std::vector<Words>& samples, size_t i) const {
        Choice c;
        double least = std::numeric_limits<double>::infinity();
        const auto offer = [&](const Words* other, auto take) {
            for (const Guess g : {Guess::med, Guess::zero})
                if (const double size = packedSize(samples[i], other, g); size < least) least = size, take(g);
        };
        offer(nullptr, [&](Guess g) { c.aloneWithin = true, c.guessWithin = g; });
        for (size_t k = 0; k < i; k++)
            offer(&samples[k],
                  [&](Guess g) { c.aloneWithin = false, c.sourceWithin = frame.sources[k], c.guessWithin = g; });
        c.alone = c.aloneWithin, c.source = c.sourceWithin, c.guess = c.guessWithin;
        if (const Words* next = before_.of(frame.sources[i])) {
            const Words sample = sampleOf(*next);
            offer(&sample,
                  [&](Guess g) { c.alone = false, c.acrossFrames = true, c.source = frame.sources[i], c.guess = g; });
        }
        return c;
    }
    PackedPicture pack(const FrameWords& frame, size_t i) const {
        const int source = frame.sources[i];
        const auto chosen = choices_.find(source);
        const Choice c = chosen == choices_.end() ? Choice{} : chosen->second;  // a truth that other frames lack
        PackedPicture p{.frame = frame.frame, .source = source};
        p.displayReferred = frame.displayReferred[i];
        const Words* other = nullptr;
        if (c.acrossFrames && frames_ % kChain != 0) {
            other = before_.of(source);
            p.fromFrame = before_.frame, p.fromSource = source, p.guess = c.guess;
        }
        if (!other) {
            other = c.aloneWithin ? nullptr : frame.of(c.sourceWithin);
            p.fromFrame = frame.frame, p.fromSource = c.sourceWithin;
            p.guess = other || c.aloneWithin ? c.guessWithin : Guess::med;  // a frame without truth
        }
        p.alone = !other;
        p.bytes = packed(frame.words[i], other, p.guess);
        return p;
    }

    Exec exec_;
    PackedView view_;
    std::map<int, Choice> choices_;
    FrameWords before_;  // the frame packed last, which is the next in time
    int frames_ = 0;
    bool choseAcrossFrames_ = false;
};

// Whole, or as large a part as a single frame leaves below the limit.
Window shownPart(const Pictures& p, size_t limitBytes, bool floats) {
    Window whole{0, 0, p.methods[0].width(), p.methods[0].height()};
    const double perPixel = kTypicalBytes * (floats ? 8 : 1) * double(p.methods.size() + 1);
    int w = whole.width, h = whole.height;
    while (limitBytes && perPixel * w * h > double(limitBytes) && w > kCropPx && h > kCropPx)
        w = (w + 1) / 2, h = (h + 1) / 2;
    if (w == whole.width) return whole;
    const auto windows = mostTellingWindows(p, w, h, 1);
    return windows.empty() ? Window{0, 0, w, h} : windows[0];
}
Pictures part(const Pictures& p, const Window& w) {
    Pictures cut{.frame = p.frame, .truth = {}, .methods = {}};
    if (p.region) {
        const int x = std::max(p.region->x, w.x), y = std::max(p.region->y, w.y);
        cut.region = {x - w.x, y - w.y, std::min(p.region->x + p.region->width, w.x + w.width) - x,
                      std::min(p.region->y + p.region->height, w.y + w.height) - y};
        if (cut.region->width <= 0 || cut.region->height <= 0) cut.region.reset();
    }
    if (!p.truth.empty()) cut.truth = cropped(p.truth, w);
    for (const Rgb& m : p.methods) cut.methods.push_back(cropped(m, w));
    return cut;
}
std::vector<Window> placesIn(const Pictures& whole, const Window& window) {
    const bool all = window.width == whole.methods[0].width() && window.height == whole.methods[0].height();
    auto places = tellingCrops(all ? whole : part(whole, window));
    if (!all)
        for (Window& w : places) w.x += window.x, w.y += window.y;
    return places;
}
}  // namespace

size_t ViewerData::textBytes() const {
    size_t sum = 0;
    for (const auto& v : views)
        for (const auto& p : v.pictures) sum += textLength(p.bytes.size());
    return sum;
}

ViewerData viewerData(const RunResults& run, const fs::path& folder, const EmbedOptions& options, const Exec& exec) {
    ViewerData data{.floats = options.floats};
    const auto frames = framesWithPictures(run);
    if (options.what == Embed::none || frames.empty()) return data;
    std::vector<Packer> packers;
    std::vector<Window> windows;
    size_t bytes = 0, last = 0;
    for (auto frame = frames.rbegin(); frame != frames.rend(); frame++) {
        if (options.limitBytes && !packers.empty() && bytes + last > options.limitBytes) {  // it will be about as large
            data.leftOut.assign(frames.begin(), frames.end() - (frame - frames.rbegin()));
            break;
        }
        const Pictures p = loadPictures(run, folder, *frame, exec);
        if (packers.empty()) {
            if (options.what == Embed::full)
                windows = {shownPart(p, options.limitBytes, options.floats)};
            else
                windows = mostTellingWindows(p, kCropPx, kCropPx, kTellingCrops);
            if (windows.empty()) windows = {{0, 0, std::min(run.width, kCropPx), std::min(run.height, kCropPx)}};
            for (const Window& w : windows) packers.emplace_back(w, exec);
        }
        const LinearPictures linear = options.floats ? loadLinearPictures(run, folder, *frame) : LinearPictures{};
        last = 0;
        TellingPlaces places{*frame, {}};
        for (size_t v = 0; v < windows.size(); v++) {
            last += packers[v].add(options.floats ? floatsIn(linear, *frame, windows[v]) : codesIn(p, windows[v]));
            const auto here = placesIn(p, windows[v]);
            if (windows.size() == 1)
                places.windows = here;
            else if (!here.empty())
                places.windows.push_back(here[0]);
        }
        bytes += last;
        data.places.insert(data.places.begin(), places);
    }
    for (Packer& p : packers) data.views.push_back(p.take());
    return data;
}

std::vector<float> codeThresholds(const DisplayChain& chain, const Exec& exec) {
    // Bits of positive floats ascend as the floats do: 31 halvings find the least of them for each code.
    constexpr int kCodes = 255;
    std::vector<uint32_t> low(kCodes, 0), high(kCodes, std::bit_cast<uint32_t>(std::numeric_limits<float>::infinity()));
    Rgb middle(kCodes, 1), shown;
    for (int step = 0; step < 32; step++) {
        for (auto& plane : middle.c)
            for (int k = 0; k < kCodes; k++)
                plane.at(k, 0) = std::bit_cast<float>(low[size_t(k)] + (high[size_t(k)] - low[size_t(k)]) / 2);
        encode(middle, chain, exec, shown);
        const Words codes = codeWords(shown);
        for (size_t k = 0; k < kCodes; k++) {
            if (low[k] >= high[k]) continue;
            const uint32_t at = low[k] + (high[k] - low[k]) / 2;
            if (codes.values[k] > k)
                high[k] = at;
            else
                low[k] = at + 1;
        }
    }
    std::vector<float> thresholds;
    for (const uint32_t bits : high) thresholds.push_back(std::bit_cast<float>(bits));
    return thresholds;
}

json viewerJson(const ViewerData& data, const RunResults& run, const Exec& exec) {
    json j = {{"floats", data.floats}, {"views", json::array()}, {"places", json::array()}, {"leftOut", data.leftOut}};
    const auto rectangle = [](const Window& w) { return json{w.x, w.y, w.width, w.height}; };
    if (data.floats) {
        const auto finite = [](const std::vector<float>& thresholds) {
            json all = json::array();
            for (const float t : thresholds)  // a tone map may never reach the last codes
                all.push_back(t < std::numeric_limits<float>::infinity() ? json(t) : json("Inf"));
            return all;
        };
        j["thresholds"] = {finite(codeThresholds(run.protocol.display, exec)),
                           finite(codeThresholds(run.protocol.display.transferOnly(), exec))};
    }
    for (const auto& v : data.views) {
        // Of each picture: frame, source, guess, whether it is display-referred, and the picture it is coded against.
        json pictures = json::array();
        for (const auto& p : v.pictures) {
            json entry = {p.frame, p.source, int(p.guess), int(p.displayReferred)};
            if (!p.alone) entry.push_back(p.fromFrame), entry.push_back(p.fromSource);
            pictures.push_back(entry);
        }
        j["views"].push_back({{"window", rectangle(v.window)}, {"frames", v.frames}, {"pictures", pictures}});
    }
    for (const auto& p : data.places) {
        json windows = json::array();
        for (const Window& w : p.windows) windows.push_back(rectangle(w));
        j["places"].push_back({{"frame", p.frame}, {"windows", windows}});
    }
    return j;
}

std::string viewerElements(const ViewerData& data) {
    std::string text;
    text.reserve(data.textBytes() + data.textBytes() / 50 + 1000);
    for (size_t v = 0; v < data.views.size(); v++)
        for (const auto& p : data.views[v].pictures)
            text += "<script type=\"text/plain\" id=\"picture-" + std::to_string(v) + "-" + std::to_string(p.frame) +
                    "-" + (p.source == PackedPicture::kTruth ? "truth" : std::to_string(p.source)) + "\">" +
                    base64(p.bytes) + "</script>\n";
    return text;
}

}  // namespace aa
