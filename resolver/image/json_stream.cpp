#include "image/json_stream.h"

#include <string>

namespace aa {

void JsonStream::value(std::string_view key, const nlohmann::ordered_json& value) {
    begin(key);
    for (const char c : jsonText(value)) {  // line ends within texts are escaped
        if (c == '\n')
            endLine();
        else
            out_.put(c);
    }
}
void JsonStream::begin(std::string_view key) {
    nextLine();
    out_ << jsonText(nlohmann::ordered_json(key), -1) << ": ";
}
void JsonStream::nextLine() {
    if (!isEmpty_) out_ << ',';
    isEmpty_ = false;
    endLine();
}
void JsonStream::endLine() { out_ << '\n' << std::string(size_t(depth_), ' '); }

}  // namespace aa
