#include "methods/spec.h"

#include <cctype>

#include "image/error.h"
#include "image/file_hash.h"
#include "methods/stage.h"

namespace aa {
namespace {
// The next '+' that a letter follows ("1e+3" is a number), or the length of the text.
size_t startOfStage(std::string_view text, size_t from = 0) {
    for (size_t i = from; i + 1 < text.size(); i++)
        if (text[i] == '+' && std::isalpha(static_cast<unsigned char>(text[i + 1]))) return i;
    return text.size();
}
}  // namespace

std::string withoutStages(std::string_view text) { return std::string(text.substr(0, startOfStage(text))); }
std::string withParameters(std::string_view text, std::string_view parameters) {
    const std::string_view head = text.substr(0, startOfStage(text)), stages = text.substr(head.size());
    return std::string(head) + (head.find(':') == std::string_view::npos ? ":" : ",") + std::string(parameters) +
           std::string(stages);
}

MethodSpec parseMethod(std::string_view text, const std::vector<MethodDescriptor>& among) {
    MethodSpec spec;
    spec.text = std::string(text);
    const size_t plus = startOfStage(text);
    for (size_t from = plus; from < text.size();) {
        const size_t next = startOfStage(text, from + 1);
        spec.stages.push_back(parseStage(text.substr(from + 1, next - from - 1)));
        from = next;
    }
    text = text.substr(0, plus);
    const size_t colon = text.find(':');
    spec.method = &findMethod(text.substr(0, colon), among);
    if (colon != std::string_view::npos) {
        std::string_view rest = text.substr(colon + 1);
        while (!rest.empty()) {
            const size_t comma = rest.find(',');
            const std::string_view item = rest.substr(0, comma);
            rest = comma == std::string_view::npos ? std::string_view{} : rest.substr(comma + 1);
            const size_t eq = item.find('=');
            if (eq == std::string_view::npos || eq == 0)
                throw UsageError("method '" + spec.text + "': expected name=value, found '" + std::string(item) + "'");
            spec.given.emplace_back(item.substr(0, eq), item.substr(eq + 1));
        }
    }
    spec.params();  // throws on a bad parameter
    return spec;
}

PassSet MethodSpec::passes() const {
    PassSet all = passesOf(*method, params());
    for (const auto& stage : stages) all |= passesOf(stage);
    return all;
}

bool MethodSpec::readsEncoded() const {
    for (const auto& stage : stages)
        if (aa::readsEncoded(stage)) return true;
    return method->input == Space::encoded || outputSpace() == Space::encoded;
}

Space MethodSpec::outputSpace() const { return method->outputSpace ? method->outputSpace(params()) : method->output; }

std::string MethodSpec::folderName() const {
    std::string s = text;
    for (char& c : s)
        if (!std::isalnum(static_cast<unsigned char>(c)) &&
            std::string_view("._=,+-").find(c) == std::string_view::npos)
            c = '_';
    constexpr size_t kLongest = 200;  // of the 255 bytes that a file's name may have
    if (s.size() <= kLongest) return s;
    Hash all;
    all.add(text);
    return s.substr(0, kLongest - 33) + "-" + all.digits();
}

std::unique_ptr<Method> MethodSpec::create(const ShotInfo& shot) const {
    return withStages(method->create(params(), shot), *this, shot);
}

PassSet passesOf(const std::vector<MethodSpec>& methods, Sampling sampling) {
    PassSet all;
    for (const auto& m : methods)
        if (m.method->sampling() == sampling) all |= m.passes();
    return all;
}

PassSet passesOf(const std::vector<MethodSpec>& methods) {
    PassSet all;
    for (const auto& m : methods) all |= m.passes();
    return all;
}

}  // namespace aa
