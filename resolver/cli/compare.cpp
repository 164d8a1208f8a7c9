#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/cli.h"
#include "cli/frame_pairs.h"
#include "cli/run_arguments.h"
#include "gpu/metrics.h"
#include "image/colour.h"
#include "image/error.h"
#include "image/exr.h"
#include "image/inputs.h"
#include "image/io.h"
#include "image/json_text.h"
#include "metrics/maps.h"
#include "metrics/measure.h"
#include "metrics/non_finite.h"
#include "report/format.h"
#include "report/gallery.h"
#include "study/protocol.h"

namespace aa {
namespace {
namespace fs = std::filesystem;

struct CompareArguments {
    std::string a, b, pair = "auto", map, mapOf, region, layer, display = "srgb", nonFinite = "sanitise";
    std::vector<std::string> metrics = {"mse", "psnr", "ssimLuma"}, thresholds;
    double exposure = 0;
    bool json = false, q8 = false;
    ViewingArguments viewing;
    WorkOptions work;
};

struct Threshold {
    const Figure* figure;
    double limit;
};
std::vector<Threshold> thresholdsOf(const CompareArguments& o) {
    std::vector<Threshold> all;
    for (const auto& text : o.thresholds) {
        const size_t equals = text.find('=');
        char* end = nullptr;
        const double limit = equals == std::string::npos ? 0 : std::strtod(text.c_str() + equals + 1, &end);
        if (equals == std::string::npos || end == text.c_str() + equals + 1 || *end)
            throw UsageError("--fail-below: expected metric=number such as psnr=40, found '" + text + "'");
        const Figure* f = findFigure(text.substr(0, equals)).figure;
        if (!f->higherIsBetter)
            throw UsageError("--fail-below " + text + ": of " + std::string(f->name) +
                             " smaller is better; use psnr, snr or an SSIM");
        all.push_back({f, limit});
    }
    return all;
}

// What a picture holds beside the colours that are compared; summed over the frames.
struct Aside {
    ColourCounts values;     // of which NaN and Inf alone are counted
    uint64_t notOpaque = 0;  // pixels
    std::string layer;       // of the first frame, where there are several
};
struct Both {
    Rgb encodedA, encodedB, linearA, linearB;  // linear: empty for 8-bit images
    Aside a, b;
    uint64_t alphaDiffers = 0;  // pixels
    bool isBroken() const { return a.values.nonFinite() + b.values.nonFinite() > 0; }
};
uint64_t notOpaque(const LoadedImage& image) {
    uint64_t count = 0;
    for (int y = 0; y < image.alpha.height(); y++)
        for (int x = 0; x < image.alpha.width(); x++) count += image.alpha.at(x, y) != 1;
    return count;
}
uint64_t alphaDiffers(const LoadedImage& a, const LoadedImage& b) {
    if (a.alpha.empty() && b.alpha.empty()) return 0;
    const auto at = [](const LoadedImage& image, int x, int y) {
        return image.alpha.empty() ? 1.0f : image.alpha.at(x, y);
    };
    uint64_t count = 0;
    for (int y = 0; y < a.rgb.height(); y++)
        for (int x = 0; x < a.rgb.width(); x++) count += at(a, x, y) != at(b, x, y);
    return count;
}
LoadedImage load(const fs::path& file, const CompareArguments& o) {
    const InputPolicy policy = inputPolicyByName(o.nonFinite);
    // Replaced values would have to be told from others below, where they count as the largest difference.
    LoadedImage image =
        readImage(file, {isExr(file) ? o.layer : "", policy == InputPolicy::strict ? policy : InputPolicy::raw});
    showDisplayWindow(image, file);
    return image;
}
Both loadBoth(const FramePair& pair, const CompareArguments& o, const Exec& exec) {
    LoadedImage a = load(pair.a, o), b = load(pair.b, o);
    if (!o.layer.empty() && !isExr(pair.a) && !isExr(pair.b))
        throw UsageError("--layer: neither " + pair.a.string() + " nor " + pair.b.string() + " is an EXR");
    if (a.rgb.width() != b.rgb.width() || a.rgb.height() != b.rgb.height())
        throw InputError(pair.b.string() + ": expected " + std::to_string(a.rgb.width()) + "x" +
                         std::to_string(a.rgb.height()) + " like " + pair.a.string() + ", found " +
                         std::to_string(b.rgb.width()) + "x" + std::to_string(b.rgb.height()));
    Both both;
    both.a = {a.counts, notOpaque(a), a.layer}, both.b = {b.counts, notOpaque(b), b.layer};
    both.alphaDiffers = alphaDiffers(a, b);
    const auto prepare = [&](LoadedImage& image, Rgb& encoded, Rgb& linear) {
        if (image.space == FileSpace::encoded) {
            encoded = std::move(image.rgb);
        } else {
            const DisplayChain display{float(o.exposure), ToneMap::none, transferByName(o.display)};
            encode(image.rgb, image.displayReferred ? display.transferOnly() : display, exec, encoded);
            linear = std::move(image.rgb);
        }
        if (o.q8) quantise8(encoded, exec);
    };
    prepare(a, both.encodedA, both.linearA);
    prepare(b, both.encodedB, both.linearB);
    const auto sourceOf = [](const Aside& of, const Rgb& linear) { return of.values.nonFinite() ? &linear : nullptr; };
    if (both.isBroken())
        putFarthest(sourceOf(both.a, both.linearA), sourceOf(both.b, both.linearB), both.encodedB, both.encodedA);
    if (!o.region.empty()) {
        const Window w =
            windowFrom(o.region, "--region", pair.a.string(), both.encodedA.width(), both.encodedA.height());
        for (Rgb* image : {&both.encodedA, &both.encodedB, &both.linearA, &both.linearB})
            if (!image->empty()) *image = cropped(*image, w);
        for (auto [of, linear] : {std::pair{&both.a, &both.linearA}, {&both.b, &both.linearB}})
            if (of->values.nonFinite())
                of->values = sanitiseColour(*linear, false, InputPolicy::raw, ColourUse::measured, {});
    }
    return both;
}
// The device that measures what has a shader.
struct Measuring {
    std::shared_ptr<gpu::Session> session;       // null: none
    std::unique_ptr<gpu::Metrics> metrics = {};  // of the latest size
    double seconds = 0;
    std::string name() const { return session->device().info().name; }
};
bool hasShader(const Metric& metric) { return gpu::Metrics::measures(metric.figures[0].name); }
FrameMetrics deviceFiguresOf(const Both& p, const std::set<const Metric*>& wanted, Measuring& device) {
    const int width = p.encodedA.width(), height = p.encodedA.height();
    if (!device.metrics || device.metrics->width() != width || device.metrics->height() != height) {
        device.metrics.reset();  // its memory first
        device.metrics = std::make_unique<gpu::Metrics>(*device.session, width, height);
    }
    std::set<std::string_view> names;
    for (const Metric* metric : wanted)
        if (hasShader(*metric)) names.insert(metric->figures[0].name);
    const gpu::Metrics::Result found = device.metrics->measure(p.encodedA, p.encodedB, names);
    device.seconds += found.deviceSeconds.value_or(0);
    FrameMetrics figures = frameMetrics(found.squares);
    for (const auto& [name, figure] : found.others) figures.others.emplace(figureByName(name)->name, figure.mean);
    return figures;
}
// Figures of `wanted` metrics; `b` is the reference.
FrameMetrics figuresOf(const Both& p, const std::set<const Metric*>& wanted, double flipPixelsPerDegree,
                       const Exec& exec, Measuring& device) {
    FrameMetrics figures =
        device.session ? deviceFiguresOf(p, wanted, device) : frameMetrics(squaredError(p.encodedA, p.encodedB, exec));
    // Of linear light there is no largest difference: a picture with values that are no numbers has no such figure.
    const bool linear = !p.linearA.empty() && !p.linearB.empty();
    const ImagePair images{p.encodedA, p.encodedB, linear ? &p.linearA : nullptr, linear ? &p.linearB : nullptr,
                           flipPixelsPerDegree};
    for (const Metric* metric : wanted) {
        if (device.session && hasShader(*metric)) continue;
        if (!metric->isPossible(images))
            throw UsageError(std::string(metric->figures[0].name) + " needs linear images: two EXR files");
        if (p.isBroken() && metric->space == ColourSpace::linear)
            for (const Figure& f : metric->figures) figures.others[f.name] = NAN;
        else
            addFigures(figures, *metric, images, exec);
    }
    return figures;
}
// No figure at all, under --non-finite raw.
FrameMetrics noFigures(const std::set<const Metric*>& wanted) {
    FrameMetrics none = frameMetrics({NAN, NAN});
    for (const Metric* metric : wanted)
        for (const Figure& f : metric->figures)
            if (!f.ofSquares) none.others[f.name] = NAN;
    return none;
}
// A metric of a sequence at work: the pairs are its frames, in their order.
struct Watch {
    explicit Watch(const Metric* m) : metric(m) {}
    const Metric* metric;
    std::unique_ptr<SequenceReference> reference = {};
    std::unique_ptr<SequenceTest> test = {};
    bool broken = false;  // a frame that is no picture is in it: there is no figure
    void add(const Both& p, const SequenceSetting& setting, const Exec& exec, FrameMetrics& figures) {
        const std::string name(metric->figures[0].name);
        const bool linear = !p.linearA.empty() && !p.linearB.empty();
        if (setting.viewing.display->isHdr && !linear)
            throw UsageError(name + ": --metric-display " + std::string(setting.viewing.display->name) +
                             " is fed linear light: two EXR files");
        if (!reference)
            reference = metric->watch(setting), test = reference->test(), size_ = {setting.width, setting.height};
        if (size_ != std::pair(setting.width, setting.height))
            throw InputError(name + ": the frames of a sequence have one size, and here they change from " +
                             std::to_string(size_.first) + "x" + std::to_string(size_.second) + " to " +
                             std::to_string(setting.width) + "x" + std::to_string(setting.height));
        reference->add({p.encodedB, linear ? &p.linearB : nullptr}, exec);
        put(test->add({p.encodedA, linear ? &p.linearA : nullptr}, exec), figures);
    }
    void put(const std::vector<double>& values, FrameMetrics& figures) const {
        for (size_t i = 0; i < values.size(); i++) figures.others[metric->figures[i].name] = values[i];
    }

  private:
    std::pair<int, int> size_;
};
Rgb drawn(const MapKind& map, const Both& p, const std::vector<Watch>& watches, const Exec& exec) {
    for (const Watch& w : watches)
        if (map.drawValues && w.metric->figures[0].name == map.sequenceFigure && w.test && !w.broken)
            return map.drawValues(w.test->latestMap(exec));
    return map.draw(p.encodedA, p.encodedB, exec);
}
nlohmann::ordered_json numbers(const FrameMetrics& m, const std::vector<const Figure*>& wanted) {
    nlohmann::ordered_json j;
    for (const Figure* f : wanted) {
        const double v = m.figure(f->name).value();
        if (std::isfinite(v))
            j[std::string(f->name)] = v;
        else
            j[std::string(f->name)] = significant(v);  // "Inf", "-Inf", "NaN"
    }
    return j;
}

void compare(const CompareArguments& o, Context& context) {
    const Exec exec = o.work.exec();
    const auto thresholds = thresholdsOf(o);
    std::vector<const Figure*> figures;
    std::set<const Metric*> wanted;
    for (const auto& m : o.metrics) {
        const FigureChoice choice = findFigure(m);
        figures.push_back(choice.figure);
        wanted.insert(choice.metric);
    }
    for (const auto& t : thresholds) wanted.insert(findFigure(t.figure->name).metric);
    if (o.map.empty() && !o.mapOf.empty()) throw UsageError("--map-of: no effect without --map FILE");
    const MapKind& map = mapKindByName(o.mapOf.empty() ? "error" : o.mapOf);
    const FramePairs paired = pairFrames(o.a, o.b, o.pair);
    const auto& pairs = paired.pairs;
    if (map.drawValues) wanted.insert(findFigure(map.sequenceFigure).metric);
    std::vector<Watch> watches;
    for (const Metric* metric : wanted)
        if (metric->watch) watches.emplace_back(metric);
    const double flipPpd = o.viewing.flipPixelsPerDegree;
    if (o.work.session() && flipPpd != kFlipPixelsPerDegree)
        throw UsageError(
            "compare: --flip-ppd: the device looks at FLIP from the usual distance alone; leave out --device");
    const Viewing viewing = viewingOf(o.viewing, Viewing{}.framesPerSecond);
    if (!o.map.empty() && pairs.size() > 1) requireNoInput(o.map), makeWritableFolder(o.map);
    if (!o.map.empty() && pairs.size() == 1) requireWritable(o.map);
    Measuring device{.session = o.work.session()};
    if (device.session && device.session->fast())
        throw UsageError("compare: --gpu-precision fast: pictures are compared in 32 bits alone");

    const bool raw = inputPolicyByName(o.nonFinite) == InputPolicy::raw;
    Aside a, b;
    uint64_t alphaDiffers = 0;
    SquaredError squares;
    FigureValues others;
    std::vector<FrameMetrics> frames;
    const double count = double(pairs.size());
    withThreads(o.work.threads, [&] {
        for (const auto& pair : pairs) {
            const Both both = loadBoth(pair, o, exec);
            frames.push_back(raw && both.isBroken()
                                 ? noFigures(wanted)
                                 : figuresOf(both, wanted, o.viewing.flipPixelsPerDegree, exec, device));
            for (auto [all, one] : {std::pair{&a, &both.a}, {&b, &both.b}}) {
                all->values.nan += one->values.nan, all->values.inf += one->values.inf;
                all->notOpaque += one->notOpaque;
                if (all->layer.empty()) all->layer = one->layer;
            }
            alphaDiffers += both.alphaDiffers;
            for (Watch& w : watches)
                if (raw && both.isBroken())
                    w.broken = true;
                else
                    w.add(both,
                          {.width = both.encodedA.width(),
                           .height = both.encodedA.height(),
                           .viewing = viewing,
                           .exposure = float(o.exposure),
                           .still = pairs.size() == 1,
                           .withMaps = bool(map.drawValues)},
                          exec, frames.back());
            const FrameMetrics& f = frames.back();
            squares.mse += f.mse / count, squares.reference += f.reference / count;
            for (const auto& [name, value] : f.others) others[name] += value / count;
            if (!o.map.empty())
                writePng(pairs.size() > 1 ? fs::path(o.map) / (pair.name + ".png") : fs::path(o.map),
                         drawn(map, both, watches, exec));
        }
    });
    FrameMetrics pooled = frameMetrics(squares);
    pooled.others = std::move(others);
    deriveFromMeans(pooled);
    for (const Watch& w : watches)
        w.put(w.broken ? std::vector<double>(w.metric->figures.size(), NAN) : w.test->overall(), pooled);

    std::vector<std::string> failures;
    for (const auto& t : thresholds)
        if (const double v = pooled.figure(t.figure->name).value(); !(v >= t.limit))
            failures.push_back(std::string(t.figure->name) + " " + shown(*t.figure, v) + " is below " +
                               shown(*t.figure, t.limit));
    for (const auto& [name, of] : {std::pair{&o.a, &a}, {&o.b, &b}})
        if (!thresholds.empty() && of->values.nonFinite())
            failures.push_back(*name + " holds " + inWords(of->values) + ", which no figure calls good");
    if (o.json) {
        nlohmann::ordered_json j = {
            {"a", o.a}, {"b", o.b}, {"frames", pairs.size()}, {"pooled", numbers(pooled, figures)}};
        for (size_t i = 0; i < pairs.size() && pairs.size() > 1; i++)
            j["perFrame"][pairs[i].name] = numbers(frames[i], figures);
        if (!paired.by.empty()) j["pairedBy"] = paired.by;
        j["nonFinite"] = {{"a", a.values.nonFinite()}, {"b", b.values.nonFinite()}};
        if (a.notOpaque + b.notOpaque > 0)
            j["alpha"] = {{"notOpaqueA", a.notOpaque}, {"notOpaqueB", b.notOpaque}, {"differs", alphaDiffers}};
        for (const auto& [key, of] : {std::pair{"layerA", &a}, {"layerB", &b}})
            if (!of->layer.empty()) j[key] = of->layer;
        if (!o.region.empty()) j["region"] = o.region;
        if (!watches.empty())
            j["shownOn"] = {{"display", viewing.display->name},
                            {"words", inWords(*viewing.display)},
                            {"framesPerSecond", viewing.framesPerSecond}};
        if (flipPpd != kFlipPixelsPerDegree) j["flipPixelsPerDegree"] = flipPpd;
        if (!o.map.empty()) j["map"] = {{"of", map.name}, {"scale", map.scale}};
        if (device.session) j["device"]["name"] = device.name();
        if (device.seconds > 0) j["device"]["seconds"] = device.seconds;
        j["failures"] = failures;
        std::cout << jsonText(j) << "\n";
    } else {
        const auto line = [&](const std::string& name, const FrameMetrics& m) {
            std::printf("%-16s", name.c_str());
            for (const Figure* f : figures)
                std::printf("  %s %s", std::string(f->name).c_str(), shown(*f, m.figure(f->name).value()).c_str());
            std::printf("\n");
        };
        if (pairs.size() > 1)
            for (size_t i = 0; i < pairs.size(); i++) line(pairs[i].name, frames[i]);
        line(pairs.size() > 1 ? "pooled" : pairs[0].name, pooled);
        if (!paired.by.empty() && paired.by != "name")
            std::printf("paired by %s: %s with %s\n", paired.by.c_str(), pairs[0].a.filename().c_str(),
                        pairs[0].b.filename().c_str());
        for (const auto& [name, of] : {std::pair{&o.a, &a}, {&o.b, &b}}) {
            if (!of->layer.empty()) std::printf("%s: layer '%s'\n", name->c_str(), of->layer.c_str());
            if (of->values.nonFinite())
                std::printf("%s: %s; %s\n", name->c_str(), inWords(of->values).c_str(),
                            raw ? "there is no figure (--non-finite raw)"
                                : "each counts as the largest difference that the display allows");
        }
        if (a.notOpaque + b.notOpaque > 0)
            std::printf("alpha is not compared: %llu and %llu pixels are not opaque, %llu differ in it\n",
                        static_cast<unsigned long long>(a.notOpaque), static_cast<unsigned long long>(b.notOpaque),
                        static_cast<unsigned long long>(alphaDiffers));
        if (!o.map.empty()) std::printf("map %s: %s\n", o.map.c_str(), std::string(map.scale).c_str());
        if (!o.region.empty()) std::printf("figures of the region %s\n", o.region.c_str());
        if (!watches.empty()) {
            std::printf("JOD as seen on %s", inWords(*viewing.display).c_str());
            if (pairs.size() > 1) std::printf("; %g frames per second", viewing.framesPerSecond);
            std::printf("\n");
        }
        if (device.session) {
            std::printf("on %s", device.name().c_str());
            if (device.seconds > 0) std::printf(": %.4f ms", 1e3 * device.seconds);
            std::printf("\n");
        }
    }
    for (const auto& f : failures) std::fprintf(stderr, "aaresolve: compare: %s\n", f.c_str());
    if (!failures.empty()) context.exitCode = 1;
}
}  // namespace

void addCompare(CommandLine& line, Context& context) {
    auto o = std::make_shared<CompareArguments>();
    Command c = line.command("compare", "Metrics of two images or of two folders of frames; B is the reference");
    c.option("A", o->a, "PNG (sRGB codes), EXR (linear), or a folder of frames").required().typeName("FILE");
    c.option("B", o->b, "the reference, of the same size or with the same frames").required().typeName("FILE");
    c.option("--pair", o->pair,
             "frames of two folders that belong together: name = equal but for the extension, number = by the last "
             "number of the name, order = the first with the first; auto = by name where all agree, else by number")
        .oneOf({"auto", "name", "number", "order"});
    c.option("--metrics", o->metrics, "comma-separated; `ssim` is ssimLuma:" + listOfFigures()).separatedBy(',');
    c.option("--map", o->map, "picture of the difference on a fixed scale: a PNG, of folders a folder")
        .typeName("FILE");
    c.option("--map-of", o->mapOf, "what it shows; default error:" + listOfMapKinds());
    c.option("--fail-below", o->thresholds, "exit 1 when a pooled figure is below, for example psnr=40")
        .separatedBy(',');
    c.option("--exposure", o->exposure, "display exposure for linear images, EV").range(-20.0, 20.0);
    c.option("--display", o->display,
             "of EXR files: srgb = encode, identity = the clamped values are compared as they are")
        .oneOf({"srgb", "identity"});
    c.option("--region", o->region,
             "X,Y,WIDTH,HEIGHT: figures and map of these pixels alone, as if they were the picture");
    c.option("--layer", o->layer, "layer of multilayer and multi-part EXR files; default: the one colour, or Combined");
    addNonFinite(c, o->nonFinite, "count them as the largest difference");
    addViewingArguments(c, o->viewing, "30");
    c.flag("--q8", o->q8, "round both to 8-bit codes first");
    c.flag("--json", o->json, "as JSON");
    addWorkOptions(c, o->work);
    addDeviceOptions(c, o->work);
    c.run([o, &context] { compare(*o, context); });
}

}  // namespace aa
