#include "study/runnable.h"

#include "methods/driver.h"

namespace aa {

Runnable::Runnable(const ShotReader& shot)
    : info_(shotInfo(shot.manifest())),
      split_(shot.hasCentreFrames()),
      jittered_(shot.offered()),
      centre_(split_ ? shot.offered(Sampling::centre) : jittered_) {
    info_.width = info_.height = 8;  // a method is made, but nothing of the picture's size is wanted
}

std::string Runnable::whyNot(const MethodSpec& method) const {
    const bool atCentres = split_ && method.method->sampling() == Sampling::centre;
    const PassSet lacking = method.passes().without(atCentres ? centre_ : jittered_);
    if (!lacking.empty()) {
        std::string text = atCentres ? "its pictures at the pixel centres lack" : "its frames lack";
        for (const auto name : names(lacking)) text += (text.back() == 'k' ? " " : ", ") + std::string(name);
        return text;
    }
    try {
        method.create(info_);
    } catch (const std::runtime_error& e) {  // InputError, UsageError: of this shot's kind or sub-samples
        const std::string why = e.what(), id = std::string(method.method->id) + ": ";
        return why.starts_with(id) ? why.substr(id.size()) : why;
    }
    return {};
}

}  // namespace aa
