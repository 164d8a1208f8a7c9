#include "report/angles.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "image/formatted.h"
#include "image/json_text.h"
#include "image/markup.h"
#include "report/page.h"
#include "report/web/web_files.h"

namespace aa {
namespace {
using json = nlohmann::ordered_json;

double psnrOf(double mse) { return -10 * std::log10(mse); }

}  // namespace

std::string toJsonText(const AngleStudy& s) {
    json j = {{"format", "aaresolve-angles"}, {"version", 1},       {"sizePx", s.sizePx},  {"offsets", s.offsets},
              {"jitter", s.jitter},           {"frames", s.frames}, {"degrees", s.degrees}};
    for (const double mse : s.noaaMse) j["noaaPsnr"].push_back(psnrOf(mse));
    j["methods"] = json::array();
    for (size_t m = 0; m < s.methods.size(); m++) {
        json method = {{"text", s.methods[m].text},
                       {"title", s.methods[m].title},
                       {"family", s.methods[m].family},
                       {"subsamples", s.methods[m].subsamples}};
        for (size_t k = 0; k < s.degrees.size(); k++) {
            method["psnr"].push_back(psnrOf(s.methods[m].mse[k]));
            method["gainDb"].push_back(s.gainDb(m, k));
        }
        method["pooledGainDb"] = s.pooledGainDb(m);
        method["mirrorDb"] = s.mirrorAsymmetryDb(m);
        method["turnDb"] = s.turnAsymmetryDb(m);
        j["methods"].push_back(std::move(method));
    }
    return jsonText(j);
}

std::string toCsvText(const AngleStudy& s) {
    std::string text = "degrees,noaaPsnr";
    for (const auto& m : s.methods) text += ",\"" + m.text + "\"";
    text += "\n";
    for (size_t k = 0; k < s.degrees.size(); k++) {
        text += formatted("%.6g,%.6g", s.degrees[k], psnrOf(s.noaaMse[k]));
        for (size_t m = 0; m < s.methods.size(); m++) text += formatted(",%.6g", s.gainDb(m, k));
        text += "\n";
    }
    return text;
}

std::string toSvgText(const AngleStudy& s) {
    static const char* const hues[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                       "#e69f00", "#56b4e9", "#7f7f7f", "#b8a800"};  // [Okabe 2008]
    static const char* const dashes[] = {"", " stroke-dasharray=\"6 3\"", " stroke-dasharray=\"2 2\""};
    constexpr int kWidth = 900, kHeight = 420, kLeft = 60, kRight = 20, kTop = 40, kBottom = 50, kLine = 18;
    const int rows = (int(s.methods.size()) + 2) / 3, height = kHeight + kLine * rows;
    double low = 0, high = 1;
    for (size_t m = 0; m < s.methods.size(); m++)
        for (size_t k = 0; k < s.degrees.size(); k++) {
            const double g = s.gainDb(m, k);
            if (!std::isfinite(g)) continue;
            low = std::min(low, std::floor(g)), high = std::max(high, std::ceil(g));
        }
    const auto px = [&](double degrees) { return kLeft + degrees / 360 * (kWidth - kLeft - kRight); };
    const auto py = [&](double gain) { return kTop + (high - gain) / (high - low) * (kHeight - kTop - kBottom); };
    std::string text = formatted(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" font-family=\"sans-serif\" font-size=\"12\">\n"
        "<rect width=\"%d\" height=\"%d\" fill=\"#fff\"/>\n"
        "<text x=\"%d\" y=\"24\" font-size=\"15\">PSNR gain over no anti-aliasing by the direction of an edge</text>\n",
        kWidth, height, kWidth, height, kLeft);
    const double step = high - low > 16 ? 4 : high - low > 8 ? 2 : 1;
    for (double g = std::ceil(low / step) * step; g <= high; g += step)
        text += formatted(
            "<path d=\"M%d %.1fH%d\" stroke=\"%s\"/><text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%g</text>\n", kLeft,
            py(g), kWidth - kRight, g == 0 ? "#888" : "#ddd", kLeft - 6, py(g) + 4, g);
    for (int a = 0; a <= 360; a += 45)
        text += formatted(
            "<path d=\"M%.1f %dV%d\" stroke=\"#ddd\"/><text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%d</text>\n",
            px(a), kTop, kHeight - kBottom, px(a), kHeight - kBottom + 16, a);
    text += formatted(
        "<text x=\"%d\" y=\"%d\" text-anchor=\"middle\">direction of the edge's normal, degrees</text>\n"
        "<text transform=\"translate(18 %d) rotate(-90)\" text-anchor=\"middle\">gain, dB</text>\n",
        (kLeft + kWidth - kRight) / 2, kHeight - 14, (kTop + kHeight - kBottom) / 2);
    for (size_t m = 0; m < s.methods.size(); m++) {
        const std::string look =
            formatted("fill=\"none\" stroke=\"%s\" stroke-width=\"1.6\"%s", hues[m % 8], dashes[m / 8 % 3]);
        text += "<path " + look + " d=\"";
        bool pen = false;
        for (size_t k = 0; k < s.degrees.size(); k++) {
            const double g = s.gainDb(m, k);
            if (std::isfinite(g)) text += formatted("%c%.1f %.1f", pen ? 'L' : 'M', px(s.degrees[k]), py(g));
            pen = std::isfinite(g);
        }
        const int x = kLeft + int(m) % 3 * 280, y = kHeight + int(m) / 3 * kLine;
        text += formatted("\"/>\n<path %s d=\"M%d %dh26\"/>", look.c_str(), x, y - 4);
        text += formatted("<text x=\"%d\" y=\"%d\">", x + 32, y) + forMarkup(s.methods[m].text) + "</text>\n";
    }
    return text + "</svg>\n";
}

std::string anglesForReport(const std::filesystem::path& folder) {
    return sectionOf({"angles.json", "aaresolve-angles", "angles", "angles-data", web::angles}, folder);
}

}  // namespace aa
