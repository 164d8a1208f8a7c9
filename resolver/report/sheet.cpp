#include "report/sheet.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "image/error.h"
#include "report/format.h"
#include "report/sheet_label.h"
#include "report/sheet_layout.h"

namespace aa {
namespace {
using Font = Canvas::Font;
using Align = Canvas::Align;
constexpr int kLabelWidth = 282, kHeadPx = 15, kHeadStep = 20;
constexpr int kWidest = 2560;  // px of a free sheet's columns, before they go below each other

std::string frameWord(int frame) { return "frame " + std::to_string(frame); }
std::string placeOf(const Crop& crop) {
    return "at " + std::to_string(crop.window.x) + ", " + std::to_string(crop.window.y);
}
std::string nameOf(const Crop& crop, int magnification) {
    return (crop.label.empty() ? "" : crop.label + ", ") + placeOf(crop) + "  x" + std::to_string(magnification);
}
std::vector<Window> windowsOf(const std::vector<Crop>& crops) {
    std::vector<Window> all;
    for (const Crop& c : crops) all.push_back(c.window);
    return all;
}
std::vector<Crop> cropsOf(const Pictures& p, const SheetOptions& o, int most) {
    if (!o.crops.empty()) return o.crops;
    std::vector<Crop> crops;
    for (const Window& w : tellingCrops(p, most)) crops.push_back({w});
    return crops;
}
// Whether the truth is shown too. A reference method is a row of its own.
bool showsTruth(const Pictures& p) { return !p.truth.empty(); }

std::string titleOf(const RunResults& run) {
    return run.hasFigures() ? "anti-aliasing methods against " + referenceInWords(run.protocol)
                            : "anti-aliasing methods, without a ground truth";
}
bool showsNoaa(const SheetMethods& m) {
    const auto noaa = noaaOf(m.run);
    return noaa && std::find(m.order.begin(), m.order.end(), *noaa) != m.order.end();
}
// `allFigures`: labels show them all, and else PSNR alone.
std::string footOf(const SheetMethods& m, bool allFigures, bool errors, bool ownCrops) {
    const RunResults& run = m.run;
    const bool judged = m.figures.contains("psnr");
    std::string text = judged ? "Best PSNR first. " : "";
    text += std::string("Crops: unfiltered pixels") + (ownCrops ? ". " : ", where the methods differ most. ");
    if (allFigures ? !m.best.empty() : m.best.contains("psnr")) text += "\u2605 best of the methods shown";
    if (allFigures && m.marksTime() && showsNoaa(m)) text += "; of time without noaa, which does nothing";
    if (text.back() != ' ') text += ". ";
    if (judged || errors)
        text += (!errors ? "Figures: " : judged ? "Figures and errors: " : "Errors: ") + inWords(run.protocol) + ". ";
    if (allFigures && judged && run.shownOn) text += "JOD as seen on " + run.shownOn->display + ". ";
    if (allFigures && m.figures.contains("flicker"))
        text += run.isStatic ? "Flicker: spread over time, 8-bit codes. " : "Flicker along the motion in 8-bit codes. ";
    if (allFigures && m.figures.contains("ghosts")) text += "Ghosts: error where something came into view. ";
    return text;
}
SheetLabel truthLabel(const RunResults& run, int width, const Theme& theme, const Canvas& pen, bool brief) {
    const std::string& method = run.protocol.reference;
    std::vector<std::string> lines;
    if (!method.empty()) {
        lines = {method, "a method of this run, not the truth"};
    } else {
        lines.push_back(run.truthSamplesPerHalf > 0
                            ? "2 x " + std::to_string(run.truthSamplesPerHalf) + " samples per pixel"
                            : "exact coverage");
        if (!run.truthFilter.empty())
            lines.push_back(run.truthFilter + " filter, " + shortNumber(run.truthFilterWidthPx) + " px");
    }
    if (brief) return SheetLabel::words(method.empty() ? "Ground truth" : "Reference", {lines[0]}, width, theme, pen);
    if (run.truthNoise && *run.truthNoise > 0) {
        lines.push_back("error bar of the MSE " + significant(*run.truthNoise));
        lines.push_back("(as PSNR " + decibels(psnr(*run.truthNoise)) + ")");
    }
    return SheetLabel::words(method.empty() ? "Ground truth" : "Reference", lines, width, theme, pen);
}

// ---- rows: a method each ----
// The largest value of a map's scale that is drawn as a bar.
std::optional<double> scaleOf(const MapKind& kind) {
    if (kind.name == "error") return kErrorScale;
    if (kind.name == "flip") return 1.0;
    return {};
}

class Rows {
  public:
    Rows(const Shown& shown, int frame, const SheetOptions& o, const Exec& exec)
        : shown_(shown),
          options_(o),
          exec_(exec),
          theme_(sheetTheme(o.light)),
          pen_(1, 1, theme_.ground),
          pictures_(shown.pictures(frame)),
          methods_(sheetMethods(shown.run, shown.order)) {
        if (o.cropColumns) crops_ = cropsOf(pictures_, o, kTellingCrops);
        if (showsTruth(pictures_)) maps_ = o.maps;
        if (maps_.empty() && o.asksForMaps)
            throw InputError("--columns " + std::string(o.maps[0]->name) + ": " + frameWord(frame) +
                             " has no picture of a truth; leave the maps out, or choose another frame");
        const PageFormat format = formatOf(o.page);
        const int room = format.width > 0 ? format.width - 2 * kSheetMargin - kLabelWidth - kSheetGap : 0;
        layout_ = rowLayout({shown.run.width, shown.run.height, o.frameColumn, windowsOf(crops_), int(maps_.size()),
                             o.zoom, int(shown.order.size()) + 1},
                            room, format.name);
        int x = kSheetMargin + kLabelWidth + kSheetGap;
        frameX_ = x;
        if (o.frameColumn) x += layout_.frame.column() + kSheetGap;
        for (const CellSize& c : layout_.crops) cropX_.push_back(x), x += c.column() + kSheetGap;
        for (size_t i = 0; i < maps_.size(); i++) mapX_.push_back(x), x += layout_.mapColumn() + kSheetGap;
    }
    std::vector<Canvas> pages() {
        SheetSection section;
        section.lead.push_back(heads());
        if (showsTruth(pictures_)) {
            const SheetLabel label = truthLabel(shown_.run, kLabelWidth, theme_, pen_, false);
            int scales = 0;
            for (const MapKind* kind : maps_) scales = std::max(scales, scaleHeight(*kind));
            section.lead.push_back(row(label, pictures_.truth, scales, [this](Canvas& canvas, int y, int height) {
                for (size_t i = 0; i < maps_.size(); i++) scale(canvas, *maps_[i], mapX_[i], y, height);
            }));
        }
        for (size_t i = 0; i < methods_.order.size(); i++) {
            const SheetLabel label = SheetLabel::full(methods_, i, kLabelWidth, theme_, pen_);
            const Rgb& image = pictures_.methods[i];
            section.rows.push_back(row(label, image, 0, [this, &image](Canvas& canvas, int y, int height) {
                for (size_t k = 0; k < maps_.size(); k++)
                    drawFrame(canvas, map(*maps_[k], image), mapX_[k], y + (height - layout_.frame.height) / 2);
            }));
        }
        return sheetPages({section}, kLabelWidth + kSheetGap + layout_.width, options_.page, theme_,
                          {shown_.run.shot, titleOf(shown_.run), runLine(shown_.run),
                           footOf(methods_, true, showsTruth(pictures_), !options_.crops.empty())},
                          shown_.run.programVersion);
    }

  private:
    SheetItem heads() {
        struct Head {
            int x;
            std::vector<std::string> lines;
            std::optional<Colour> colour;
        };
        std::vector<Head> all;
        const auto add = [&](int x, int width, const std::string& text, std::optional<Colour> colour = {}) {
            all.push_back({x, pen_.wrapped(text, width - (colour ? 20 : 0), kHeadPx), colour});
        };
        int judged = 0;
        for (const size_t i : methods_.order)
            if (const auto& pooled = shown_.run.methods[i].pooled) judged = pooled->frames;
        add(kSheetMargin, kLabelWidth,
            judged > 1 ? "figures over " + std::to_string(judged) + " frames" : std::string("figures"));
        std::string frame = frameWord(pictures_.frame);
        if (layout_.frame.magnification > 1) frame += ", x" + std::to_string(layout_.frame.magnification);
        if (layout_.frame.magnification == 0) frame += ", shrunk to " + std::to_string(layout_.frame.width) + " px";
        if (options_.frameColumn) add(frameX_, layout_.frame.column(), frame);
        for (size_t i = 0; i < crops_.size(); i++)
            add(cropX_[i], layout_.crops[i].column(), nameOf(crops_[i], layout_.crops[i].magnification),
                theme_.ofCrop(i));
        for (size_t i = 0; i < maps_.size(); i++) add(mapX_[i], layout_.mapColumn(), std::string(maps_[i]->name));
        size_t most = 0;
        for (const Head& h : all) most = std::max(most, h.lines.size());
        return {int(most) * kHeadStep + 14, [all, most, this](Canvas& canvas, int y) {
                    for (const Head& h : all) {
                        int line = y + int(most - h.lines.size()) * kHeadStep + kHeadStep;
                        if (h.colour) canvas.fill({h.x, line - 11, 12, 12}, *h.colour);
                        for (const auto& t : h.lines) {
                            canvas.text(h.x + (h.colour ? 20 : 0), line, t, kHeadPx, theme_.quiet);
                            line += kHeadStep;
                        }
                    }
                }};
    }
    template <class More>
    SheetItem row(const SheetLabel& label, const Rgb& image, int least, More more) {
        const int height = std::max({layout_.height, label.height(), least});
        return {height + kSheetGap, [this, label, &image, more, height](Canvas& canvas, int y) {
                    canvas.fill({kSheetMargin, y, kLabelWidth, height}, theme_.panel);
                    label.draw(canvas, kSheetMargin, y);
                    pictures(canvas, image, y, height);
                    more(canvas, y, height);
                }};
    }
    void drawFrame(Canvas& canvas, const Rgb& image, int x, int y) {
        canvas.draw(image, x, y, std::max(1, layout_.frame.magnification));
    }
    void pictures(Canvas& canvas, const Rgb& image, int y, int height) {
        if (options_.frameColumn) {
            const bool isShrunk = layout_.frame.magnification == 0;
            const int top = y + (height - layout_.frame.height) / 2;
            drawFrame(canvas, isShrunk ? shrunk(image, layout_.frame.width, layout_.frame.height, exec_) : image,
                      frameX_, top);
            const double scale = double(layout_.frame.width) / shown_.run.width;
            const auto inFrame = [&](const Window& w) {
                return Window{frameX_ + int(w.x * scale), top + int(w.y * scale), std::max(1, int(w.width * scale)),
                              std::max(1, int(w.height * scale))};
            };
            if (pictures_.region) canvas.frame(inFrame(*pictures_.region), theme_.ink, 1);
            for (size_t i = 0; i < crops_.size(); i++) canvas.frame(inFrame(crops_[i].window), theme_.ofCrop(i), 1);
        }
        for (size_t i = 0; i < crops_.size(); i++) {
            const CellSize& cell = layout_.crops[i];
            const int top = y + (height - cell.height) / 2;
            canvas.draw(cropped(image, crops_[i].window), cropX_[i], top, cell.magnification);
            canvas.fill({cropX_[i], top + cell.height, cell.width, 3}, theme_.ofCrop(i));
        }
    }
    Rgb map(const MapKind& kind, const Rgb& image) {
        const bool isShrunk = layout_.frame.magnification == 0;
        const int width = layout_.frame.width, height = layout_.frame.height;
        // An error is averaged, not the colour that stands for it.
        if (kind.name == "error" && isShrunk)
            return colouredError(shrunk(errorMap(image, pictures_.truth), width, height));
        const Rgb drawn = kind.draw(image, pictures_.truth, exec_);
        return isShrunk ? shrunk(drawn, width, height, exec_) : drawn;
    }
    int scaleInset() const { return std::min(24, layout_.mapColumn() / 10); }
    std::vector<std::string> scaleWords(const MapKind& kind) const {
        return pen_.wrapped(kind.name == "error" ? "error per pixel, " + spaceInWords(shown_.run.protocol) +
                                                       " 0 to 1: RMS over R, G, B; the same scale on every sheet"
                                                 : std::string(kind.scale),
                            layout_.mapColumn() - 2 * scaleInset(), 14);
    }
    int scaleHeight(const MapKind& kind) const {
        return int(scaleWords(kind).size()) * 19 + (scaleOf(kind) ? 60 : 0) + 10;
    }
    // The one scale of all maps of a kind, in the truth's own cell.
    void scale(Canvas& canvas, const MapKind& kind, int x, int y, int height) {
        const int width = layout_.mapColumn(), barWidth = width - 2 * scaleInset(), barX = x + scaleInset();
        const auto most = scaleOf(kind);
        const auto words = scaleWords(kind);
        int line = y + (height - int(words.size()) * 19 - (most ? 60 : 0)) / 2;
        if (most) {
            for (int i = 0; i < barWidth; i++) canvas.fill({barX + i, line, 1, 24}, errorColour((i + 0.5) / barWidth));
            canvas.frame({barX, line, barWidth, 24}, theme_.quiet, 1);
            constexpr int kTicks = 4;
            for (int i = 0; i <= kTicks; i++) {
                const int tick = barX + i * (barWidth - 1) / kTicks;
                canvas.fill({tick, line + 25, 1, 6}, theme_.quiet);
                if (width < 360 && i % kTicks) continue;  // they would touch
                canvas.text(tick, line + 48, (i == kTicks ? ">= " : "") + shortNumber(*most * i / kTicks), 14,
                            theme_.ink, Font::regular,
                            i == 0        ? Align::left
                            : i == kTicks ? Align::right
                                          : Align::centre);
            }
            line += 60;
        }
        for (const auto& t : words) canvas.text(barX, line += 19, t, 14, theme_.quiet);
    }

    const Shown& shown_;
    const SheetOptions& options_;
    const Exec& exec_;
    const Theme& theme_;
    Canvas pen_;
    Pictures pictures_;
    SheetMethods methods_;
    std::vector<Crop> crops_;
    std::vector<const MapKind*> maps_;
    RowLayout layout_;
    int frameX_ = 0;
    std::vector<int> cropX_, mapX_;
};

// ---- cells: crops under heads ----
// The crops of one picture, cut out of it.
using Cut = std::vector<Rgb>;
Cut cut(const Rgb& image, const std::vector<Crop>& crops) {
    Cut all;
    for (const Crop& c : crops) all.push_back(cropped(image, c.window));
    return all;
}
// Truth first, where there is one, then the methods.
std::vector<Cut> cutAll(const Pictures& p, const std::vector<Crop>& crops) {
    std::vector<Cut> all;
    if (showsTruth(p)) all.push_back(cut(p.truth, crops));
    for (const Rgb& image : p.methods) all.push_back(cut(image, crops));
    return all;
}
// Brief labels parallel to cutAll.
std::vector<SheetLabel> briefLabels(const SheetMethods& methods, bool truth, int width, const Theme& theme,
                                    const Canvas& pen) {
    std::vector<SheetLabel> labels;
    if (truth) labels.push_back(truthLabel(methods.run, width, theme, pen, true));
    for (size_t i = 0; i < methods.order.size(); i++)
        labels.push_back(SheetLabel::brief(methods, i, width, theme, pen));
    return labels;
}
int tallest(const std::vector<SheetLabel>& labels, size_t first, size_t last) {
    int height = 0;
    for (size_t i = first; i < last; i++) height = std::max(height, labels[i].height());
    return height;
}
// What a crop is, in one line above its row.
SheetItem cropNote(const Crop& crop, size_t index, const CellSize& cell, const Theme& theme, int x) {
    const std::string text = nameOf(crop, cell.magnification) + "  (" + std::to_string(crop.window.width) + " x " +
                             std::to_string(crop.window.height) + " px)";
    return {26, [=](Canvas& canvas, int y) {
                canvas.fill({x, y + 8, 12, 12}, theme.ofCrop(index));
                canvas.text(x + 20, y + 19, text, kHeadPx, theme.quiet);
            }};
}

// Methods side by side, in blocks of as many as fit.
struct Grid {
    std::vector<SheetSection> blocks;
    int width;
};
Grid gridOf(const std::vector<Cut>& cuts, const SheetMethods& methods, bool truth, const std::vector<Crop>& crops,
            const SheetOptions& o, const Theme& theme, const Canvas& pen) {
    const PageFormat format = formatOf(o.page);
    constexpr int kNote = 26, kHeadsAndFoot = 290;  // px of a page that the crops do not have
    const int room = format.width > 0 ? format.width - 2 * kSheetMargin : kWidest;
    const int roomHeight =
        format.height > 0 ? format.height - kHeadsAndFoot - int(crops.size()) * (kNote + kCellGap) : 0;
    const GridLayout layout = gridLayout(windowsOf(crops), cuts.size(), o.zoom, room, roomHeight, format.name);
    const auto labels = briefLabels(methods, truth, layout.cellWidth + 12, theme, pen);
    Grid grid{{}, layout.columns * (layout.cellWidth + kCellGap) - kCellGap};
    for (size_t first = 0; first < cuts.size(); first += size_t(layout.columns)) {
        const size_t last = std::min(cuts.size(), first + size_t(layout.columns));
        const auto xOf = [=](size_t column) {
            return kSheetMargin + int(column - first) * (layout.cellWidth + kCellGap);
        };
        SheetSection block;
        const int heads = tallest(labels, first, last);
        block.lead.push_back({heads, [=](Canvas& canvas, int y) {
                                  for (size_t c = first; c < last; c++)
                                      labels[c].draw(canvas, xOf(c) - 14, y + heads - labels[c].height() + 4);
                              }});
        for (size_t k = 0; k < crops.size(); k++) {
            const CellSize cell = layout.cells[k];
            const SheetItem note = cropNote(crops[k], k, cell, theme, kSheetMargin);
            block.rows.push_back({note.height + cell.height + kCellGap + (k + 1 == crops.size() ? 12 : 0),
                                  [=, &cuts](Canvas& canvas, int y) {
                                      note.draw(canvas, y);
                                      for (size_t c = first; c < last; c++)
                                          canvas.draw(cuts[c][k], xOf(c), y + note.height, cell.magnification);
                                  }});
        }
        grid.blocks.push_back(std::move(block));
    }
    return grid;
}

std::vector<Canvas> gridSheet(const Shown& shown, int frame, const SheetOptions& o) {
    const Theme& theme = sheetTheme(o.light);
    const Canvas pen(1, 1, theme.ground);
    const Pictures pictures = shown.pictures(frame);
    const SheetMethods methods = sheetMethods(shown.run, shown.order);
    const auto crops = cropsOf(pictures, o, kTellingCrops);
    if (crops.empty())
        throw InputError("the methods differ nowhere in " + frameWord(frame) +
                         ", so no crop tells them apart; give --crop");
    const auto cuts = cutAll(pictures, crops);
    const Grid grid = gridOf(cuts, methods, showsTruth(pictures), crops, o, theme, pen);
    return sheetPages(grid.blocks, grid.width, o.page, theme,
                      {shown.run.shot, titleOf(shown.run) + ", " + frameWord(frame), runLine(shown.run),
                       footOf(methods, false, showsTruth(pictures), !o.crops.empty())},
                      shown.run.programVersion);
}
}  // namespace

std::vector<Canvas> sheet(const Shown& shown, int frame, const SheetOptions& o, const Exec& exec) {
    return o.arrangement == Arrangement::grid ? gridSheet(shown, frame, o) : Rows(shown, frame, o, exec).pages();
}

namespace {
// The crops of all frames, each frame read once.
struct Cuts {
    std::vector<Crop> crops;
    std::vector<std::vector<Cut>> frames;
    bool truth;
};
Cuts cutsOver(const Shown& shown, const std::vector<int>& frames, const SheetOptions& o) {
    Cuts all{{}, {}, true};
    // Where the methods differ most, they do at the end, when histories are full.
    Pictures last = shown.pictures(frames.back());
    all.crops = cropsOf(last, o, 1);
    if (all.crops.empty())
        throw InputError("the methods differ nowhere in " + frameWord(frames.back()) +
                         ", so no crop tells them apart; give --crop");
    std::vector<bool> hasTruth;
    for (const int frame : frames) {
        Pictures p = frame == frames.back() ? std::move(last) : shown.pictures(frame);
        all.truth = all.truth && showsTruth(p);
        hasTruth.push_back(showsTruth(p));
        all.frames.push_back(cutAll(p, all.crops));
    }
    for (size_t f = 0; f < frames.size(); f++)  // rows must be the same in all
        if (hasTruth[f] && !all.truth) all.frames[f].erase(all.frames[f].begin());
    return all;
}
}  // namespace

std::vector<Canvas> strips(const Shown& shown, const std::vector<int>& frames, const SheetOptions& o) {
    const Theme& theme = sheetTheme(o.light);
    const Canvas pen(1, 1, theme.ground);
    const SheetMethods methods = sheetMethods(shown.run, shown.order);
    const Cuts cuts = cutsOver(shown, frames, o);
    const PageFormat format = formatOf(o.page);
    constexpr int kStripLabel = 190, kCells = kSheetMargin + kStripLabel + kSheetGap;
    const int room = (format.width > 0 ? format.width - kSheetMargin : kWidest) - kCells;
    const auto labels = briefLabels(methods, cuts.truth, kStripLabel, theme, pen);
    std::vector<SheetSection> sections;
    int width = 0;
    for (size_t k = 0; k < cuts.crops.size(); k++) {
        const GridLayout layout = gridLayout({cuts.crops[k].window}, frames.size(), o.zoom, room,
                                             format.height > 0 ? format.height / 5 : 0, format.name);
        const CellSize cell = layout.cells[0];
        width = std::max(width, kCells - kSheetMargin + layout.columns * (layout.cellWidth + kCellGap) - kCellGap);
        for (size_t first = 0; first < frames.size(); first += size_t(layout.columns)) {
            const size_t last = std::min(frames.size(), first + size_t(layout.columns));
            const auto xOf = [=](size_t f) { return kCells + int(f - first) * (layout.cellWidth + kCellGap); };
            SheetSection section;
            section.lead.push_back(cropNote(cuts.crops[k], k, cell, theme, kSheetMargin));
            section.lead.push_back({26, [=](Canvas& canvas, int y) {
                                        for (size_t f = first; f < last; f++)
                                            canvas.text(xOf(f), y + 17, frameWord(frames[f]), kHeadPx, theme.quiet);
                                    }});
            for (size_t r = 0; r < labels.size(); r++) {
                const SheetLabel& label = labels[r];
                const int height = std::max(cell.height, label.height());
                section.rows.push_back({height + (r + 1 == labels.size() ? 20 : kCellGap),
                                        [=, &cuts, &label, &theme](Canvas& canvas, int y) {
                                            canvas.fill({kSheetMargin, y, kStripLabel, height}, theme.panel);
                                            label.draw(canvas, kSheetMargin, y);
                                            for (size_t f = first; f < last; f++)
                                                canvas.draw(cuts.frames[f][r][k], xOf(f), y, cell.magnification);
                                        }});
            }
            sections.push_back(std::move(section));
        }
    }
    return sheetPages(sections, width, o.page, theme,
                      {shown.run.shot, titleOf(shown.run) + ", over time", runLine(shown.run),
                       footOf(methods, false, cuts.truth, !o.crops.empty())},
                      shown.run.programVersion);
}

std::vector<Canvas> loopOfMethods(const Shown& shown, int frame, const SheetOptions& o) {
    const Theme& theme = sheetTheme(o.light);
    const Canvas pen(1, 1, theme.ground);
    const SheetMethods methods = sheetMethods(shown.run, shown.order);
    const Cuts cuts = cutsOver(shown, {frame}, o);
    std::vector<CellSize> cells;
    int width = 0, height = 0;
    constexpr int kLoopHeight = 288, kInset = 14;
    for (const Crop& c : cuts.crops) {
        const int magnification = o.zoom > 0 ? o.zoom : std::max(1, kLoopHeight / c.window.height);
        cells.push_back({c.window.width * magnification, c.window.height * magnification, magnification});
        width += cells.back().width + kCellGap, height = std::max(height, cells.back().height);
    }
    width = std::max(width - kCellGap, 300);
    const auto labels = briefLabels(methods, cuts.truth, width, theme, pen);
    const int head = tallest(labels, 0, labels.size());
    if (std::max(width, height + head) + 200 > kLargestSide)
        throw UsageError("the loop would have " + std::to_string(width) + " x " + std::to_string(height + head) +
                         " px; choose smaller crops or a smaller --zoom");
    std::string note = shown.run.shot + ", " + frameWord(frame);
    for (size_t k = 0; k < cells.size(); k++) note += "; " + nameOf(cuts.crops[k], cells[k].magnification);
    const auto notes = pen.wrapped(note, width, 12);
    std::vector<Canvas> all;
    for (size_t m = 0; m < labels.size(); m++) {
        Canvas canvas(width + 2 * kInset, head + height + int(notes.size()) * 17 + 14, theme.ground);
        labels[m].draw(canvas, 0, 0);
        int x = kInset;
        for (size_t k = 0; k < cells.size(); k++) {
            canvas.draw(cuts.frames[0][m][k], x, head, cells[k].magnification);
            x += cells[k].width + kCellGap;
        }
        int y = head + height + 4;
        for (const auto& line : notes) canvas.text(kInset, y += 17, line, 12, theme.quiet);
        all.push_back(std::move(canvas));
    }
    return all;
}

std::vector<Canvas> loopOfFrames(const Shown& shown, const std::vector<int>& frames, const SheetOptions& o) {
    const Theme& theme = sheetTheme(o.light);
    const Canvas pen(1, 1, theme.ground);
    const SheetMethods methods = sheetMethods(shown.run, shown.order);
    const Cuts cuts = cutsOver(shown, frames, o);
    std::vector<Canvas> all;
    for (size_t f = 0; f < frames.size(); f++) {
        Grid grid = gridOf(cuts.frames[f], methods, cuts.truth, cuts.crops, o, theme, pen);
        // A line of its own: what changes must not move what follows.
        const std::string number = frameWord(frames[f]);
        grid.blocks.insert(grid.blocks.begin(), SheetSection{{}, {{30, [&](Canvas& canvas, int y) {
                                                                       canvas.text(kSheetMargin, y + 20, number, 17,
                                                                                   theme.ink, Font::bold);
                                                                   }}}});
        auto pages = sheetPages(grid.blocks, grid.width, PageSize::free, theme,
                                {shown.run.shot, titleOf(shown.run), runLine(shown.run),
                                 footOf(methods, false, cuts.truth, !o.crops.empty())},
                                shown.run.programVersion);
        if (pages.size() > 1)
            throw UsageError(
                "the loop would be higher than a picture can be; choose fewer methods or crops, or a smaller --zoom");
        all.push_back(std::move(pages[0]));
    }
    return all;
}

// ---- what is shown ----
std::vector<size_t> presentationOrder(const RunResults& run) {
    std::vector<size_t> order(run.methods.size());
    for (size_t i = 0; i < order.size(); i++) order[i] = i;
    const auto rank = [&](size_t i) {
        const MethodResult& m = run.methods[i];
        return m.pooled ? m.pooled->mean.psnr : -std::numeric_limits<double>::infinity();
    };
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return rank(a) > rank(b); });
    return order;
}

std::vector<size_t> chosenMethods(const RunResults& run, const std::vector<std::string>& names) {
    std::set<size_t> chosen;
    const auto add = [&](const std::string& name) {
        const auto by = [&](auto member) {
            bool found = false;
            for (size_t i = 0; i < run.methods.size(); i++)
                if (run.methods[i].*member == name) chosen.insert(i), found = true;
            return found;
        };
        return by(&MethodResult::text) || by(&MethodResult::id) || by(&MethodResult::family);
    };
    for (const auto& list : names) {
        // A method's own text may hold commas: the longest piece that is known counts.
        for (size_t at = 0; at <= list.size();) {
            size_t end = list.size();
            while (!add(list.substr(at, end - at))) {
                const size_t shorter = end > at ? list.rfind(',', end - 1) : std::string::npos;
                if (shorter == std::string::npos || shorter <= at) {
                    std::string known;
                    for (const auto& m : run.methods) known += (known.empty() ? "" : " ") + m.text;
                    throw UsageError("--methods: the run has no method or family '" +
                                     list.substr(at, list.find(',', at) - at) + "'; it has " + known);
                }
                end = shorter;
            }
            at = end + 1;
        }
    }
    std::vector<size_t> order = presentationOrder(run);
    if (!names.empty()) std::erase_if(order, [&](size_t i) { return !chosen.contains(i); });
    return order;
}

RunResults onlyMethods(const RunResults& run, const std::vector<size_t>& order) {
    RunResults few = run;
    few.methods.clear(), few.pairs.clear();
    for (const size_t i : order) few.methods.push_back(run.methods[i]);
    return few;
}

Crop cropFrom(const std::string& text, const RunResults& run) {
    const size_t colon = text.find(':');
    return {windowFrom(text.substr(0, colon), "--crop", "run '" + run.shot + "'", run.width, run.height),
            colon == std::string::npos ? std::string() : text.substr(colon + 1)};
}

void chooseColumns(SheetOptions& o, const std::vector<std::string>& names) {
    if (names.empty()) return;
    o.frameColumn = o.cropColumns = false;
    o.maps.clear();
    for (const auto& name : names) {
        if (name == "frame") {
            o.frameColumn = true;
        } else if (name == "crops") {
            o.cropColumns = true;
        } else {
            std::string maps;
            for (const MapKind& kind : mapKinds()) {
                maps += ", " + std::string(kind.name);
                if (kind.name == name) o.maps.push_back(&kind), o.asksForMaps = true;
            }
            if (o.maps.empty() || o.maps.back()->name != name)
                throw UsageError("--columns: expected some of frame, crops" + maps + ", found '" + name + "'");
        }
    }
}

}  // namespace aa
