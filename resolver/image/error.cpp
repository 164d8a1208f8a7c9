#include "image/error.h"

#include <algorithm>

namespace aa {

std::string suggestion(std::string_view word, const std::vector<std::string_view>& candidates) {
    size_t best = std::max<size_t>(2, word.size() / 3) + 1;
    std::string_view found;
    auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; };
    for (std::string_view c : candidates) {
        std::vector<size_t> row(c.size() + 1);
        for (size_t j = 0; j <= c.size(); j++) row[j] = j;
        for (size_t i = 1; i <= word.size(); i++) {
            size_t diagonal = row[0];
            row[0] = i;
            for (size_t j = 1; j <= c.size(); j++) {
                const size_t change = diagonal + (lower(word[i - 1]) != lower(c[j - 1]));
                diagonal = row[j];
                row[j] = std::min({change, row[j] + 1, row[j - 1] + 1});
            }
        }
        if (row[c.size()] < best) best = row[c.size()], found = c;
    }
    return std::string(found);
}

}  // namespace aa
