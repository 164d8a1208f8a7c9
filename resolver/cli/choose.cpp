#include "cli/choose.h"

#include <algorithm>
#include <cstdio>

#include "methods/family.h"
#include "study/runnable.h"

namespace aa {

Option addMethodOption(Command& command, std::vector<std::string>& to, const std::string& what, bool withShot) {
    std::string sets;
    for (const MethodSet& set : methodSets(withShot))
        if (set.name.find(':') == std::string::npos) sets += (sets.empty() ? "" : ", ") + set.name;
    if (withShot) sets += " (all that the shot can serve), runnable:FAMILY";
    return command
        .option("-m,--method", to,
                what + ", `id` or `id:name=value,name=value`, or a set: " + sets +
                    "; several with commas, or repeat the option")
        .typeName("METHOD")
        .oneEach();
}

std::vector<MethodSpec> chosen(const std::vector<std::string>& texts) { return chooseMethods(texts).methods; }

std::vector<MethodSpec> chosenFor(const std::filesystem::path& shot, const std::vector<std::string>& texts) {
    const auto namesSet = [](const std::string& text) {
        const auto items = splitMethods(text);
        return std::any_of(items.begin(), items.end(), [](const auto& item) { return isMethodSet(item); });
    };
    if (std::none_of(texts.begin(), texts.end(), namesSet)) return chosen(texts);
    const Runnable runnable{ShotReader(shot)};
    ChosenMethods found = chooseMethods(texts, [&](const MethodSpec& m) { return runnable.whyNot(m); });
    if (!found.leftOut.empty()) {
        std::string names;
        for (const auto& id : found.leftOut) names += (names.empty() ? "" : ", ") + id;
        std::fprintf(stderr, "runnable: without %s (`aaresolve list --shot %s` says why)\n", names.c_str(),
                     shot.c_str());
    }
    return std::move(found.methods);
}

}  // namespace aa
