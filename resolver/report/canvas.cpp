#include "report/canvas.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <string_view>
#include <vector>

#include "image/colour.h"
#include "image/error.h"
#include "image/io.h"
#include "image/png.h"
#include "image/program_folder.h"

namespace aa {
namespace fs = std::filesystem;
namespace {

// The character that starts at `at`, which moves on; bytes that are no UTF-8 are the replacement character.
uint32_t nextCharacter(std::string_view text, size_t& at) {
    constexpr uint32_t kReplacement = 0xfffd;
    const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char first = byte(at++);
    if (first < 0x80) return first;
    const int more = first >= 0xf0 && first < 0xf8 ? 3 : first >= 0xe0 ? 2 : first >= 0xc0 ? 1 : 0;
    if (more == 0 || first >= 0xf8) return kReplacement;
    uint32_t character = first & (0x3fu >> more);
    for (int i = 0; i < more; i++, at++) {
        if (at == text.size() || (byte(at) & 0xc0) != 0x80) return kReplacement;
        character = character << 6 | (byte(at) & 0x3fu);
    }
    return character;
}
// With the replacement character in place of bytes that are no UTF-8, which a PDF would not take.
std::string validUtf8(const std::string& text) {
    std::string valid;
    for (size_t at = 0; at < text.size();) {
        const size_t first = at;
        const bool known = nextCharacter(text, at) != 0xfffd;
        valid += known ? text.substr(first, at - first) : "\xef\xbf\xbd";
    }
    return valid;
}
// Weighted sum of the source columns (or rows) that target cell i covers.
struct Span {
    int first;
    std::vector<double> weights;
};
std::vector<Span> spans(int from, int to) {
    std::vector<Span> all;
    const double scale = double(from) / to;
    for (int i = 0; i < to; i++) {
        const double begin = i * scale, end = std::min(double(from), (i + 1) * scale);
        Span s{int(begin), {}};
        for (int k = s.first; k < from && k < end; k++)
            s.weights.push_back((std::min(end, k + 1.0) - std::max(begin, double(k))) / (end - begin));
        all.push_back(s);
    }
    return all;
}
unsigned char codeOf(float v) { return static_cast<unsigned char>(code8(v)); }

// The pixels while marks are drawn onto them.
struct Pixels {
    int width, height;
    std::vector<unsigned char> codes;

    bool holds(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
    unsigned char* at(int x, int y) { return codes.data() + (size_t(y) * size_t(width) + size_t(x)) * 3; }
    void draw(const Canvas::Fill& f) {
        const Window& a = f.area;
        std::array<unsigned char, 3> code;
        std::transform(f.colour.begin(), f.colour.end(), code.begin(), codeOf);
        for (int y = std::max(a.y, 0); y < std::min(a.y + a.height, height); y++)
            for (int x = std::max(a.x, 0); x < std::min(a.x + a.width, width); x++)
                std::copy(code.begin(), code.end(), at(x, y));
    }
    void draw(const Canvas::Picture& p) {
        const int w = p.width * p.magnification, h = p.height * p.magnification;
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++)
                if (holds(p.x + x, p.y + y))
                    std::copy_n(
                        &p.codes[(size_t(y / p.magnification) * size_t(p.width) + size_t(x / p.magnification)) * 3], 3,
                        at(p.x + x, p.y + y));
    }
    void draw(const Canvas::Text& t, int pen, const FT_GlyphSlotRec_& glyph) {
        const FT_Bitmap& b = glyph.bitmap;
        for (int j = 0; j < int(b.rows); j++)
            for (int i = 0; i < int(b.width); i++) {
                const int x = t.x + pen + glyph.bitmap_left + i, y = t.y - glyph.bitmap_top + j;
                const float covered = float(b.buffer[j * b.pitch + i]) / 255.0f;
                if (!holds(x, y)) continue;
                unsigned char* to = at(x, y);
                for (size_t c = 0; c < 3; c++)
                    to[c] = codeOf(covered * t.colour[c] + (1.0f - covered) * (float(to[c]) / 255.0f));
            }
    }
};
}  // namespace

// What a bundle brings, else where distributions put the DejaVu fonts (Debian fonts-dejavu-core, Fedora, Arch, a user's
// own).
fs::path Canvas::fontFile(Font font) {
    const char* name = font == Canvas::Font::bold ? "DejaVuSans-Bold.ttf" : "DejaVuSans.ttf";
    std::vector<fs::path> folders = {"/usr/share/fonts/truetype/dejavu", "/usr/share/fonts/dejavu-sans-fonts",
                                     "/usr/share/fonts/dejavu", "/usr/share/fonts/TTF", "/usr/local/share/fonts"};
    if (const fs::path folder = programFolder(); !folder.empty())
        folders.insert(folders.begin(), folder.parent_path() / "share" / "aaresolve" / "fonts");
    if (const char* home = std::getenv("HOME"))
        folders.insert(folders.end(), {fs::path(home) / ".local/share/fonts", fs::path(home) / ".fonts"});
    for (const auto& folder : folders)
        if (std::error_code ignored; fs::exists(folder / name, ignored)) return folder / name;
    throw InputError(std::string(name) +
                     ": no such font on this machine; install the DejaVu fonts (fonts-dejavu-core)");
}
// FreeType and the two faces, each opened when it is first needed.
class Canvas::Fonts {
  public:
    Fonts() {
        if (FT_Init_FreeType(&library_)) throw InputError("FreeType cannot be started; install it again");
    }
    ~Fonts() { FT_Done_FreeType(library_); }
    Fonts(const Fonts&) = delete;
    Fonts& operator=(const Fonts&) = delete;

    // Calls draw(x, glyph) for each character: x is the pen's, from 0, in whole pixels. Returns where it ends.
    template <class Draw>
    int each(const std::string& text, int sizePx, Font font, Draw draw) {
        const FT_Face face = faceOf(font);
        FT_Set_Pixel_Sizes(face, 0, FT_UInt(sizePx));
        int x = 0;
        for (size_t at = 0; at < text.size();) {
            if (FT_Load_Char(face, nextCharacter(text, at), FT_LOAD_RENDER)) continue;
            draw(x, *face->glyph);
            x += int(face->glyph->advance.x >> 6);
        }
        return x;
    }

  private:
    FT_Face faceOf(Font font) {
        FT_Face& face = faces_[font];
        if (!face)
            if (const std::string file = fontFile(font).string(); FT_New_Face(library_, file.c_str(), 0, &face))
                throw InputError(file + ": not a font that can be read; install the DejaVu fonts (fonts-dejavu-core)");
        return face;
    }
    FT_Library library_ = nullptr;
    std::map<Font, FT_Face> faces_;
};
Canvas::Canvas(int width, int height, Colour background)
    : width_(width), height_(height), fonts_(std::make_unique<Fonts>()) {
    fill({0, 0, width, height}, background);
}
Canvas::~Canvas() = default;
Canvas::Canvas(Canvas&&) noexcept = default;
Canvas& Canvas::operator=(Canvas&&) noexcept = default;

void Canvas::fill(const Window& area, Colour colour) { marks_.push_back(Fill{area, colour}); }
void Canvas::frame(const Window& a, Colour colour, int t) {
    fill({a.x - t, a.y - t, a.width + 2 * t, t}, colour);
    fill({a.x - t, a.y + a.height, a.width + 2 * t, t}, colour);
    fill({a.x - t, a.y, t, a.height}, colour);
    fill({a.x + a.width, a.y, t, a.height}, colour);
}
void Canvas::draw(const Rgb& encoded, int x, int y, int magnification) {
    marks_.push_back(Picture{x, y, magnification, encoded.width(), encoded.height(), codesOf(encoded)});
}
void Canvas::text(int x0, int y0, const std::string& text, int sizePx, Colour colour, Font font, Align align) {
    const int start =
        x0 - (align == Align::left ? 0 : textWidth(text, sizePx, font) / (align == Align::centre ? 2 : 1));
    const int advance = fonts_->each(text, sizePx, font, [](int, const FT_GlyphSlotRec_&) {});
    marks_.push_back(Text{start, y0, sizePx, advance, validUtf8(text), colour, font});
}
// From the first mark to a pixel past the last one.
int Canvas::textWidth(const std::string& text, int sizePx, Font font) const {
    int begin = std::numeric_limits<int>::max(), end = std::numeric_limits<int>::min();
    fonts_->each(text, sizePx, font, [&](int pen, const FT_GlyphSlotRec_& glyph) {
        begin = std::min(begin, pen + glyph.bitmap_left);
        end = std::max(end, pen + glyph.bitmap_left + int(glyph.bitmap.width) + 1);
    });
    return end > begin ? end - begin : 0;
}
std::string Canvas::fitted(const std::string& text, int maxWidth, int sizePx, Font font) const {
    if (textWidth(text, sizePx, font) <= maxWidth) return text;
    std::string cut = text;
    while (!cut.empty() && textWidth(cut + "...", sizePx, font) > maxWidth) {
        while (cut.size() > 1 && (static_cast<unsigned char>(cut.back()) & 0xc0) == 0x80) cut.pop_back();
        cut.pop_back();
    }
    return cut + "...";
}
std::vector<std::string> Canvas::wrapped(const std::string& text, int maxWidth, int sizePx, Font font) const {
    const auto fits = [&](std::string line) {
        while (line.ends_with(' ')) line.pop_back();
        return textWidth(line, sizePx, font) <= maxWidth;
    };
    // The longest piece of `piece` from its start that fits, a character at least.
    const auto part = [&](const std::string& piece) {
        size_t end = 0;
        for (size_t at = 0; at < piece.size();) {
            nextCharacter(piece, at);
            if (end > 0 && !fits(piece.substr(0, at))) break;
            end = at;
        }
        return end;
    };
    std::vector<std::string> lines = {""};
    for (size_t at = 0; at < text.size();) {
        size_t end = text.find_first_of(" ,:/+", at + (text[at] == '+'));
        end = end == std::string::npos ? text.size() : text[end] == '+' && end > at ? end : end + 1;
        std::string piece = text.substr(at, end - at);
        at = end;
        if (fits(lines.back() + piece)) {
            lines.back() += piece;
            continue;
        }
        if (!lines.back().empty()) lines.emplace_back();
        for (; !fits(piece); lines.emplace_back()) {
            const size_t cut = part(piece);
            if (cut == piece.size()) break;
            lines.back() = piece.substr(0, cut);
            piece.erase(0, cut);
        }
        lines.back() = piece;
    }
    for (auto& line : lines)
        while (line.ends_with(' ')) line.pop_back();
    return lines;
}
std::vector<unsigned char> Canvas::codes() const {
    Pixels pixels{width_, height_, std::vector<unsigned char>(size_t(width_) * size_t(height_) * 3)};
    for (const Mark& mark : marks_) {
        if (const Text* t = std::get_if<Text>(&mark))
            fonts_->each(t->text, t->sizePx, t->font,
                         [&](int pen, const FT_GlyphSlotRec_& glyph) { pixels.draw(*t, pen, glyph); });
        else if (const Fill* f = std::get_if<Fill>(&mark))
            pixels.draw(*f);
        else
            pixels.draw(std::get<Picture>(mark));
    }
    return std::move(pixels.codes);
}
void Canvas::writePng(const fs::path& file) const {
    writeBytes(file, pngBytes(codes(), width(), height(), {.srgb = false}));
}

PlaneF shrunk(const PlaneF& plane, int width, int height) {
    const auto columns = spans(plane.width(), width), rows = spans(plane.height(), height);
    PlaneF out(width, height);
    std::vector<double> line(static_cast<size_t>(plane.width()));
    for (int y = 0; y < height; y++) {
        const Span& r = rows[size_t(y)];
        std::fill(line.begin(), line.end(), 0.0);
        for (size_t j = 0; j < r.weights.size(); j++)
            for (int x = 0; x < plane.width(); x++)
                line[size_t(x)] += r.weights[j] * double(plane.at(x, r.first + int(j)));
        for (int x = 0; x < width; x++) {
            const Span& s = columns[size_t(x)];
            double sum = 0;
            for (size_t i = 0; i < s.weights.size(); i++) sum += s.weights[i] * line[size_t(s.first) + i];
            out.at(x, y) = float(sum);
        }
    }
    return out;
}
Rgb shrunk(const Rgb& encodedImage, int width, int height, const Exec& exec) {
    if (width == encodedImage.width() && height == encodedImage.height()) return encodedImage;
    Rgb linear, small, out;
    decode(encodedImage, {}, exec, linear);
    for (size_t c = 0; c < 3; c++) small.c[c] = shrunk(linear.c[c], width, height);
    small.fillBorder();
    encode(small, {}, exec, out);
    return out;
}
}  // namespace aa
