#pragma once

#include <string>

namespace aa {

// Text for an element or an attribute of HTML or XML. XML has no control characters but those of a line's end.
inline std::string forMarkup(const std::string& text) {
    std::string safe;
    for (const char c : text) {
        if (c == '&')
            safe += "&amp;";
        else if (c == '<')
            safe += "&lt;";
        else if (c == '>')
            safe += "&gt;";
        else if (c == '"')
            safe += "&quot;";
        else
            safe += static_cast<unsigned char>(c) < 32 ? ' ' : c;
    }
    return safe;
}

}  // namespace aa
