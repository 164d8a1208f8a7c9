#include "methods/family.h"

#include <algorithm>
#include <string>

#include "image/lower_case.h"

namespace aa {

const std::vector<Family>& families() {
    static const std::vector<Family> all = {
        {"reference", "what the others are held against: none, and averages of many samples", {}},
        {"spatial", "filters of one finished picture", {"post", "postprocess", "morphological"}},
        {"geometry",
         "use what the renderer knows of surfaces: sub-samples, edges, ids",
         {"geometric", "multisampling"}},
        {"temporal", "accumulate jittered frames", {"taa", "accumulation"}},
    };
    return all;
}

const Family* familyCalled(std::string_view name) {
    const std::string wanted = lowerCase(name);
    for (const Family& f : families())
        if (f.name == wanted || std::count(f.alsoCalled.begin(), f.alsoCalled.end(), wanted)) return &f;
    return nullptr;
}

bool isSearchedBy(std::string_view word, std::string_view id, std::string_view title, std::string_view family) {
    if (word.size() < 2) return false;  // a letter is in every other name
    const std::string wanted = lowerCase(word);
    const Family* const called = familyCalled(word);
    return lowerCase(id).find(wanted) != std::string::npos || lowerCase(title).find(wanted) != std::string::npos ||
           (called && called->name == family);
}

}  // namespace aa
