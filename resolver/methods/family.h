// The families of methods, in the registry's order, and what each has in common.
#pragma once
#include <string_view>
#include <vector>

namespace aa {

struct Family {
    std::string_view name, meaning;
    std::vector<std::string_view> alsoCalled;  // what people search for; lower case
};
const std::vector<Family>& families();
// The family of this name or of one of its other names, whatever the case; null: there is none.
const Family* familyCalled(std::string_view name);
// Whether a word that somebody searches for fits a method: its id or title holds it, or its family is called so.
bool isSearchedBy(std::string_view word, std::string_view id, std::string_view title, std::string_view family);

}  // namespace aa
