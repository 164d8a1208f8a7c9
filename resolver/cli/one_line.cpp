#include "cli/one_line.h"

namespace aa {

std::string onOneLine(std::string_view text) {
    std::string line;
    for (size_t i = 0; i < text.size(); i++) {
        const auto c = static_cast<unsigned char>(text[i]);
        // U+0080 to U+009F in UTF-8: terminals take these, too.
        const bool isC1 = c == 0xc2 && i + 1 < text.size() && (static_cast<unsigned char>(text[i + 1]) & 0xe0) == 0x80;
        if (isC1) i++;
        line += c == '\n' || c == '\r' || c == '\t' ? ' ' : c < 0x20 || c == 0x7f || isC1 ? '?' : text[i];
    }
    return line;
}

}  // namespace aa
