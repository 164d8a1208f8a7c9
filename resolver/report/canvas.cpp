#include "report/canvas.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
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

// What a bundle brings, else where distributions put the DejaVu fonts (Debian fonts-dejavu-core, Fedora, Arch, a user's
// own).
std::string fontFile(Canvas::Font font) {
    const char* name = font == Canvas::Font::bold ? "DejaVuSans-Bold.ttf" : "DejaVuSans.ttf";
    std::vector<fs::path> folders = {"/usr/share/fonts/truetype/dejavu", "/usr/share/fonts/dejavu-sans-fonts",
                                     "/usr/share/fonts/dejavu", "/usr/share/fonts/TTF", "/usr/local/share/fonts"};
    if (const fs::path folder = programFolder(); !folder.empty())
        folders.insert(folders.begin(), folder.parent_path() / "share" / "aaresolve" / "fonts");
    if (const char* home = std::getenv("HOME"))
        folders.insert(folders.end(), {fs::path(home) / ".local/share/fonts", fs::path(home) / ".fonts"});
    for (const auto& folder : folders)
        if (std::error_code ignored; fs::exists(folder / name, ignored)) return (folder / name).string();
    throw InputError(std::string(name) +
                     ": no such font on this machine; install the DejaVu fonts (fonts-dejavu-core)");
}
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
// FreeType and the two faces, each opened when it is first needed.
class Fonts {
  public:
    Fonts() {
        if (FT_Init_FreeType(&library_)) throw InputError("FreeType cannot be started; install it again");
    }
    ~Fonts() { FT_Done_FreeType(library_); }
    Fonts(const Fonts&) = delete;
    Fonts& operator=(const Fonts&) = delete;

    // Calls draw(x, glyph) for each character: x is the pen's, from 0, in whole pixels.
    template <class Draw>
    void each(const std::string& text, int sizePx, Canvas::Font font, Draw draw) {
        const FT_Face face = faceOf(font);
        FT_Set_Pixel_Sizes(face, 0, FT_UInt(sizePx));
        int x = 0;
        for (size_t at = 0; at < text.size();) {
            if (FT_Load_Char(face, nextCharacter(text, at), FT_LOAD_RENDER)) continue;
            draw(x, *face->glyph);
            x += int(face->glyph->advance.x >> 6);
        }
    }

  private:
    FT_Face faceOf(Canvas::Font font) {
        FT_Face& face = faces_[font];
        if (!face)
            if (const std::string file = fontFile(font); FT_New_Face(library_, file.c_str(), 0, &face))
                throw InputError(file + ": not a font that can be read; install the DejaVu fonts (fonts-dejavu-core)");
        return face;
    }
    FT_Library library_ = nullptr;
    std::map<Canvas::Font, FT_Face> faces_;
};
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
}  // namespace

// Encoded values are kept as 8-bit codes, as in the file.
struct Canvas::Pixels {
    int width, height;
    std::vector<unsigned char> codes;  // R G B R G B ...
    Fonts fonts;

    bool holds(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
    unsigned char* at(int x, int y) { return codes.data() + (size_t(y) * size_t(width) + size_t(x)) * 3; }
};

namespace {
unsigned char codeOf(float v) { return static_cast<unsigned char>(255.0f * (v > 0 ? std::min(v, 1.0f) : 0.0f) + 0.5f); }
}  // namespace

Canvas::Canvas(int width, int height, Colour background)
    : pixels_(new Pixels{width, height, std::vector<unsigned char>(size_t(width) * size_t(height) * 3), {}}) {
    fill({0, 0, width, height}, background);
}
Canvas::~Canvas() = default;
int Canvas::width() const { return pixels_->width; }
int Canvas::height() const { return pixels_->height; }

void Canvas::fill(const Window& a, Colour colour) {
    for (int y = std::max(a.y, 0); y < std::min(a.y + a.height, height()); y++)
        for (int x = std::max(a.x, 0); x < std::min(a.x + a.width, width()); x++)
            std::transform(colour.begin(), colour.end(), pixels_->at(x, y), codeOf);
}
void Canvas::frame(const Window& a, Colour colour, int t) {
    fill({a.x - t, a.y - t, a.width + 2 * t, t}, colour);
    fill({a.x - t, a.y + a.height, a.width + 2 * t, t}, colour);
    fill({a.x - t, a.y, t, a.height}, colour);
    fill({a.x + a.width, a.y, t, a.height}, colour);
}
void Canvas::draw(const Rgb& encoded, int x0, int y0, int magnification) {
    const int w = encoded.width() * magnification, h = encoded.height() * magnification;
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++)
            if (pixels_->holds(x0 + x, y0 + y))
                for (size_t c = 0; c < 3; c++)
                    pixels_->at(x0 + x, y0 + y)[c] = codeOf(encoded.c[c].at(x / magnification, y / magnification));
}
void Canvas::text(int x0, int y0, const std::string& text, int sizePx, Colour colour, Font font, Align align) {
    const int start =
        x0 - (align == Align::left ? 0 : textWidth(text, sizePx, font) / (align == Align::centre ? 2 : 1));
    pixels_->fonts.each(text, sizePx, font, [&](int pen, const FT_GlyphSlotRec_& glyph) {
        const FT_Bitmap& b = glyph.bitmap;
        for (int j = 0; j < int(b.rows); j++)
            for (int i = 0; i < int(b.width); i++) {
                const int x = start + pen + glyph.bitmap_left + i, y = y0 - glyph.bitmap_top + j;
                const float covered = float(b.buffer[j * b.pitch + i]) / 255.0f;
                if (!pixels_->holds(x, y)) continue;
                unsigned char* to = pixels_->at(x, y);
                for (size_t c = 0; c < 3; c++)
                    to[c] = codeOf(covered * colour[c] + (1.0f - covered) * (float(to[c]) / 255.0f));
            }
    });
}
// From the first mark to a pixel past the last one.
int Canvas::textWidth(const std::string& text, int sizePx, Font font) const {
    int begin = std::numeric_limits<int>::max(), end = std::numeric_limits<int>::min();
    pixels_->fonts.each(text, sizePx, font, [&](int pen, const FT_GlyphSlotRec_& glyph) {
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
void Canvas::writePng(const fs::path& file) const {
    writeBytes(file, pngBytes(pixels_->codes, width(), height(), {.srgb = false}));
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
