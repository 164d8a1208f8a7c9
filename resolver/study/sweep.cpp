#include "study/sweep.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "image/error.h"
#include "methods/driver.h"
#include "study/prepare.h"
#include "study/resume.h"

namespace aa {
namespace {
constexpr size_t kMostVariants = 256;  // every pair of variants is compared

struct Variation {
    std::string name;
    std::vector<std::string> values;
};

// "kmin=0.5,0.8,1"
Variation parseVariation(const std::string& text) {
    const size_t equals = text.find('=');
    Variation v{text.substr(0, equals), {}};
    for (size_t at = equals; at != std::string::npos; at = text.find(',', at + 1)) {
        const size_t end = text.find(',', at + 1);
        v.values.push_back(text.substr(at + 1, end == std::string::npos ? end : end - at - 1));
    }
    const std::set<std::string> different(v.values.begin(), v.values.end());
    if (v.name.empty() || different.contains("") || different.size() != v.values.size() || v.values.empty())
        throw UsageError("--vary: expected NAME=VALUE,VALUE,... with different values, found '" + text + "'");
    return v;
}

std::vector<std::string> combinations(const std::string& method, const std::vector<Variation>& variations) {
    std::vector<std::string> all = {""};
    for (const Variation& v : variations) {
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
    return bytes + probe[0].out.bytes() + probe[0].outEncoded.bytes() + kJudgePlanes * probe[0].out.c[0].bytes();
}
}  // namespace

std::vector<MethodSpec> variantsOf(const SweepOptions& o) {
    std::vector<Variation> variations;
    size_t count = 1;
    std::set<std::string> varied;
    for (const auto& text : o.vary) {
        variations.push_back(parseVariation(text));
        count *= variations.back().values.size();
        if (!varied.insert(variations.back().name).second)
            throw UsageError("--vary: parameter '" + variations.back().name + "' is varied twice");
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
        std::clamp<size_t>(size_t(o.memoryMb * (1 << 20)) / std::max<size_t>(each, 1), 1, variants.size());
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
    Earlier earlier;
    bool started = false;
    run_.checkpoint = [&](const RunResults& sofar) {  // nothing of an earlier run is taken for this one's
        if (std::exchange(started, true)) return;
        RunOptions every = run_;
        for (const auto& part : parts_) every.allMethods.insert(every.allMethods.end(), part.begin(), part.end());
        earlier = clearEarlier(every);
        writeResults(sofar, run_.out);
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
    all.replacedMethods = earlier.methods, all.outdatedFiles = earlier.files;
    finish(all, errors);
    writeResults(all, run_.out);
    return all;
}

}  // namespace aa
