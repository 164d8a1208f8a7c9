#include "report/sheet.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "metrics/maps.h"
#include "report/canvas.h"
#include "report/format.h"

namespace aa {
namespace {
using Font = Canvas::Font;
using Align = Canvas::Align;

// A neutral dark ground: colour judgements need grey around the pictures.
constexpr Colour kGround{0.105f, 0.105f, 0.108f}, kPanel{0.150f, 0.150f, 0.154f}, kInk{0.925f, 0.925f, 0.92f},
    kQuiet{0.60f, 0.60f, 0.61f}, kBetter{0.55f, 0.83f, 0.60f}, kWorse{0.93f, 0.56f, 0.50f}, kNote{0.90f, 0.76f, 0.42f};
constexpr Colour kDetail[] = {{0.30f, 0.78f, 0.95f}, {0.98f, 0.72f, 0.25f}, {0.93f, 0.45f, 0.75f}};

constexpr int kMargin = 28, kGap = 14, kLabelWidth = 282, kHeader = 92, kColumnHead = 34, kFooter = 52;
constexpr int kFrameWidth = 480, kFrameHeight = 320;  // at most; larger frames are shrunk
constexpr int kDetails = 3, kDetailPx = 48;           // wanted size of a detail in the frame's pixels

struct Layout {
    int frameWidth, frameHeight, magnification;  // of the full frame; magnification 0 = shrunk
    int detailSource, detailMagnification;       // px of the frame, px of the sheet per px
    int rowHeight;
    std::vector<Window> details;
    bool errors, overTime;  // overTime: figures of flicker and ghosts in the rows
    int detailSide() const { return detailSource * detailMagnification; }
    int frameX() const { return kMargin + kLabelWidth + kGap; }
    int detailX(size_t i) const { return frameX() + frameWidth + kGap + int(i) * (detailSide() + kGap); }
    int errorX() const { return detailX(details.size()); }
    int width() const { return errors ? errorX() + frameWidth + kMargin : errorX() - kGap + kMargin; }
};

Layout layoutOf(const RunResults& run, const Pictures& p) {
    Layout l{};
    l.errors = !p.truth.empty();
    l.overTime = std::any_of(run.methods.begin(), run.methods.end(), [](const auto& m) { return m.temporal; });
    const int w = run.width, h = run.height;
    l.magnification = std::min(kFrameWidth / w, kFrameHeight / h);
    if (l.magnification > 0) {
        l.frameWidth = w * l.magnification, l.frameHeight = h * l.magnification;
    } else {
        const double scale = std::min(double(kFrameWidth) / w, double(kFrameHeight) / h);
        l.frameWidth = std::max(1, int(std::lround(w * scale))),
        l.frameHeight = std::max(1, int(std::lround(h * scale)));
    }
    const int side = std::clamp(l.frameHeight, 216, 288);
    l.detailMagnification = std::max(1, (side + kDetailPx / 2) / kDetailPx);
    const Window judged = p.region.value_or(Window{0, 0, w, h});
    l.detailSource = std::min({side / l.detailMagnification, judged.width, judged.height});
    l.detailMagnification = side / l.detailSource;
    l.details = mostTellingWindows(p, l.detailSource, l.detailSource, kDetails);
    l.rowHeight = std::max({l.frameHeight, l.details.empty() ? 0 : l.detailSide(), l.overTime ? 264 : 216});
    return l;
}

// Whole or shrunk, by the layout.
Rgb fullFrame(const Rgb& image, const Layout& l, const Exec& exec) {
    return l.magnification > 0 ? image : shrunk(image, l.frameWidth, l.frameHeight, exec);
}
class Sheet {
  public:
    Sheet(const RunResults& run, const Pictures& pictures, const Exec& exec)
        : run_(run),
          pictures_(pictures),
          exec_(exec),
          order_(presentationOrder(run)),
          layout_(layoutOf(run, pictures)),
          canvas_(std::max(layout_.width(), 1100),
                  kHeader + kColumnHead + int(order_.size() + (layout_.errors ? 1 : 0)) * (layout_.rowHeight + kGap) +
                      kFooter,
                  kGround) {}

    void write(const std::filesystem::path& file) {
        header();
        columnHeads();
        int y = kHeader + kColumnHead;
        if (layout_.errors) {
            truthRow(y);
            y += layout_.rowHeight + kGap;
        }
        for (size_t i = 0; i < order_.size(); i++, y += layout_.rowHeight + kGap) methodRow(i, y);
        footer(y);
        canvas_.writePng(file);
    }

  private:
    void header() {
        canvas_.text(kMargin, 46, run_.shot, 30, kInk, Font::bold);
        const int after = kMargin + canvas_.textWidth(run_.shot, 30, Font::bold) + 22;
        canvas_.text(after, 46,
                     canvas_.fitted("anti-aliasing methods against " + referenceInWords(run_.protocol),
                                    canvas_.width() - after - kMargin, 19),
                     19, kQuiet);
        canvas_.text(kMargin, 76, canvas_.fitted(runLine(run_), canvas_.width() - 2 * kMargin, 15), 15, kQuiet);
    }
    void columnHeads() {
        const int y = kHeader + 20;
        int judged = 0;
        for (const auto& m : run_.methods)
            if (m.pooled) judged = m.pooled->frames;
        head(kMargin, kLabelWidth, y, judged > 1 ? "figures over " + std::to_string(judged) + " frames" : "figures");
        std::string frame = "frame " + std::to_string(pictures_.frame);
        if (layout_.magnification > 1) frame += ", x" + std::to_string(layout_.magnification);
        if (layout_.magnification == 0) frame += ", shrunk to " + std::to_string(layout_.frameWidth) + " px";
        head(layout_.frameX(), layout_.frameWidth, y, frame);
        for (size_t i = 0; i < layout_.details.size(); i++) {
            const Window& d = layout_.details[i];
            canvas_.fill({layout_.detailX(i), y - 11, 12, 12}, kDetail[i]);
            canvas_.text(layout_.detailX(i) + 20, y,
                         canvas_.fitted("at " + std::to_string(d.x) + ", " + std::to_string(d.y) + "  x" +
                                            std::to_string(layout_.detailMagnification),
                                        layout_.detailSide() - 20, 15),
                         15, kQuiet);
        }
        if (layout_.errors) head(layout_.errorX(), layout_.frameWidth, y, "error");
    }
    void head(int x, int width, int y, const std::string& text) {
        canvas_.text(x, y, canvas_.fitted(text, width, 15), 15, kQuiet);
    }
    void pictureCells(const Rgb& image, int y) {
        const Rgb full = fullFrame(image, layout_, exec_);
        const int top = y + (layout_.rowHeight - layout_.frameHeight) / 2;
        canvas_.draw(full, layout_.frameX(), top, std::max(1, layout_.magnification));
        const double scale = double(layout_.frameWidth) / run_.width;
        const auto inFrame = [&](const Window& w) {
            return Window{layout_.frameX() + int(w.x * scale), top + int(w.y * scale),
                          std::max(1, int(w.width * scale)), std::max(1, int(w.height * scale))};
        };
        if (pictures_.region) canvas_.frame(inFrame(*pictures_.region), kInk, 1);
        for (size_t i = 0; i < layout_.details.size(); i++) {
            const Window& d = layout_.details[i];
            canvas_.frame(inFrame(d), kDetail[i], 1);
            const Window cell{layout_.detailX(i), y + (layout_.rowHeight - layout_.detailSide()) / 2,
                              layout_.detailSide(), layout_.detailSide()};
            canvas_.draw(cropped(image, d), cell.x, cell.y, layout_.detailMagnification);
            canvas_.fill({cell.x, cell.y + cell.height, cell.width, 3}, kDetail[i]);
        }
    }
    void truthRow(int y) {
        panel(y);
        const std::string& method = run_.protocol.reference;
        canvas_.text(kMargin + 14, y + 32, method.empty() ? "Ground truth" : "Reference", 20, kInk, Font::bold);
        int line = y + 60;
        const auto put = [&](const std::string& text) {
            canvas_.text(kMargin + 14, line, canvas_.fitted(text, kLabelWidth - 24, 14), 14, kQuiet);
            line += 22;
        };
        if (!method.empty()) {
            put(method);
            put("a method of this run, not the truth");
        } else {
            put(run_.truthSamplesPerHalf > 0 ? "2 x " + std::to_string(run_.truthSamplesPerHalf) + " samples per pixel"
                                             : "exact coverage");
            if (!run_.truthFilter.empty())
                put(run_.truthFilter + " filter, " + shortNumber(run_.truthFilterWidthPx) + " px");
        }
        if (run_.truthNoise && *run_.truthNoise > 0) {
            put("error bar of the MSE " + significant(*run_.truthNoise));
            put("(as PSNR " + decibels(psnr(*run_.truthNoise)) + ")");
        }
        pictureCells(pictures_.truth, y);
        colourBar(y);
    }
    // The one scale of all error maps, in the truth's own error cell.
    void colourBar(int y) {
        const int x = layout_.errorX(), width = layout_.frameWidth;
        const int barX = x + std::min(24, width / 10), barWidth = width - 2 * std::min(24, width / 10),
                  barY = y + layout_.rowHeight / 2 - 12;
        for (int i = 0; i < barWidth; i++) canvas_.fill({barX + i, barY, 1, 24}, errorColour((i + 0.5) / barWidth));
        canvas_.frame({barX, barY, barWidth, 24}, kQuiet, 1);
        constexpr int kTicks = 4;
        for (int i = 0; i <= kTicks; i++) {
            const int tick = barX + i * (barWidth - 1) / kTicks;
            canvas_.fill({tick, barY + 25, 1, 6}, kQuiet);
            if (width < 240 && i % kTicks) continue;
            canvas_.text(tick, barY + 48, (i == kTicks ? ">= " : "") + shortNumber(kErrorScale * i / kTicks), 14, kInk,
                         Font::regular,
                         i == 0        ? Align::left
                         : i == kTicks ? Align::right
                                       : Align::centre);
        }
        canvas_.text(barX, barY - 14,
                     canvas_.fitted("error per pixel, " + spaceInWords(run_.protocol) + " 0 to 1", barWidth, 15), 15,
                     kInk);
        canvas_.text(barX, barY + 76, canvas_.fitted("RMS over R, G, B; the same scale on every sheet", barWidth, 14),
                     14, kQuiet);
    }
    void panel(int y) { canvas_.fill({kMargin, y, kLabelWidth, layout_.rowHeight}, kPanel); }
    void methodRow(size_t place, int y) {
        const MethodResult& m = run_.methods[order_[place]];
        panel(y);
        // The parameters or the stages on a line of their own: smaa1x / preset=ULTRA, accumReject / +fill=smaa1x.
        const size_t cut = m.text.find_first_of(":+");
        const int width = kLabelWidth - 26;
        canvas_.text(kMargin + 14, y + 32, canvas_.fitted(m.text.substr(0, cut), width, 20, Font::bold), 20, kInk,
                     Font::bold);
        int line = y + 54;
        if (cut != std::string::npos) {
            const std::string rest = m.text.substr(m.text[cut] == ':' ? cut + 1 : cut);
            canvas_.text(kMargin + 14, line, canvas_.fitted(rest, width, 14), 14, kInk);
            line += 20;
        }
        canvas_.text(kMargin + 14, line, canvas_.fitted(m.title, width, 13), 13, kQuiet);
        line += 34;
        const auto figure = [&](const char* name, const std::string& value, const std::string& unit, Colour colour,
                                int size) {
            canvas_.text(kMargin + 14, line, name, 14, kQuiet);
            canvas_.text(kMargin + 168, line, value, size, colour, size > 16 ? Font::bold : Font::regular,
                         Align::right);
            canvas_.text(kMargin + 176, line, unit, 14, kQuiet);
            line += layout_.overTime ? 22 : 25;
        };
        if (run_.isReference(m)) {
            canvas_.text(kMargin + 14, line, "the reference of the others", 14, kNote);
            line += 25;
        }
        if (m.pooled) {
            figure("PSNR", decibelNumber(m.pooled->mean.psnr), "dB", kInk, 20);
            if (m.pooled->gainDb && m.id != "noaa")
                figure("over noaa", signedDecibelNumber(*m.pooled->gainDb), "dB",
                       *m.pooled->gainDb >= 0 ? kBetter : kWorse, 16);
            figure("SSIM", similarity(m.pooled->mean.others.at("ssimLuma")), "", kInk, 16);
        }
        if (m.nsPerPixel > 0) figure("time", shortNumber(m.nsPerPixel), "ns/px", kInk, 16);
        if (m.deviceSecondsMedian)
            figure(run_.device->isSoftware() ? "software" : "GPU", shortNumber(1e3 * *m.deviceSecondsMedian), "ms",
                   kInk, 16);
        if (m.temporal) {
            const auto flicker = run_.isStatic ? m.temporal->flickerStatic : m.temporal->flickerMoving;
            if (flicker && (*flicker > 0 || !run_.isStatic))
                figure("flicker", shortNumber(*flicker), "codes", kInk, 16);
            if (m.temporal->ghostExcess && m.id != "noaa")
                figure("ghosts", shortNumber(*m.temporal->ghostExcess), "x noaa",
                       *m.temporal->ghostExcess <= 1 ? kBetter : kWorse, 16);
        }
        if (place > 0)
            if (const Comparison* c = comparisonOf(run_, order_[place - 1], order_[place]); c && !c->resolved)
                canvas_.text(kMargin + 14, line, canvas_.fitted("not resolved from the row above", width, 13), 13,
                             kNote);
        pictureCells(pictures_.methods[order_[place]], y);
        if (layout_.errors) errorCell(pictures_.methods[order_[place]], y);
    }
    void errorCell(const Rgb& image, int y) {
        PlaneF error = errorMap(image, pictures_.truth);
        if (layout_.magnification == 0) error = shrunk(error, layout_.frameWidth, layout_.frameHeight);
        canvas_.draw(colouredError(error), layout_.errorX(), y + (layout_.rowHeight - layout_.frameHeight) / 2,
                     std::max(1, layout_.magnification));
    }
    void footer(int y) {
        std::string text = "Best PSNR first, noaa last. Details: unfiltered pixels, where the methods differ most. ";
        if (layout_.errors) text += "Figures and errors: " + inWords(run_.protocol) + ". ";
        if (layout_.overTime)
            text += run_.isStatic
                        ? "Flicker: spread over time, 8-bit codes."
                        : "Flicker along the motion in 8-bit codes; ghosts: error where something came into view.";
        canvas_.text(kMargin, y + 24, canvas_.fitted(text, canvas_.width() - 2 * kMargin - 220, 14), 14, kQuiet);
        canvas_.text(canvas_.width() - kMargin, y + 24, "AA Resolve " + run_.programVersion, 14, kQuiet, Font::regular,
                     Align::right);
    }

    const RunResults& run_;
    const Pictures& pictures_;
    Exec exec_;
    std::vector<size_t> order_;
    Layout layout_;
    Canvas canvas_;
};
}  // namespace

std::vector<size_t> presentationOrder(const RunResults& run) {
    std::vector<size_t> order(run.methods.size());
    for (size_t i = 0; i < order.size(); i++) order[i] = i;
    const auto rank = [&](size_t i) {
        const MethodResult& m = run.methods[i];
        if (m.id == "noaa") return -std::numeric_limits<double>::infinity();
        return m.pooled ? m.pooled->mean.psnr : -1e300;
    };
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return rank(a) > rank(b); });
    return order;
}

void writeSheet(const RunResults& run, const Pictures& pictures, const std::filesystem::path& file, const Exec& exec) {
    Sheet(run, pictures, exec).write(file);
}

}  // namespace aa
