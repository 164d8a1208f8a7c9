#include "report/html.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "image/colour_map.h"
#include "image/png.h"
#include "methods/method.h"
#include "metrics/maps.h"
#include "report/advice.h"
#include "report/caption.h"
#include "report/format.h"
#include "report/page.h"
#include "report/sheet.h"
#include "report/web/web_files.h"
#include "shot/pass_table.h"

namespace aa {
namespace {
using json = nlohmann::ordered_json;

// The viewer's scripts, each an element of its own, so that an error names the file's line.
std::string viewerScripts() {
    std::string text;
    for (const std::string_view file : {web::viewerCodec, web::viewerPictures, web::viewerMeasure, web::viewerFlip,
                                        web::viewerPaint, web::viewerState, web::viewerStage, web::viewerInput,
                                        web::viewerFigures, web::viewerControls, web::viewerCrops, web::viewerMain})
        text += "<script>" + std::string(file) + "</script>\n";
    return text;
}
}  // namespace

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

std::string reportHtml(const RunResults& run, const ViewerData& viewer, const std::string& sections) {
    json data = {{"run", json::parse(toJsonText(run))}, {"order", presentationOrder(run)}, {"words", captions(run)}};
    data["protocol"] = inWords(run.protocol);
    data["space"] = spaceInWords(run.protocol);
    data["reference"] = referenceInWords(run.protocol);
    data["region"] = run.protocol.region ? json(inWords(*run.protocol.region)) : json(nullptr);
    for (auto& m : data["run"]["methods"]) m.erase("tileSquares");  // the page has no use for them
    data["errorScale"] = kErrorScale;
    data["errorColours"] = errorColoursJson();
    data["figures"] = json::array();
    for (const Figure* f : figuresIn(run))
        if (!f->ofSquares && f->spreadOf.empty())  // those of squares have columns of their own
            data["figures"].push_back(figureJson(*f));
    for (const Figure* f : figuresIn(run))
        if (!f->spreadOf.empty())
            for (json& shown : data["figures"])
                if (shown["name"] == f->spreadOf) shown["spread"].push_back(f->name);
    data["advice"] = adviceInWords(run);
    data["publishedMemory"] = json::object();
    for (const MethodDescriptor& m : registry())
        for (const PublishedMemory& p : m.publishedMemory)
            if (p.subSamples == 0 || p.subSamples == run.subSamples)
                data["publishedMemory"][std::string(m.id)] = {{"megabytes", p.megabytes}, {"source", p.source}};
    data["viewer"] = viewerJson(viewer, run, {});
    return filled(web::html, {{"head", pageHead("AA Resolve: " + run.shot, {web::css, web::viewerCss})},
                              {"chart", web::chart},
                              {"common", web::common},
                              {"tables", web::tables},
                              {"viewer", viewerScripts()},
                              {"js", web::js},
                              {"sections", sections},
                              {"data", forScript(data)},
                              {"pictures", viewerElements(viewer)}});
}

}  // namespace aa
