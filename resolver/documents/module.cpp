// PDF through cairo, WebP through libwebp, GIF through giflib: a library of its own because these bring a dozen others,
// whose loading costs more than most commands do.
#include "documents/module.h"

#include <cairo-ft.h>
#include <cairo-pdf.h>
#include <gif_lib.h>
#include <webp/encode.h>
#include <webp/mux.h>

#include <cstdint>
#include <cstdio>
#include <memory>
#include <type_traits>
#include <vector>

#define AA_EXPORT extern "C" __attribute__((visibility("default")))

namespace {
// ---- PDF ----
struct Faces {
    FT_Library library = nullptr;
    FT_Face files[2] = {};
    cairo_font_face_t* faces[2] = {};
    bool open(const char* const fonts[2]) {
        if (FT_Init_FreeType(&library)) return false;
        for (int i = 0; i < 2; i++) {
            if (FT_New_Face(library, fonts[i], 0, &files[i])) return false;
            faces[i] = cairo_ft_font_face_create_for_ft_face(files[i], 0);
        }
        return true;
    }
};
void drawFill(cairo_t* to, const AaMark& m) {
    cairo_set_source_rgb(to, double(m.colour[0]), double(m.colour[1]), double(m.colour[2]));
    cairo_rectangle(to, m.x, m.y, m.width, m.height);
    cairo_fill(to);
}
void drawPicture(cairo_t* to, const AaMark& m) {
    cairo_surface_t* image = cairo_image_surface_create(CAIRO_FORMAT_RGB24, m.width, m.height);
    if (cairo_surface_status(image) == CAIRO_STATUS_SUCCESS) {
        unsigned char* rows = cairo_image_surface_get_data(image);
        const int stride = cairo_image_surface_get_stride(image);
        const unsigned char* from = m.codes;
        for (int y = 0; y < m.height; y++) {
            auto* row = reinterpret_cast<uint32_t*>(rows + ptrdiff_t(y) * stride);
            for (int x = 0; x < m.width; x++, from += 3)
                row[x] = uint32_t(from[0]) << 16 | uint32_t(from[1]) << 8 | uint32_t(from[2]);
        }
        cairo_surface_mark_dirty(image);
    }
    cairo_save(to);
    cairo_translate(to, m.x, m.y);
    cairo_scale(to, m.magnification, m.magnification);
    cairo_set_source_surface(to, image, 0, 0);
    cairo_pattern_set_filter(cairo_get_source(to), CAIRO_FILTER_NEAREST);  // viewers then show pixels as squares
    cairo_rectangle(to, 0, 0, m.width, m.height);
    cairo_fill(to);
    cairo_restore(to);
    cairo_surface_destroy(image);
}
// As wide as the pixels show it, whose letters stand on whole pixels: nothing then runs into its neighbour.
void drawText(cairo_t* to, const AaMark& m, const Faces& faces) {
    cairo_save(to);
    cairo_set_source_rgb(to, double(m.colour[0]), double(m.colour[1]), double(m.colour[2]));
    cairo_set_font_face(to, faces.faces[m.bold ? 1 : 0]);
    cairo_set_font_size(to, m.height);
    cairo_text_extents_t extents;
    cairo_text_extents(to, m.text, &extents);
    cairo_translate(to, m.x, m.y);
    if (extents.x_advance > 0 && m.width > 0) cairo_scale(to, m.width / extents.x_advance, 1);
    cairo_move_to(to, 0, 0);
    cairo_show_text(to, m.text);
    cairo_restore(to);
}
const char* drawPdf(cairo_surface_t* surface, const AaPdf& pdf, const Faces& faces) {
    cairo_t* to = cairo_create(surface);
    cairo_font_options_t* exact = cairo_font_options_create();
    cairo_font_options_set_hint_metrics(exact, CAIRO_HINT_METRICS_OFF);
    cairo_font_options_set_hint_style(exact, CAIRO_HINT_STYLE_NONE);
    cairo_set_font_options(to, exact);
    cairo_font_options_destroy(exact);
    for (size_t p = 0; p < pdf.count; p++) {
        const AaPage& page = pdf.pages[p];
        cairo_pdf_surface_set_size(surface, page.width * pdf.pointsPerPx, page.height * pdf.pointsPerPx);
        cairo_save(to);
        cairo_scale(to, pdf.pointsPerPx, pdf.pointsPerPx);
        for (size_t i = 0; i < page.count; i++) {
            const AaMark& m = page.marks[i];
            if (m.kind == AaMark::isFill)
                drawFill(to, m);
            else if (m.kind == AaMark::isPicture)
                drawPicture(to, m);
            else
                drawText(to, m, faces);
        }
        cairo_restore(to);
        cairo_show_page(to);
    }
    const cairo_status_t drawn = cairo_status(to);
    cairo_destroy(to);
    cairo_surface_finish(surface);
    const cairo_status_t written = drawn == CAIRO_STATUS_SUCCESS ? cairo_surface_status(surface) : drawn;
    return written == CAIRO_STATUS_SUCCESS ? nullptr : cairo_status_to_string(written);
}

// ---- WebP ----
bool fill(WebPPicture& picture, const AaLoop& loop, size_t frame) {
    if (!WebPPictureInit(&picture)) return false;
    picture.use_argb = 1;
    picture.width = loop.width, picture.height = loop.height;
    return WebPPictureImportRGB(&picture, loop.frames[frame], loop.width * 3) != 0;
}
const char* save(const char* file, const uint8_t* bytes, size_t count) {
    FILE* out = std::fopen(file, "wb");
    if (!out) return "no such folder, or no permission";
    const bool all = std::fwrite(bytes, 1, count, out) == count;
    return std::fclose(out) == 0 && all ? nullptr : "no space left";
}
constexpr const char* kOutOfMemory = "out of memory";

// ---- GIF ----
struct GifFile {
    GifFileType* file = nullptr;
    ColorMapObject* map = nullptr;
    bool finish() {
        const bool closed = file && EGifCloseFile(file, nullptr) == GIF_OK;
        file = nullptr;
        return closed;
    }
    ~GifFile() {
        if (file) EGifCloseFile(file, nullptr);
        if (map) GifFreeMapObject(map);
    }
};
bool loopForEver(GifFileType* gif) {
    const unsigned char times[] = {1, 0, 0};
    return EGifPutExtensionLeader(gif, APPLICATION_EXT_FUNC_CODE) == GIF_OK &&
           EGifPutExtensionBlock(gif, 11, "NETSCAPE2.0") == GIF_OK &&
           EGifPutExtensionBlock(gif, sizeof times, times) == GIF_OK && EGifPutExtensionTrailer(gif) == GIF_OK;
}
bool putFrame(GifFileType* gif, const AaLoop& loop, size_t frame) {
    const GraphicsControlBlock control{DISPOSE_DO_NOT, false, (loop.milliseconds + 5) / 10, NO_TRANSPARENT_COLOR};
    GifByteType block[4];
    const size_t bytes = EGifGCBToExtension(&control, block);
    if (EGifPutExtension(gif, GRAPHICS_EXT_FUNC_CODE, int(bytes), block) != GIF_OK ||
        EGifPutImageDesc(gif, 0, 0, loop.width, loop.height, false, nullptr) != GIF_OK)
        return false;
    std::vector<GifPixelType> row(size_t(loop.width));  // giflib masks what it is given
    for (int y = 0; y < loop.height; y++) {
        const unsigned char* from = loop.frames[frame] + size_t(y) * size_t(loop.width);
        row.assign(from, from + loop.width);
        if (EGifPutLine(gif, row.data(), loop.width) != GIF_OK) return false;
    }
    return true;
}
}  // namespace

AA_EXPORT const char* aaWritePdf1(const char* file, const AaPdf* pdf) {
    // Not freed: the faces must outlive all that cairo keeps of them, and the process ends soon.
    static Faces faces;
    const char* const fonts[2] = {pdf->regularFont, pdf->boldFont};
    if (!faces.faces[1] && !faces.open(fonts)) return "the font cannot be read";
    cairo_surface_t* surface = cairo_pdf_surface_create(file, 1, 1);
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_TITLE, pdf->title);
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATOR, "AA Resolve");
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, "");  // same input, same bytes
    const char* why = drawPdf(surface, *pdf, faces);
    cairo_surface_destroy(surface);
    return why;
}

AA_EXPORT const char* aaWriteWebp1(const char* file, const AaLoop* loop) {
    if (loop->width > WEBP_MAX_DIMENSION || loop->height > WEBP_MAX_DIMENSION)
        return "WebP holds pictures of up to 16383 px a side";
    WebPConfig config;
    constexpr int kEffort = 6;  // of 0 to 9; more takes several times as long for a few per cent
    if (!WebPConfigInit(&config) || !WebPConfigLosslessPreset(&config, kEffort)) return kOutOfMemory;
    config.exact = 1;
    if (loop->count == 1) {
        WebPPicture picture{};
        WebPMemoryWriter bytes;
        WebPMemoryWriterInit(&bytes);
        const char* why = kOutOfMemory;
        if (fill(picture, *loop, 0)) {
            picture.writer = WebPMemoryWrite, picture.custom_ptr = &bytes;
            if (WebPEncode(&config, &picture)) why = save(file, bytes.mem, bytes.size);
        }
        WebPPictureFree(&picture);
        WebPMemoryWriterClear(&bytes);
        return why;
    }
    WebPAnimEncoderOptions options;
    if (!WebPAnimEncoderOptionsInit(&options)) return kOutOfMemory;
    options.anim_params.loop_count = 0;
    const std::unique_ptr<WebPAnimEncoder, decltype(&WebPAnimEncoderDelete)> encoder(
        WebPAnimEncoderNew(loop->width, loop->height, &options), WebPAnimEncoderDelete);
    if (!encoder) return kOutOfMemory;
    for (size_t i = 0; i < loop->count; i++) {
        WebPPicture picture{};
        const bool added = fill(picture, *loop, i) &&
                           WebPAnimEncoderAdd(encoder.get(), &picture, int(i) * loop->milliseconds, &config);
        WebPPictureFree(&picture);
        if (!added) return kOutOfMemory;
    }
    WebPData all;
    WebPDataInit(&all);
    const char* why = kOutOfMemory;
    if (WebPAnimEncoderAdd(encoder.get(), nullptr, int(loop->count) * loop->milliseconds, nullptr) &&
        WebPAnimEncoderAssemble(encoder.get(), &all))
        why = save(file, all.bytes, all.size);
    WebPDataClear(&all);
    return why;
}

AA_EXPORT const char* aaWriteGif1(const char* file, const AaLoop* loop, const unsigned char* palette, int colours) {
    constexpr int kLargest = 65535, kColours = 256, kBits = 8;
    if (loop->width > kLargest || loop->height > kLargest) return "GIF holds pictures of up to 65535 px a side";
    GifColorType map[kColours] = {};
    for (int i = 0; i < colours && i < kColours; i++) map[i] = {palette[3 * i], palette[3 * i + 1], palette[3 * i + 2]};
    int error = 0;
    std::vector<uint8_t> bytes;
    GifFile gif;
    gif.map = GifMakeMapObject(kColours, map);
    gif.file = EGifOpen(
        &bytes,
        [](GifFileType* to, const GifByteType* from, int count) {
            auto& all = *static_cast<std::vector<uint8_t>*>(to->UserData);
            all.insert(all.end(), from, from + count);
            return count;
        },
        &error);
    if (!gif.map || !gif.file) return gif.map ? GifErrorString(error) : kOutOfMemory;
    EGifSetGifVersion(gif.file, true);
    bool good = EGifPutScreenDesc(gif.file, loop->width, loop->height, kBits, 0, gif.map) == GIF_OK;
    if (good && loop->count > 1) good = loopForEver(gif.file);
    for (size_t i = 0; good && i < loop->count; i++) good = putFrame(gif.file, *loop, i);
    return good && gif.finish() ? save(file, bytes.data(), bytes.size()) : "the picture cannot be encoded";
}

static_assert(std::is_same_v<decltype(&aaWritePdf1), AaWritePdf> &&
              std::is_same_v<decltype(&aaWriteWebp1), AaWriteWebp> &&
              std::is_same_v<decltype(&aaWriteGif1), AaWriteGif>);
