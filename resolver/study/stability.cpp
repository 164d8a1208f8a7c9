#include "study/stability.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "gpu/method.h"
#include "kernels/dispatch.h"
#include "metrics/banding.h"
#include "shot/patterns.h"
#include "shot/reader.h"
#include "shot/synth/synth.h"
#include "study/prepare.h"
#include "study/run.h"
#include "study/stability_frames.h"
#include "study/synthetic_frames.h"

namespace aa {
namespace stability {
namespace {

// Methods run side by side, each on one thread.
const Exec kLanes{.parallel = false}, kDouble{.precision = Precision::oracle, .parallel = false};

// The spacing of floats at a value; of values darker than 1/1024, a quarter of a code at black, the spacing there.
double ulpAt(double value) {
    constexpr int kLeastExponent = -10, kMantissaBits = 23;
    const int exponent = value == 0 ? kLeastExponent : std::max(std::ilogb(value), kLeastExponent);
    return std::ldexp(1.0, exponent - kMantissaBits);
}
template <class See>  // see(x, y, channel)
void forValues(const Rgb& image, const See& see) {
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < image.height(); y++)
            for (int x = 0; x < image.width(); x++) see(x, y, c);
}
std::vector<glm::dvec2> subSamplesOf(const MethodSpec& method) {
    const std::string pattern = subSamplePatternFor(method);
    return pattern.empty() ? std::vector<glm::dvec2>{} : patternPositionsPx(pattern);
}
void addWideLight(const Rgb& lanes, const Rgb& exact, WideLightError& e) {
    forValues(exact, [&](int x, int y, size_t c) {
        double most = 1e-30;
        for (int j = -3; j <= 3; j++)
            for (int i = -3; i <= 3; i++)
                for (const PlaneF& p : exact.c) most = std::max(most, double(p.clamped(x + i, y + j)));
        const double v = double(exact.c[c].at(x, y)), error = std::abs(double(lanes.c[c].at(x, y)) - v);
        const double finite = std::isfinite(error) ? error : INFINITY;
        e.ofValue = std::max(e.ofValue, finite / std::max(v, 1e-6));
        e.ofLargest = std::max(e.ofLargest, finite / most);
    });
}
double meanOf(const Rgb& image) {
    double sum = 0;
    forValues(image, [&](int x, int y, size_t c) { sum += double(image.c[c].at(x, y)); });
    return sum / (3.0 * image.width() * image.height());
}
}  // namespace

std::optional<MethodSpec> withHistory(const MethodSpec& method, std::string_view bits) {
    const auto& params = method.method->params;
    const auto p = std::find_if(params.begin(), params.end(), [](const auto& q) { return q.name == "historyBits"; });
    if (p == params.end()) return bits == "32f" ? std::optional(method) : std::nullopt;
    if (std::find(p->choices.begin(), p->choices.end(), bits) == p->choices.end()) return {};
    MethodSpec form = method;
    std::erase_if(form.given,
                  [&](const auto& g) { return g.first == "historyBits" || (bits == "32f" && g.first == "dither"); });
    if (bits != "32f") form.given.emplace_back("historyBits", bits);
    return form;
}

Deviation deviation(const MethodSpec& method, const MethodSpec& form, const std::vector<Frame>& frames,
                    const ShotInfo& info, gpu::Session* device) {
    RunningMethod exact(method, info);
    RunningMethod other = device ? RunningMethod(form, gpu::create(*device, form, info)) : RunningMethod(form, info);
    Deviation d;
    double squares = 0;
    std::vector<float> ulps;
    ulps.reserve(frames.size() * 3 * size_t(info.width) * size_t(info.height));
    for (const Frame& f : frames) {
        exact.resolve(f, f.display, kDouble);
        other.resolve(f, f.display, kLanes);
        forValues(exact.out, [&](int x, int y, size_t c) {
            const double e = double(exact.out.c[c].at(x, y)), found = double(other.out.c[c].at(x, y));
            if (!std::isfinite(e) || !std::isfinite(found)) {
                d.notFinite += std::isfinite(e) != std::isfinite(found);
                return;
            }
            const double difference = std::abs(found - e), share = difference / std::max(1.0, std::abs(e));
            d.max = std::max(d.max, share);
            squares += share * share;
            ulps.push_back(float(difference / ulpAt(e)));
        });
    }
    if (ulps.empty()) return d;
    d.rms = std::sqrt(squares / double(ulps.size()));
    const auto at99 = ulps.begin() + ptrdiff_t(ulps.size() * 99 / 100);
    std::nth_element(ulps.begin(), at99, ulps.end());
    d.ulp = double(*at99);
    d.ulpMost = double(*std::max_element(at99, ulps.end()));
    return d;
}

Amplification amplification(const MethodSpec& method, const std::vector<Frame>& frames, const ShotInfo& info,
                            uint32_t seed) {
    RunningMethod straight(method, info), moved(method, info);
    Amplification a;
    for (const Frame& f : frames) {
        const Frame other = movedByOneUlp(f, seed);
        straight.resolve(f, f.display, kLanes);
        moved.resolve(other, other.display, kLanes);
        double most = 0, squares = 0, count = 0;
        forValues(straight.out, [&](int x, int y, size_t c) {
            const double v = double(straight.out.c[c].at(x, y));
            const double ulps = std::abs(double(moved.out.c[c].at(x, y)) - v) / ulpAt(v);
            most = std::max(most, ulps), squares += ulps * ulps, count++;
        });
        a.most.push_back(most), a.rms.push_back(std::sqrt(squares / count));
    }
    return a;
}

Ties ties(const MethodSpec& method, const std::vector<Frame>& frames, const ShotInfo& info, uint32_t seed) {
    constexpr int kDraws = 4;  // two, each with both signs
    const auto last = [&](const Frame& lastFrame) {
        RunningMethod running(method, info);
        if (method.method->temporal)  // others know no frame before
            for (size_t i = 0; i + 1 < frames.size(); i++) running.accumulate(frames[i], kDouble);
        running.resolve(lastFrame, lastFrame.display, kDouble);
        return running.out;
    };
    const Rgb straight = last(frames.back());
    PlaneU jumps(straight.width(), straight.height());
    for (int draw = 0; draw < kDraws; draw++) {
        const Rgb moved = last(movedByShare(frames.back(), kTieDistance, seed, draw));
        forValues(straight, [&](int x, int y, size_t c) {
            const double v = double(straight.c[c].at(x, y)), m = double(moved.c[c].at(x, y));
            if (!(std::abs(m - v) <= kTieJump * std::max(1.0, std::abs(v)))) jumps.at(x, y) = 1;
        });
    }
    Ties t{0, size_t(straight.width()) * size_t(straight.height())};
    for (int y = 0; y < jumps.height(); y++)
        for (int x = 0; x < jumps.width(); x++) t.pixels += jumps.at(x, y);
    return t;
}

namespace {
// A frame of a sequence at rest as its nth, from 1, which resets.
void becomeNth(Frame& f, int n) {
    f.number = n, f.reset = n == 1;
    f.previousCamera = f.camera;
    if (f.reset) f.previousCamera.reset();
}
// Codes that the pixels still miss, on average: of a history that met the step, against one that never knew another
// picture.
double stallCodes(const MethodSpec& form, const std::vector<glm::dvec2>& subSamplesPx) {
    constexpr int kBefore = 8;
    Frame before = stallFrame(1, kStallFrom, subSamplesPx), after = stallFrame(1, kStallTo, subSamplesPx);
    const ShotInfo info = restingInfo(before);
    RunningMethod stepped(form, info), target(*withHistory(form, "32f"), info);
    const auto see = [](RunningMethod& running, Frame& frame, int number, const Exec& exec) {
        becomeNth(frame, number);
        running.resolve(frame, frame.display, exec);
    };
    for (int n = 1; n <= kBefore; n++) see(stepped, before, n, kLanes);
    for (int n = 1; n <= kSettlingFrames; n++) see(stepped, after, kBefore + n, kLanes), see(target, after, n, kDouble);
    const Rgb shown = lookedAt(stepped.shown()), wanted = lookedAt(target.shown());
    double sum = 0;
    forValues(wanted, [&](int x, int y, size_t c) {
        sum += std::abs(double(shown.c[c].at(x, y)) - double(wanted.c[c].at(x, y)));
    });
    return 255 * sum / (3.0 * wanted.width() * wanted.height());
}
// Of what the form adds to the double form's picture, on the gradient that both should show.
double bandingCodes(const MethodSpec& form, const std::vector<glm::dvec2>& subSamplesPx) {
    Frame f = gradientFrame(1, subSamplesPx);
    const Rgb clean = lookedAt(f.colorEncoded);
    const ShotInfo info = restingInfo(f);
    RunningMethod narrow(form, info), exact(*withHistory(form, "32f"), info);
    for (int n = 1; n <= kGradientFrames; n++) {
        becomeNth(f, n);
        narrow.resolve(f, f.display, kLanes), exact.resolve(f, f.display, kDouble);
    }
    const Rgb found = lookedAt(narrow.shown()), wanted = lookedAt(exact.shown());
    Rgb shown = clean;
    forValues(shown,
              [&](int x, int y, size_t c) { shown.c[c].at(x, y) += found.c[c].at(x, y) - wanted.c[c].at(x, y); });
    shown.fillBorder();
    return banding(shown, clean, kLanes).banding;
}
// The frames of one period at rest; the first resets.
std::vector<Frame> restingPeriod(const std::vector<glm::dvec2>& subSamplesPx) {
    std::vector<Frame> frames;
    for (int n = 1; n <= kRestPeriod; n++) frames.push_back(restingFrame(n, subSamplesPx));
    return frames;
}
// Frame n, from 1, of a sequence that repeats the period.
const Frame& nth(std::vector<Frame>& period, int n) {
    Frame& f = period[size_t(n - 1) % period.size()];
    becomeNth(f, n);
    return f;
}
// From the middle of the sequence to its end: what comes before is a history that fills.
double drift(const MethodSpec& form, int longFrames, const std::vector<glm::dvec2>& subSamplesPx) {
    std::vector<Frame> period = restingPeriod(subSamplesPx);
    RunningMethod running(form, restingInfo(period[0]));
    const int end = longFrames / kRestPeriod * kRestPeriod, middle = end / 2 / kRestPeriod * kRestPeriod;
    double early = 0, late = 0;
    for (int n = 1; n <= end; n++) {
        running.accumulate(nth(period, n), kLanes);
        if (n > middle - kRestPeriod && n <= middle) early += meanOf(running.out);
        if (n > end - kRestPeriod) late += meanOf(running.out);
    }
    return late / early - 1;
}
}  // namespace

Settling settling(const MethodSpec& form, int longFrames) {
    const auto subSamplesPx = subSamplesOf(form);
    return {stallCodes(form, subSamplesPx), bandingCodes(form, subSamplesPx), drift(form, longFrames, subSamplesPx)};
}

Recovery recovery(const MethodSpec& method, int longFrames) {
    constexpr int kFilled = 64;  // frames after which a history is taken to be full
    std::vector<Frame> period = restingPeriod(subSamplesOf(method));
    const ShotInfo info = restingInfo(period[0]);
    RunningMethod spared(method, info), struck(method, info);
    for (int n = 1; n < kFilled; n++)
        spared.accumulate(nth(period, n), kLanes), struck.accumulate(nth(period, n), kLanes);
    Frame bright = nth(period, kFilled);
    spared.accumulate(bright, kLanes);
    addFireflies(bright);
    struck.accumulate(bright, kLanes);
    // From the last frame that still shows it: a history may give it back after it was hidden.
    Recovery r{0, longFrames - kFilled};
    for (int n = 1; n <= r.tried; n++) {
        const Frame& f = nth(period, kFilled + n);
        spared.resolve(f, f.display, kLanes), struck.resolve(f, f.display, kLanes);
        bool differs = false;
        forValues(spared.shown(), [&](int x, int y, size_t c) {
            const double d = double(struck.shown().c[c].at(x, y)) - double(spared.shown().c[c].at(x, y));
            differs |= !(std::abs(d) <= 0.5 / 255);
        });
        if (differs) r.frames = n;
    }
    if (r.frames == r.tried) r.frames.reset();
    return r;
}

namespace {
// What one group of methods is measured on: the picture that moves.
struct Material {
    std::vector<Frame> jittered, centre;
    ShotInfo info;
    const std::vector<Frame>& of(const MethodSpec& m) const {
        return m.method->sampling() == Sampling::jittered ? jittered : centre;
    }
};
using Key = std::pair<std::string, std::string>;  // scene and sub-sample pattern; of a shot both are empty
Key keyOf(const StabilityOptions& o, const MethodSpec& m) {
    return o.shot.empty() ? Key{synthSceneFor(m), subSamplePatternFor(m)} : Key{};
}
// `methods` are those that will see it: no frame is made that none of them reads.
Material synthetic(const StabilityOptions& o, const Key& key, const std::vector<const MethodSpec*>& methods) {
    SynthOptions synth;
    std::tie(synth.scene, synth.subsamples) = key;
    synth.width = o.width, synth.height = o.height, synth.frames = o.frames, synth.seed = o.seed;
    for (const MethodSpec* m : methods) synth.subsampleColor |= m->passes().has(Pass::subsampleColor);
    synth.subsampleColor &= !synth.subsamples.empty();
    const SynthShot shot(synth);
    Material r;
    r.info = shotInfo(shot.manifest());
    r.info.isStatic = true;  // so that accum is measured as well
    const auto read = [&](Sampling sampling) {
        return std::any_of(methods.begin(), methods.end(), [&](auto* m) { return m->method->sampling() == sampling; });
    };
    const auto make = [&](Sampling sampling, int count, std::vector<Frame>& to) {
        for (int i = 0; i < (read(sampling) ? count : 0); i++) {
            to.push_back(shot.frame(size_t(i), sampling));
            addGrain(to.back(), o.seed);
        }
    };
    make(Sampling::jittered, o.frames, r.jittered);
    make(Sampling::centre, std::min(o.frames, kStatelessFrames), r.centre);
    return r;
}
Material ofShot(const StabilityOptions& o, const ShotReader& reader, SanitiseCounts& counts) {
    requirePasses(reader, o.methods);
    Material r;
    r.info = shotInfo(reader.manifest());
    const size_t all = reader.manifest().frames.size(), count = std::min(size_t(o.frames), all);
    const PassSet jittered = passesOf(o.methods, Sampling::jittered), centre = passesOf(o.methods, Sampling::centre);
    for (size_t i = 0; i < count && !jittered.empty(); i++) r.jittered.push_back(reader.read(i, jittered, &counts));
    for (size_t i = 0; i < std::min(count, size_t(kStatelessFrames)) && !centre.empty(); i++)
        r.centre.push_back(reader.hasCentreFrames() ? reader.readCentre(i, centre, &counts)
                                                    : reader.read(i, centre, &counts));
    if (!r.jittered.empty()) r.jittered[0].reset = true;
    for (auto* sampled : {&r.jittered, &r.centre})
        for (Frame& f : *sampled) encodeFrame(f, {}, o.exec);
    return r;
}

// The frames after which ties are looked for, of a method with a history; of others every frame by itself.
Ties tiesOf(const MethodSpec& method, const std::vector<Frame>& frames, const ShotInfo& info, uint32_t seed) {
    Ties all;
    const auto add = [&](std::vector<Frame> until) {
        const Ties t = ties(method, until, info, seed);
        all.pixels += t.pixels, all.of += t.of;
    };
    if (method.method->temporal)
        for (const size_t n : {size_t(8), size_t(16)})
            add({frames.begin(), frames.begin() + ptrdiff_t(std::min(n, frames.size()))});
    else
        for (size_t i = 0; i < std::min<size_t>(frames.size(), 2); i++) add({frames[i]});
    return all;
}
MethodStability measured(const StabilityOptions& o, const MethodSpec& m, const Material& material) {
    const std::vector<Frame>& frames = material.of(m);
    const ShotInfo& info = material.info;
    MethodStability r;
    r.id = m.method->id, r.text = m.text, r.title = m.method->title, r.family = m.method->family;
    r.keepsHistory = m.method->temporal;
    const MethodSpec exact = *withHistory(m, "32f");
    r.lanes = deviation(exact, exact, frames, info);
    const auto narrow = [&](const char* bits, std::optional<Deviation>& to, std::optional<Settling>& settled) {
        const auto form = withHistory(m, bits);
        if (!form) return;
        to = deviation(exact, *form, frames, info);
        settled = settling(*form, o.longFrames);
    };
    narrow("16f", r.half, r.settlingHalf), narrow("8", r.byte, r.settlingByte);
    r.wideLight = wideLightError(exact);
    r.amplification = amplification(exact, frames, info, o.seed);
    if (m.method->temporal) r.settling = settling(exact, o.longFrames), r.recovery = recovery(exact, o.longFrames);
    const Ties t = tiesOf(exact, frames, info, o.seed);
    r.tieShare = double(t.pixels) / double(t.of), r.tiePixels = t.of;
    return r;
}
}  // namespace
}  // namespace stability

double Amplification::largest() const { return most.empty() ? 0 : *std::max_element(most.begin(), most.end()); }

WideLightError wideLightError(const MethodSpec& method) {
    using namespace stability;
    const auto subSamplesPx = subSamplesOf(method);
    WideLightError e;
    for (unsigned seed = 1; seed <= kWideLightSeeds; seed++) {
        const std::vector<Frame> frames = wideLightFrames(seed, subSamplesPx);
        const ShotInfo info = restingInfo(frames[0]);
        RunningMethod lanes(method, info), exact(method, info);
        for (const Frame& f : frames) {
            lanes.resolve(f, f.display, kLanes);
            exact.resolve(f, f.display, kDouble);
            addWideLight(lanes.out, exact.out, e);
        }
    }
    return e;
}

StabilityResults measureStability(const StabilityOptions& o, const Progress& progress) {
    using namespace stability;
    StabilityResults r;
    r.program = AA_VERSION;
    r.width = o.width, r.height = o.height, r.frames = o.frames, r.longFrames = o.longFrames, r.seed = o.seed;
    r.noDevice = o.noDevice;
    std::optional<ShotReader> reader;
    if (!o.shot.empty()) {
        reader.emplace(o.shot, o.policy);
        const Manifest& m = reader->manifest();
        r.shot = m.name, r.width = m.width, r.height = m.height;
        r.frames = int(std::min(size_t(o.frames), m.frames.size()));
        r.material = "frames of the shot " + m.name;
    } else {
        r.material = "synthetic frames (`synth` scenes moving and half_planes) with 2 % of grain";
    }
    if (o.exact) {
        const gpu::DeviceInfo& info = o.exact->device().info();
        r.device = info.name, r.deviceKind = info.kind, r.driver = info.driver;
    }
    r.methods.resize(o.methods.size());
    SanitiseCounts counts;
    // Frames with many sub-samples are large: one pattern's are in memory at a time.
    std::map<Key, std::vector<size_t>> groups;
    for (size_t k = 0; k < o.methods.size(); k++) groups[keyOf(o, o.methods[k])].push_back(k);
    std::vector<char> done(o.methods.size());
    std::mutex stepping;
    for (const auto& group : groups) {
        const auto& members = group.second;
        std::vector<const MethodSpec*> methods;
        for (const size_t k : members) methods.push_back(&o.methods[k]);
        const Material material = reader ? ofShot(o, *reader, counts) : synthetic(o, group.first, methods);
        forRows(
            o.exec, int(members.size()),
            [&](int from, int to) {
                for (int i = from; i < to; i++) {
                    if (progress.interrupted()) return;
                    const size_t k = members[size_t(i)];
                    r.methods[k] = measured(o, o.methods[k], material);
                    const std::scoped_lock lock(stepping);
                    done[k] = 1;
                    if (!o.exact) progress.step(o.methods[k].text);
                }
            },
            1);
        for (const size_t k : members) {  // one device, one method at a time
            if (!o.exact || !done[k]) continue;
            if (progress.interrupted()) break;
            const MethodSpec& m = o.methods[k];
            if (gpu::hasForm(m.method->id)) {
                const MethodSpec exact = *withHistory(m, "32f");
                const auto on = [&](gpu::Session* s) {
                    return deviation(exact, exact, material.of(m), material.info, s);
                };
                r.methods[k].gpuExact = on(o.exact);
                r.methods[k].gpuFast = on(o.fast);
            }
            progress.step(m.text);
        }
    }
    for (const auto& [what, count] : counted(counts))
        if (count > 0) r.sanitised[what] = count;
    if (progress.interrupted()) {
        r.complete = false;
        size_t k = 0;
        std::erase_if(r.methods, [&](const auto&) { return !done[k++]; });
    }
    return r;
}

}  // namespace aa
