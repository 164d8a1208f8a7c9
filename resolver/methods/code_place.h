// Where in the source something stands, so that an error of programming names the file to mend.
#pragma once
#include <string>
#include <string_view>

namespace aa {

// As a default argument, or as a member of an aggregate, it is the place of the call or of the braces:
// `double real(name, CodePlace at = {})`.
struct CodePlace {
    const char* file = __builtin_FILE();
    int line = __builtin_LINE();
    // "resolver/methods/spatial/x.cpp", wherever the tree was built.
    std::string_view path() const {
        const std::string_view whole = file;
        const size_t start = whole.rfind("/resolver/");
        return start == std::string_view::npos ? whole : whole.substr(start + 1);
    }
    std::string text() const { return std::string(path()) + ":" + std::to_string(line); }
};

}  // namespace aa
