#pragma once

#include <cstdarg>
#include <cstdio>
#include <string>

namespace aa {

// printf into a string, of 255 bytes at most.
[[gnu::format(printf, 1, 2)]] inline std::string formatted(const char* format, ...) {
    char text[256];
    va_list values;
    va_start(values, format);
    std::vsnprintf(text, sizeof text, format, values);
    va_end(values);
    return text;
}

}  // namespace aa
