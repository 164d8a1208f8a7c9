#include "report/sheet_label.h"

#include <algorithm>
#include <limits>

#include "report/format.h"

namespace aa {
namespace {
using Font = Canvas::Font;
using Align = Canvas::Align;
constexpr int kInset = 14, kValueEnd = 168, kUnitStart = 176, kNamePx = 14;
constexpr const char* kStar = "\u2605";

struct ShownFigure {
    std::string name, key, value, unit;
    bool higherIsBetter;
    double number;
    std::string spread = {};  // over the picture, where it is known
};
// "quartiles 0.0431, 0.0813, 0.145"
std::string spreadOf(const Figure& figure, const RunResults& run, const MethodResult& m) {
    std::string all;
    for (const Figure* f : figuresIn(run))
        if (const auto v = m.pooled->mean.figure(f->name); v && f->spreadOf == figure.name)
            all += (all.empty() ? "quartiles " : ", ") + shortNumber(*v);
    return all;
}
std::optional<double> flickerOf(const RunResults& run, const MethodResult& m) {
    if (!m.temporal) return {};
    const auto flicker = run.isStatic ? m.temporal->flickerStatic : m.temporal->flickerMoving;
    return flicker && (*flicker > 0 || !run.isStatic) ? flicker : std::nullopt;
}
// Figures in the order of rows, but the gain, which is PSNR once more.
std::vector<ShownFigure> figuresOf(const RunResults& run, const MethodResult& m) {
    std::vector<ShownFigure> all;
    if (m.pooled && !run.isReference(m)) {
        const double psnr = m.pooled->mean.psnr;
        all.push_back({"PSNR", "psnr", decibelNumber(psnr), "dB", true, psnr});
        for (const Figure* f : figuresIn(run))
            if (const auto v = m.pooled->mean.figure(f->name); v && !f->ofSquares && f->spreadOf.empty())
                all.push_back({std::string(f->title), std::string(f->name), shown(*f, *v), "", f->higherIsBetter, *v,
                               spreadOf(*f, run, m)});
    }
    if (m.nsPerPixel > 0) all.push_back({"time", "time", shortNumber(m.nsPerPixel), "ns/px", false, m.nsPerPixel});
    if (m.deviceSecondsMedian)
        all.push_back({run.device->isSoftware() ? "software" : "GPU", "device",
                       shortNumber(1e3 * *m.deviceSecondsMedian), "ms", false, *m.deviceSecondsMedian});
    if (const auto flicker = flickerOf(run, m))
        all.push_back({"flicker", "flicker", shortNumber(*flicker), "codes", false, *flicker});
    if (m.temporal && m.temporal->ghostExcess && m.id != "noaa")
        all.push_back(
            {"ghosts", "ghosts", shortNumber(*m.temporal->ghostExcess), "x noaa", false, *m.temporal->ghostExcess});
    return all;
}
// What no anti-aliasing costs is no feat; the sheet's foot says so.
bool competes(const MethodResult& m, const std::string& key) {
    return m.id != "noaa" || (key != "time" && key != "device");
}
// "95 %: +3.02 to +3.40", "no interval"; empty without noaa.
std::string gainInterval(const RunResults& run, size_t method) {
    const auto noaa = noaaOf(run);
    const auto c = noaa ? compared(run, method, *noaa) : std::nullopt;
    if (!c) return {};
    const std::string words = intervalInBrackets(*c);
    return words.substr(1, words.size() - 2);
}
// A method is better or worse than no anti-aliasing where that is resolved, by the rule of the report's tables.
Colour toneOf(bool resolved, bool better, const Theme& theme) {
    return !resolved ? theme.ink : better ? theme.better : theme.worse;
}
Colour gainTone(const RunResults& run, size_t method, const Theme& theme) {
    const auto noaa = noaaOf(run);
    const auto c = noaa ? compared(run, method, *noaa) : std::nullopt;
    return toneOf(c && c->resolved, *run.methods[method].pooled->gainDb >= 0, theme);
}
Colour ghostTone(const RunResults& run, size_t method, const Theme& theme) {
    const auto noaa = noaaOf(run);
    const auto pair = std::find_if(run.pairs.begin(), run.pairs.end(), [&](const PairResult& p) {
        return noaa && std::minmax(p.first, p.second) == std::minmax(method, *noaa);
    });
    const bool resolved = pair != run.pairs.end() && pair->ghost && pair->ghost->resolved;
    return toneOf(resolved, *run.methods[method].temporal->ghostExcess <= 1, theme);
}
}  // namespace

SheetMethods sheetMethods(const RunResults& run, const std::vector<size_t>& order) {
    SheetMethods methods{run, order, {}, {}};
    struct Top {
        double number;
        std::string text;
        int count;
    };
    std::map<std::string, Top> tops;
    for (const size_t i : order) {
        const MethodResult& m = run.methods[i];
        for (const ShownFigure& s : figuresOf(run, m)) {
            methods.figures.insert(s.key);
            if (!competes(m, s.key) || s.number != s.number) continue;
            auto [top, isNew] = tops.try_emplace(s.key, Top{s.number, s.value, 0});
            top->second.count++;
            if (s.higherIsBetter ? s.number > top->second.number : s.number < top->second.number)
                top->second.number = s.number, top->second.text = s.value;
        }
    }
    for (const auto& [key, top] : tops)
        if (top.count > 1) methods.best[key] = top.text;
    return methods;
}

void SheetLabel::text(const std::string& text, int sizePx, Colour colour, bool bold) {
    for (const auto& part : pen_->wrapped(text, width_ - 2 * kInset + 2, sizePx, bold ? Font::bold : Font::regular))
        lines_.push_back({part, "", "", colour, sizePx, sizePx + (sizePx > 15 ? 4 : 5), bold});
}
void SheetLabel::figure(const std::string& name, const std::string& value, const std::string& unit, Colour colour,
                        bool best) {
    const int size = name == "PSNR" ? 20 : 16;
    const int room = kValueEnd - kInset - pen_->textWidth(value, size, size > 16 ? Font::bold : Font::regular) - 8;
    const bool beside = pen_->textWidth(name, kNamePx) <= room;
    if (!beside) text(name, kNamePx, theme_->quiet);
    lines_.push_back({beside ? name : "", value, unit, colour, size, 23, size > 16, best});
}
// Under the figure before it.
void SheetLabel::small(const std::string& words) {
    lines_.back().stepPx = 19;
    text(words, 13, theme_->quiet);
    lines_.back().stepPx = 21;
}
// The parameters or the stages on lines of their own: smaa1x / preset=ULTRA, accumReject / +fill=smaa1x.
void SheetLabel::names(const MethodResult& m, int sizePx) {
    const size_t cut = m.text.find_first_of(":+");
    const std::string id = m.text.substr(0, cut);
    constexpr int kLeastPx = 12;  // smaller rather than broken
    while (sizePx > kLeastPx && pen_->textWidth(id, sizePx, Font::bold) > width_ - 2 * kInset + 2) sizePx--;
    text(id, sizePx, theme_->ink, true);
    if (cut != std::string::npos)
        text(m.text.substr(m.text[cut] == ':' ? cut + 1 : cut), std::min(sizePx, 14), theme_->ink);
}

SheetLabel SheetLabel::full(const SheetMethods& methods, size_t place, int width, const Theme& theme,
                            const Canvas& pen) {
    const MethodResult& m = methods.at(place);
    SheetLabel label(width, theme, pen);
    label.names(m, 20);
    label.text(m.title, 13, theme.quiet);
    label.lines_.back().stepPx += 8;
    if (methods.run.isReference(m)) label.text("the reference of the others", 14, theme.note);
    for (const ShownFigure& s : figuresOf(methods.run, m)) {
        const auto best = methods.best.find(s.key);
        const bool isBest = best != methods.best.end() && best->second == s.value && competes(m, s.key);
        const Colour colour = s.key == "ghosts" ? ghostTone(methods.run, methods.order[place], theme) : theme.ink;
        label.figure(s.name, s.value, s.unit, colour, isBest);
        if (!s.spread.empty()) label.small(s.spread);
        if (s.key != "psnr" || !m.pooled->gainDb || m.id == "noaa") continue;
        label.figure("over noaa", signedDecibelNumber(*m.pooled->gainDb), "dB",
                     gainTone(methods.run, methods.order[place], theme), false);
        if (const std::string interval = gainInterval(methods.run, methods.order[place]); !interval.empty())
            label.small(interval);
    }
    if (place > 0)
        if (const auto c = compared(methods.run, methods.order[place - 1], methods.order[place]); c && !c->resolved)
            label.text("not resolved from the row above", 13, theme.note);
    return label;
}

SheetLabel SheetLabel::brief(const SheetMethods& methods, size_t place, int width, const Theme& theme,
                             const Canvas& pen) {
    const MethodResult& m = methods.at(place);
    SheetLabel label(width, theme, pen);
    label.names(m, 17);
    if (methods.run.isReference(m)) {
        label.text("the reference of the others", 14, theme.note);
    } else if (m.pooled) {
        const std::string psnr = decibelNumber(m.pooled->mean.psnr);
        const auto best = methods.best.find("psnr");
        label.text(psnr + " dB" + (best != methods.best.end() && best->second == psnr ? std::string(" ") + kStar : ""),
                   14, theme.ink);
        if (m.pooled->gainDb && m.id != "noaa")
            label.text(signedDecibelNumber(*m.pooled->gainDb) + " dB over noaa", 13,
                       gainTone(methods.run, methods.order[place], theme));
    }
    return label;
}
SheetLabel SheetLabel::words(const std::string& name, const std::vector<std::string>& lines, int width,
                             const Theme& theme, const Canvas& pen) {
    SheetLabel label(width, theme, pen);
    label.text(name, lines.size() > 1 ? 20 : 17, theme.ink, true);
    label.lines_.back().stepPx += 2;
    for (const auto& line : lines) label.text(line, 14, theme.quiet);
    return label;
}

int SheetLabel::height() const {
    int height = 20;
    for (const Line& l : lines_) height += l.stepPx;
    return height;
}
void SheetLabel::draw(Canvas& canvas, int x, int y) const {
    y += 10;
    for (const Line& l : lines_) {
        const Font font = l.bold ? Font::bold : Font::regular;
        const int base = y + l.sizePx;
        y += l.stepPx;
        if (l.value.empty()) {
            canvas.text(x + kInset, base, l.name, l.sizePx, l.colour, font);
            continue;
        }
        canvas.text(x + kInset, base, l.name, kNamePx, theme_->quiet);
        canvas.text(x + kValueEnd, base, l.value, l.sizePx, l.colour, font, Align::right);
        canvas.text(x + kUnitStart, base, l.unit, kNamePx, theme_->quiet);
        if (l.best)
            canvas.text(x + kUnitStart + (l.unit.empty() ? 0 : canvas.textWidth(l.unit, kNamePx) + 8), base, kStar, 15,
                        theme_->note);
    }
}

}  // namespace aa
