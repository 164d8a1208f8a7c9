#include "report/canvas.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "image/colour.h"
#include "image/error.h"
#include "image/io.h"

namespace aa {
namespace fs = std::filesystem;
namespace {

// Where distributions put the DejaVu fonts (Debian fonts-dejavu-core, Fedora, Arch, a user's own).
std::string fontFile(Canvas::Font font) {
    const char* name = font == Canvas::Font::bold ? "DejaVuSans-Bold.ttf" : "DejaVuSans.ttf";
    std::vector<fs::path> folders = {"/usr/share/fonts/truetype/dejavu", "/usr/share/fonts/dejavu-sans-fonts",
                                     "/usr/share/fonts/dejavu", "/usr/share/fonts/TTF", "/usr/local/share/fonts"};
    if (const char* home = std::getenv("HOME"))
        folders.insert(folders.end(), {fs::path(home) / ".local/share/fonts", fs::path(home) / ".fonts"});
    for (const auto& folder : folders)
        if (std::error_code ignored; fs::exists(folder / name, ignored)) return (folder / name).string();
    throw InputError(std::string(name) +
                     ": no such font on this machine; install the DejaVu fonts (fonts-dejavu-core)");
}
const std::string& cachedFontFile(Canvas::Font font) {
    static const std::string regular = fontFile(Canvas::Font::regular), bold = fontFile(Canvas::Font::bold);
    return font == Canvas::Font::bold ? bold : regular;
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
}  // namespace

struct Canvas::Pixels {
    OIIO::ImageBuf image;
};

Canvas::Canvas(int width, int height, Colour background) : pixels_(std::make_unique<Pixels>()) {
    pixels_->image.reset(OIIO::ImageSpec(width, height, 3, OIIO::TypeDesc::UINT8));
    fill({0, 0, width, height}, background);
}
Canvas::~Canvas() = default;
int Canvas::width() const { return pixels_->image.spec().width; }
int Canvas::height() const { return pixels_->image.spec().height; }

void Canvas::fill(const Window& a, Colour colour) {
    OIIO::ImageBufAlgo::fill(pixels_->image, OIIO::cspan<float>(colour.data(), 3),
                             OIIO::ROI(a.x, a.x + a.width, a.y, a.y + a.height));
}
void Canvas::frame(const Window& a, Colour colour, int t) {
    fill({a.x - t, a.y - t, a.width + 2 * t, t}, colour);
    fill({a.x - t, a.y + a.height, a.width + 2 * t, t}, colour);
    fill({a.x - t, a.y, t, a.height}, colour);
    fill({a.x + a.width, a.y, t, a.height}, colour);
}
void Canvas::draw(const Rgb& encoded, int x0, int y0, int magnification) {
    const int w = encoded.width() * magnification, h = encoded.height() * magnification;
    OIIO::ImageBuf::Iterator<unsigned char, float> p(pixels_->image, OIIO::ROI(x0, x0 + w, y0, y0 + h));
    for (; !p.done(); ++p)
        for (int c = 0; c < 3; c++) {
            const float v = encoded.c[size_t(c)].at((p.x() - x0) / magnification, (p.y() - y0) / magnification);
            p[c] = v > 0 ? std::min(v, 1.0f) : 0.0f;
        }
}
void Canvas::text(int x, int y, const std::string& text, int sizePx, Colour colour, Font font, Align align) {
    const int shift = align == Align::left ? 0 : textWidth(text, sizePx, font) / (align == Align::centre ? 2 : 1);
    if (!OIIO::ImageBufAlgo::render_text(pixels_->image, x - shift, y, text, sizePx, cachedFontFile(font),
                                         OIIO::cspan<float>(colour.data(), 3)))
        throw InputError(cachedFontFile(font) + ": text cannot be drawn (" + pixels_->image.geterror() +
                         "); OpenImageIO needs FreeType");
}
int Canvas::textWidth(const std::string& text, int sizePx, Font font) const {
    const OIIO::ROI drawn = OIIO::ImageBufAlgo::text_size(text, sizePx, cachedFontFile(font));
    return drawn.xend > drawn.xbegin ? drawn.width() : 0;  // inside out for a text without marks
}
std::string Canvas::fitted(const std::string& text, int maxWidth, int sizePx, Font font) const {
    if (textWidth(text, sizePx, font) <= maxWidth) return text;
    std::string cut = text;
    while (!cut.empty() && textWidth(cut + "...", sizePx, font) > maxWidth) cut.pop_back();
    return cut + "...";
}
void Canvas::writePng(const fs::path& file) const {
    const fs::path temporary = temporaryName(file);
    if (!pixels_->image.write(temporary.string(), OIIO::TypeDesc::UINT8)) {
        std::error_code ignored;
        fs::remove(temporary, ignored);
        throw InputError(file.string() + ": cannot be written (" + pixels_->image.geterror() +
                         "); check permissions and free disk space");
    }
    renameInto(temporary, file);
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
Rgb cropped(const Rgb& image, const Window& window) {
    Rgb out(window.width, window.height);
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < window.height; y++)
            std::copy_n(image.c[c].row(window.y + y) + window.x, window.width, out.c[c].row(y));
    out.fillBorder();
    return out;
}

}  // namespace aa
