#include "study/sweep.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "image/error.h"
#include "methods/driver.h"
#include "study/megabyte.h"
#include "study/prepare.h"
#include "study/resume.h"

namespace aa {
namespace {
constexpr size_t kMostVariants = 256;  // every pair of variants is compared

// A number as it is written, so that 0.8 + 0.02 is 0.82: units of 10^-places.
struct Decimal {
    long long units = 0;
    int places = 0;
    // Of more places, so that two can be added.
    long long at(int more) const {
        long long scaled = units;
        for (int i = places; i < more; i++) scaled *= 10;
        return scaled;
    }
};
std::optional<Decimal> decimalFrom(std::string_view text) {
    constexpr size_t kDigits = 9;  // of both sides of the point: float has no more
    Decimal d;
    const bool negative = text.starts_with('-');
    if (negative) text.remove_prefix(1);
    bool point = false;
    size_t digits = 0;
    for (const char c : text) {
        if (c == '.' && !point) {
            point = true;
        } else if (c >= '0' && c <= '9' && digits < kDigits) {
            d.units = 10 * d.units + (c - '0'), digits++;
            if (point) d.places++;
        } else {
            return {};
        }
    }
    if (digits == 0) return {};
    if (negative) d.units = -d.units;
    return d;
}
std::string textOf(Decimal d) {
    while (d.places > 0 && d.units % 10 == 0) d.units /= 10, d.places--;
    std::string digits = std::to_string(std::abs(d.units));
    if (int(digits.size()) <= d.places) digits.insert(0, size_t(d.places) + 1 - digits.size(), '0');
    if (d.places > 0) digits.insert(digits.size() - size_t(d.places), ".");
    return (d.units < 0 ? "-" : "") + digits;
}

// "0.8..0.98:0.02", of whole numbers "1..8"; another text is a value itself.
std::vector<std::string> valuesOf(const std::string& text) {
    const size_t dots = text.find("..");
    if (dots == std::string::npos) return {text};
    const size_t colon = text.find(':', dots);
    const std::string_view all = text;
    const auto first = decimalFrom(all.substr(0, dots)), last = decimalFrom(all.substr(dots + 2, colon - dots - 2));
    auto step = colon == std::string::npos ? std::optional<Decimal>() : decimalFrom(all.substr(colon + 1));
    if (colon == std::string::npos && first && last && first->places == 0 && last->places == 0) step = Decimal{1, 0};
    if (!first || !last || !step || step->units <= 0)
        throw UsageError(
            "--vary: expected FIRST..LAST:STEP with a step above 0, as in 0.8..0.98:0.02 or, of whole numbers, 1..8, "
            "found '" +
            text + "'");
    const int places = std::max({first->places, last->places, step->places});
    if (first->at(places) > last->at(places))
        throw UsageError("--vary: expected FIRST..LAST:STEP that ascends, found '" + text + "'");
    std::vector<std::string> values;
    for (long long v = first->at(places); v <= last->at(places) && values.size() <= kMostVariants;
         v += step->at(places))
        values.push_back(textOf({v, places}));
    return values;
}

// "kmin=0.5,0.8..1:0.1"
SweepAxis parseVariation(const std::string& text) {
    const size_t equals = text.find('=');
    SweepAxis v{text.substr(0, equals), {}};
    for (size_t at = equals; at != std::string::npos; at = text.find(',', at + 1)) {
        const size_t end = text.find(',', at + 1);
        for (auto& value : valuesOf(text.substr(at + 1, end == std::string::npos ? end : end - at - 1)))
            v.values.push_back(std::move(value));
    }
    const std::set<std::string> different(v.values.begin(), v.values.end());
    if (v.name.empty() || different.contains("") || different.size() != v.values.size() || v.values.empty())
        throw UsageError(
            "--vary: expected NAME=VALUE,VALUE,... or NAME=FIRST..LAST:STEP with different values, found '" + text +
            "'");
    return v;
}

std::vector<std::string> combinations(const std::string& method, const std::vector<SweepAxis>& variations) {
    std::vector<std::string> all = {""};
    for (const SweepAxis& v : variations) {
        std::vector<std::string> longer;
        for (const auto& before : all)
            for (const auto& value : v.values)
                longer.push_back(before + (before.empty() ? "" : ",") + v.name + "=" + value);
        if (longer.size() > kMostVariants) break;  // refused by the caller
        all = std::move(longer);
    }
    for (auto& parameters : all) parameters = withParameters(method, parameters);
    return all;
}

// Memory that a variant holds while it runs, measured on two frames.
size_t bytesOf(const MethodSpec& spec, const ShotReader& shot, const RunOptions& o) {
    std::vector<RunningMethod> probe;
    probe.emplace_back(spec, shotInfo(shot.manifest()));
    size_t bytes = 0;
    for (size_t i = 0; i < std::min<size_t>(o.frames.size(), 2); i++) {
        const bool centre = shot.hasCentreFrames() && spec.method->sampling() == Sampling::centre;
        Frame frame = centre ? shot.readCentre(o.frames[i], spec.passes()) : shot.read(o.frames[i], spec.passes());
        frame.reset = frame.reset || i == 0;
        prepareFrame(frame, probe, o.protocol.display, o.exec);
        probe[0].resolve(frame, frame.display, o.exec);
        bytes = std::max(bytes, probe[0].method->stateBytes());
    }
    constexpr size_t kJudgePlanes = 2;  // metrics/temporal.h keeps a mean and a spread, or the last luma
    return bytes + probe[0].out.bytes() + probe[0].shown().bytes() + kJudgePlanes * probe[0].out.c[0].bytes();
}
}  // namespace

std::vector<SweepAxis> axesOf(const SweepOptions& o) {
    std::vector<SweepAxis> axes;
    for (const auto& text : o.vary) axes.push_back(parseVariation(text));
    return axes;
}

std::vector<MethodSpec> variantsOf(const SweepOptions& o) {
    const std::vector<SweepAxis> variations = axesOf(o);
    size_t count = 1;
    std::set<std::string> varied;
    for (const SweepAxis& axis : variations) {
        count *= axis.values.size();
        if (!varied.insert(axis.name).second) throw UsageError("--vary: parameter '" + axis.name + "' is varied twice");
        if (count * o.methods.size() > kMostVariants)
            throw UsageError("--vary: more than " + std::to_string(kMostVariants) +
                             " combinations; vary fewer parameters at a time");
    }
    std::vector<MethodSpec> specs;
    std::set<std::string> folders;
    const auto add = [&](const std::string& text) {
        MethodSpec spec = parseMethod(text);
        spec.params();  // a value out of range ends the sweep before it starts
        if (!folders.insert(spec.folderName()).second) throw UsageError("method '" + text + "' appears twice");
        specs.push_back(std::move(spec));
    };
    for (const auto& text : o.with)
        if (text != "none") add(text);
    for (const auto& method : o.methods)
        for (const auto& [name, value] : parseMethod(method).given)
            if (varied.contains(name))
                throw UsageError("--vary: parameter '" + name + "' is varied and fixed by -m " + method);
    for (const auto& method : o.methods)
        for (const auto& text : combinations(method, variations)) add(text);
    return specs;
}

Sweep::Sweep(const ShotReader& shot, const RunOptions& run, const SweepOptions& o) : shot_(shot), run_(run) {
    requirePasses(shot, run.methods);
    std::vector<MethodSpec> variants = run.methods;
    const auto reference =
        std::find_if(variants.begin(), variants.end(), [&](const auto& m) { return m.text == run.protocol.reference; });
    if (reference != variants.end()) {
        reference_ = {*reference};
        variants.erase(reference);
    }
    // Measured on the first and the last variant: where memory depends on a parameter, the values mostly ascend.
    const auto compared = size_t(std::count_if(
        o.with.begin(), o.with.end(), [&](const auto& m) { return m != "none" && m != run.protocol.reference; }));
    const size_t each = std::max(bytesOf(variants[std::min(compared, variants.size() - 1)], shot, run),
                                 bytesOf(variants.back(), shot, run));
    const size_t perPart =
        std::clamp<size_t>(size_t(o.memoryMb * kMegabyte) / std::max<size_t>(each, 1), 1, variants.size());
    for (size_t first = 0; first < variants.size(); first += perPart) {
        parts_.emplace_back(variants.begin() + ptrdiff_t(first),
                            variants.begin() + ptrdiff_t(std::min(first + perPart, variants.size())));
        parts_.back().insert(parts_.back().end(), reference_.begin(), reference_.end());
        run_.methods = parts_.back();
        steps_ += stepsOf(run_, shot.manifest());
    }
}

RunResults Sweep::run(const Progress& progress) {
    RunResults all;
    std::vector<TileErrors> errors;
    std::optional<Earlier> earlier;
    bool isWritten = false;
    run_.checkpoint = [&](const RunResults& sofar) {  // nothing of an earlier run is taken for this one's
        if (isWritten) return;
        if (!earlier) {
            RunOptions every = run_;
            for (const auto& part : parts_) every.allMethods.insert(every.allMethods.end(), part.begin(), part.end());
            earlier.emplace(every);
        }
        if (!earlier->mayBeReplacedBy(sofar)) return;
        writeResults(sofar, run_.out);
        earlier->clear();
        isWritten = true;
    };
    for (size_t i = 0; i < parts_.size() && !progress.interrupted(); i++) {
        run_.methods = parts_[i];
        std::vector<TileErrors> some;
        RunResults part = runMethods(shot_, run_, progress, some);
        if (!reference_.empty() && i + 1 < parts_.size()) part.methods.pop_back(), some.pop_back();  // the last has it
        if (i == 0) {
            all = std::move(part);
            errors = std::move(some);
        } else if (!progress.interrupted()) {  // variants that saw fewer frames cannot be compared with the others
            all.warmUpFrames = std::max(all.warmUpFrames, part.warmUpFrames);
            std::move(part.methods.begin(), part.methods.end(), std::back_inserter(all.methods));
            std::move(some.begin(), some.end(), std::back_inserter(errors));
        }
    }
    all.complete = all.complete && !progress.interrupted();
    run_.checkpoint = nullptr;
    finish(all, errors);
    if (earlier) earlier->tell(all);
    writeResults(all, run_.out);
    if (earlier) earlier->clear();
    return all;
}

std::vector<SweepVariant> sweepVariants(const RunResults& run, const SweepOptions& o) {
    const std::vector<SweepAxis> axes = axesOf(o);
    std::vector<SweepVariant> all;
    for (const auto& method : o.methods) {
        SweepVariant v{0, method, std::vector<size_t>(axes.size())};
        for (const auto& text : combinations(method, axes)) {
            const auto found = std::find_if(run.methods.begin(), run.methods.end(),
                                            [&](const MethodResult& m) { return m.text == text; });
            v.method = size_t(found - run.methods.begin());
            if (found != run.methods.end()) all.push_back(v);
            // The last axis runs fastest, as in combinations().
            for (size_t a = axes.size(); a-- > 0;) {
                if (++v.at[a] < axes[a].values.size()) break;
                v.at[a] = 0;
            }
        }
    }
    return all;
}

}  // namespace aa
