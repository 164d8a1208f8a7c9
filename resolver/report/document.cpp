#include "report/document.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <fstream>
#include <system_error>

#include "documents/module.h"
#include "image/apng.h"
#include "image/error.h"
#include "image/io.h"
#include "image/lower_case.h"
#include "image/own_module.h"
#include "image/palette.h"

namespace aa {
namespace fs = std::filesystem;
namespace {
constexpr const char* kModule = "aaresolve_documents.so";
constexpr const char* kVariable = "AARESOLVE_DOCUMENTS";
// 144 pixels to the inch: 14 px of text are 7 points.
constexpr double kPointsPerPx = 0.5;

struct Ending {
    const char* text;
    DocumentKind kind;
    const char* libraries;  // that the module draws in
};
constexpr Ending kEndings[] = {{".png", DocumentKind::png, ""},
                               {".webp", DocumentKind::webp, "libwebp"},
                               {".pdf", DocumentKind::pdf, "cairo"},
                               {".gif", DocumentKind::gif, "giflib"},
                               {".apng", DocumentKind::apng, ""}};

const Ending* endingOf(const fs::path& file) {
    const std::string ending = lowerExtension(file);
    const auto found =
        std::find_if(std::begin(kEndings), std::end(kEndings), [&](const Ending& e) { return ending == e.text; });
    return found == std::end(kEndings) ? nullptr : found;
}

template <class Function>
Function moduleFunction(const char* name, const fs::path& file) {
    static OwnModule module(kModule, kVariable);
    if (const auto function = module.function<Function>(name)) return function;
    const Ending& ending = *endingOf(file);
    throw InputError(file.string() + ": " + (ending.text + 1) + " files need the module " + kModule + " and " +
                     ending.libraries + " (" + module.whyNot() + "); install them, set " + kVariable +
                     " to the module's path, or write a .png or .apng");
}
// `write(temporary name)` says null or why not.
template <class Write>
void throughTemporary(const fs::path& file, Write write) {
    const fs::path temporary = temporaryName(file);
    // The libraries do not say why a file cannot be opened.
    if (!std::ofstream(temporary, std::ios::binary)) giveUpWriting(file, std::generic_category().message(errno));
    if (const char* why = write(temporary.c_str())) giveUpWriting(file, why);
    renameInto(temporary, file);
}

AaMark markOf(const Canvas::Fill& f) {
    AaMark m{.kind = AaMark::isFill, .x = f.area.x, .y = f.area.y, .width = f.area.width, .height = f.area.height};
    std::copy(f.colour.begin(), f.colour.end(), m.colour);
    return m;
}
AaMark markOf(const Canvas::Picture& p) {
    AaMark m{.kind = AaMark::isPicture, .x = p.x, .y = p.y, .width = p.width, .height = p.height};
    m.magnification = p.magnification, m.codes = p.codes.data();
    return m;
}
AaMark markOf(const Canvas::Text& t) {
    AaMark m{.kind = AaMark::isText, .x = t.x, .y = t.y, .width = t.advancePx, .height = t.sizePx};
    std::copy(t.colour.begin(), t.colour.end(), m.colour);
    m.text = t.text.c_str(), m.bold = t.font == Canvas::Font::bold;
    return m;
}
void writePdf(const std::vector<Canvas>& pages, const fs::path& file, const std::string& title) {
    const auto write = moduleFunction<AaWritePdf>(kAaWritePdf, file);
    std::vector<std::vector<AaMark>> marks;
    std::vector<AaPage> all;
    for (const Canvas& page : pages) {
        auto& of = marks.emplace_back();
        for (const auto& mark : page.marks()) of.push_back(std::visit([](const auto& m) { return markOf(m); }, mark));
        all.push_back({page.width(), page.height(), of.data(), of.size()});
    }
    const std::string regular = Canvas::fontFile(Canvas::Font::regular).string(),
                      bold = Canvas::fontFile(Canvas::Font::bold).string();
    const AaPdf pdf{all.data(), all.size(), kPointsPerPx, title.c_str(), regular.c_str(), bold.c_str()};
    throughTemporary(file, [&](const char* to) { return write(to, &pdf); });
}
void writeWebp(const std::vector<std::vector<unsigned char>>& frames, int width, int height, int milliseconds,
               const fs::path& file) {
    const auto write = moduleFunction<AaWriteWebp>(kAaWriteWebp, file);
    std::vector<const unsigned char*> starts;
    for (const auto& f : frames) starts.push_back(f.data());
    const AaLoop loop{width, height, starts.data(), starts.size(), milliseconds};
    throughTemporary(file, [&](const char* to) { return write(to, &loop); });
}
void writeGif(const std::vector<std::vector<unsigned char>>& frames, int width, int height, int milliseconds,
              const fs::path& file) {
    const auto write = moduleFunction<AaWriteGif>(kAaWriteGif, file);
    const Paletted indexed = paletted(frames);
    std::vector<const unsigned char*> starts;
    for (const auto& f : indexed.frames) starts.push_back(f.data());
    const AaLoop loop{width, height, starts.data(), starts.size(), milliseconds};
    throughTemporary(file, [&](const char* to) {
        return write(to, &loop, indexed.palette.data(), int(indexed.palette.size() / 3));
    });
}
fs::path numbered(const fs::path& file, size_t page) {
    return file.parent_path() / (file.stem().string() + "-" + std::to_string(page) + file.extension().string());
}
}  // namespace

DocumentKind documentKindOf(const fs::path& file, const std::string& option) {
    if (const Ending* ending = endingOf(file)) return ending->kind;
    throw UsageError(option + " " + file.string() +
                     ": the name's ending says what is written; expected .png, .webp, .pdf, or for a loop .gif, .apng "
                     "or .webp" +
                     (file.has_extension() ? ", found '" + file.extension().string() + "'" : ", found none"));
}

std::vector<fs::path> writePages(const std::vector<Canvas>& pages, const fs::path& file, const std::string& title,
                                 bool firstKeepsName) {
    const DocumentKind kind = documentKindOf(file, "-o");
    if (kind == DocumentKind::pdf) {
        writePdf(pages, file, title);
        return {file};
    }
    std::vector<fs::path> written;
    for (const Canvas& page : pages) {
        const bool keepsName = pages.size() == 1 || (firstKeepsName && written.empty());
        written.push_back(keepsName ? file : numbered(file, written.size() + 1));
        if (kind == DocumentKind::webp)
            writeWebp({page.codes()}, page.width(), page.height(), 1, written.back());
        else
            page.writePng(written.back());
    }
    return written;
}

void writeLoop(const std::vector<Canvas>& frames, int milliseconds, const fs::path& file) {
    const DocumentKind kind = documentKindOf(file, "-o");
    const int width = frames[0].width(), height = frames[0].height();
    std::vector<std::vector<unsigned char>> codes;
    for (const Canvas& frame : frames) codes.push_back(frame.codes());
    if (kind == DocumentKind::gif)
        writeGif(codes, width, height, milliseconds, file);
    else if (kind == DocumentKind::webp)
        writeWebp(codes, width, height, milliseconds, file);
    else
        writeBytes(file, apngBytes(codes, width, height, milliseconds));
}

}  // namespace aa
