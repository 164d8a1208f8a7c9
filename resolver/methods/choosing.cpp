#include "methods/choosing.h"

#include <algorithm>
#include <set>

#include "image/error.h"
#include "methods/family.h"

namespace aa {
namespace {

constexpr std::string_view kAll = "all", kRunnable = "runnable";

bool isFamily(std::string_view name) {
    return std::any_of(families().begin(), families().end(), [&](const Family& f) { return f.name == name; });
}
// "runnable:temporal" -> "temporal", "runnable" -> "all"; empty: another text.
std::string_view ofRunnable(std::string_view text) {
    if (text == kRunnable) return kAll;
    if (!text.starts_with(kRunnable) || text[kRunnable.size()] != ':') return {};
    const std::string_view family = text.substr(kRunnable.size() + 1);
    if (!isFamily(family)) {
        std::string known;
        for (const Family& f : families()) known += (known.empty() ? "" : ", ") + std::string(f.name);
        throw UsageError("'" + std::string(text) + "': expected a family behind runnable: (" + known + ")");
    }
    return family;
}
std::string listed(const std::vector<std::string>& names) {
    std::string s;
    for (const auto& n : names) s += (s.empty() ? "" : ", ") + n;
    return s;
}
}  // namespace

std::vector<std::string> splitMethods(std::string_view text) {
    std::vector<std::string> items;
    for (size_t from = 0; from <= text.size();) {
        const size_t end = std::min(text.find_first_of(", ", from), text.size());
        const std::string_view item = text.substr(from, end - from);
        const size_t mark = item.find_first_of("=:+");
        if (!item.empty()) {
            if (mark != std::string_view::npos && item[mark] == '=' && !items.empty())
                items.back() += "," + std::string(item);
            else
                items.emplace_back(item);
        }
        from = end + 1;
    }
    return items;
}

bool isMethodSet(std::string_view text) { return text == kAll || isFamily(text) || !ofRunnable(text).empty(); }

std::vector<MethodSet> methodSets(bool withShot) {
    std::vector<MethodSet> sets = {{std::string(kAll), "every method"}};
    for (const Family& f : families()) sets.push_back({std::string(f.name), std::string(f.meaning)});
    if (!withShot) return sets;
    sets.push_back({std::string(kRunnable), "every method that the shot can serve"});
    for (const Family& f : families())
        sets.push_back(
            {std::string(kRunnable) + ":" + std::string(f.name), "those of them that are " + std::string(f.name)});
    return sets;
}

ChosenMethods chooseMethods(const std::vector<std::string>& texts, const WhyNot& whyNot) {
    ChosenMethods chosen;
    std::set<std::string> written, folders;
    std::vector<std::string> items;
    for (const auto& text : texts)
        for (auto& item : splitMethods(text)) items.push_back(std::move(item));
    if (items.empty()) throw UsageError("expected a method, found nothing; `aaresolve list` shows all");
    for (const auto& item : items) {
        if (!isMethodSet(item)) {
            const std::string head = item.substr(0, item.find_first_of(":+"));
            if (isMethodSet(head))
                throw UsageError("'" + item + "': " + head +
                                 " is a set of methods, which takes no parameters and no "
                                 "stages");
            MethodSpec spec = parseMethod(item);
            if (!written.insert(spec.folderName()).second) throw UsageError("method '" + item + "' is given twice");
            if (folders.insert(spec.folderName()).second) chosen.methods.push_back(std::move(spec));
            continue;
        }
        const std::string_view runnable = ofRunnable(item), set = runnable.empty() ? item : runnable;
        if (!runnable.empty() && !whyNot)
            throw UsageError("'" + item + "' asks what a shot can serve, and there is none here; choose " +
                             std::string(runnable) + ", or methods by name");
        std::vector<std::string> refused;
        for (const auto& m : registry()) {
            if (set != kAll && m.family != set) continue;
            MethodSpec spec = parseMethod(m.id);
            if (whyNot && !whyNot(spec).empty())
                refused.emplace_back(m.id);
            else if (folders.insert(spec.folderName()).second)
                chosen.methods.push_back(std::move(spec));
        }
        if (!runnable.empty())
            chosen.leftOut.insert(chosen.leftOut.end(), refused.begin(), refused.end());
        else if (!refused.empty())
            throw InputError("'" + item + "' holds methods that this shot cannot serve: " + listed(refused) +
                             "; choose runnable" + (set == kAll ? "" : ":" + std::string(set)) +
                             ", and see `aaresolve list --shot SHOT` for what is missing");
    }
    return chosen;
}

std::vector<const MethodDescriptor*> methodsLike(std::string_view word) {
    std::vector<const MethodDescriptor*> found;
    for (const auto& m : registry())
        if (isSearchedBy(word, m.id, m.title, m.family)) found.push_back(&m);
    return found;
}

}  // namespace aa
