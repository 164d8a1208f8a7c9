#include "report/html.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "image/colour_map.h"
#include "image/png.h"
#include "methods/method.h"
#include "metrics/maps.h"
#include "report/canvas.h"
#include "report/caption.h"
#include "report/page.h"
#include "report/sheet.h"
#include "report/web/web_files.h"
#include "shot/pass_table.h"

namespace aa {
namespace {
using json = nlohmann::ordered_json;

constexpr int kMostWidth = 960, kMostHeight = 540;
constexpr size_t kMostBytes = 11'000'000;  // a third more in base64: the page stays near 15 MB

json rectangle(const Window& w) { return {w.x, w.y, w.width, w.height}; }

// The shown part of a frame: all of it, or the most telling window when it is too large to embed.
Window shownPart(const Pictures& p) {
    const int w = p.methods[0].width(), h = p.methods[0].height();
    const Window whole{0, 0, std::min(w, kMostWidth), std::min(h, kMostHeight)};
    if (whole.width == w && whole.height == h) return whole;
    const auto windows = mostTellingWindows(p, whole.width, whole.height, 1);
    return windows.empty() ? whole : windows[0];
}
Pictures part(const Pictures& p, const Window& w) {
    Pictures cut{.frame = p.frame, .truth = {}, .methods = {}};
    if (p.region) {
        const int x = std::max(p.region->x, w.x), y = std::max(p.region->y, w.y);
        cut.region = {x - w.x, y - w.y, std::min(p.region->x + p.region->width, w.x + w.width) - x,
                      std::min(p.region->y + p.region->height, w.y + w.height) - y};
    }
    if (!p.truth.empty()) cut.truth = cropped(p.truth, w);
    for (const Rgb& m : p.methods) cut.methods.push_back(cropped(m, w));
    return cut;
}

// One frame's pictures as the page reads them; `bytes` grows by the size of the files.
json embedded(const Pictures& whole, const Window& window, size_t& bytes) {
    const Pictures p = part(whole, window);
    const auto uri = [&](const Rgb& image) {
        const auto file = pngBytes(image);
        bytes += file.size();
        return "data:image/png;base64," + base64(file);
    };
    json j = {{"frame", p.frame}, {"window", rectangle(window)}, {"truth", nullptr}, {"methods", json::array()}};
    if (!p.truth.empty()) j["truth"] = uri(p.truth);
    for (const Rgb& m : p.methods) j["methods"].push_back(uri(m));
    j["details"] = json::array();
    constexpr int kDetails = 3, kDetailPx = 48;
    for (Window d : mostTellingWindows(p, kDetailPx, kDetailPx, kDetails)) {
        d.x += window.x, d.y += window.y;
        j["details"].push_back(rectangle(d));
    }
    return j;
}
}  // namespace

std::vector<int> framesToShow(const std::vector<int>& withPictures) {
    constexpr size_t kFrames = 4;
    if (withPictures.size() <= kFrames) return {withPictures.rbegin(), withPictures.rend()};
    std::vector<int> chosen;
    for (size_t i = 0; i < kFrames; i++)
        chosen.push_back(withPictures[(withPictures.size() - 1) * (kFrames - 1 - i) / (kFrames - 1)]);
    return chosen;
}

std::vector<unsigned char> pngBytes(const Rgb& encoded) {
    return pngBytes(codesOf(encoded), encoded.width(), encoded.height(), {.compressionLevel = 9});
}
std::string base64(const std::vector<unsigned char>& bytes) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (size_t i = 0; i < bytes.size(); i += 3) {
        const auto byte = [&](size_t k) { return k < bytes.size() ? uint32_t(bytes[k]) : 0u; };
        const uint32_t group = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
        for (int digit = 0; digit < 4; digit++)
            text += i + size_t(digit) > bytes.size() ? '=' : kDigits[group >> (18 - 6 * digit) & 63];
    }
    return text;
}

std::string reportHtml(const RunResults& run, const std::vector<Pictures>& pictures, const std::string& angles) {
    json data = {{"run", json::parse(toJsonText(run))}, {"order", presentationOrder(run)}, {"words", captions(run)}};
    data["protocol"] = inWords(run.protocol);
    data["space"] = spaceInWords(run.protocol);
    data["reference"] = referenceInWords(run.protocol);
    data["region"] = run.protocol.region ? json(inWords(*run.protocol.region)) : json(nullptr);
    for (auto& m : data["run"]["methods"]) m.erase("tileSquares");  // the page has no use for them
    data["errorScale"] = kErrorScale;
    constexpr int kColours = 256;
    for (int i = 0; i < kColours; i++) {
        const Colour c = errorColour(double(i) / (kColours - 1));
        data["errorColours"].push_back(
            {int(std::lround(255 * c[0])), int(std::lround(255 * c[1])), int(std::lround(255 * c[2]))});
    }
    data["figures"] = json::array();
    for (const Figure* f : figuresIn(run))
        if (!f->ofSquares)  // those have columns of their own
            data["figures"].push_back({{"name", f->name},
                                       {"title", f->title},
                                       {"better", f->higherIsBetter ? "high" : "low"},
                                       {"form", f->form == FigureForm::similarity ? "similarity"
                                                : f->form == FigureForm::decibels ? "decibels"
                                                                                  : "significant"}});
    data["passBytes"] = json::object();
    for (const PassInfo& p : allPasses())  // colour is there without any method
        if (p.pass != Pass::color)
            data["passBytes"][std::string(p.name)] = bytesPerPixel(p.pass, size_t(run.subSamples));
    data["publishedMemory"] = json::object();
    for (const MethodDescriptor& m : registry())
        for (const PublishedMemory& p : m.publishedMemory)
            if (p.subSamples == 0 || p.subSamples == run.subSamples)
                data["publishedMemory"][std::string(m.id)] = {{"megabytes", p.megabytes}, {"source", p.source}};
    data["pictures"] = json::array();
    size_t bytes = 0, last = 0;
    for (const Pictures& p : pictures) {
        if (!data["pictures"].empty() && bytes + last > kMostBytes) break;  // the next frame will be about as large
        const size_t before = bytes;
        data["pictures"].push_back(embedded(p, shownPart(p), bytes));
        last = bytes - before;
    }
    return filled(web::html, {{"title", forHtml("AA Resolve: " + run.shot)},
                              {"sliderCss", web::sliderCss},
                              {"css", web::css},
                              {"chart", web::chart},
                              {"slider", web::slider},
                              {"common", web::common},
                              {"js", web::js},
                              {"angles", angles},
                              {"data", forScript(data)}});
}

}  // namespace aa
