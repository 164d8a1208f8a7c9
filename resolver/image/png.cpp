#include "image/png.h"

#include <png.h>

#include <bit>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <string>

#include "image/colour.h"
#include "image/error.h"
#include "image/io.h"

namespace aa {
namespace fs = std::filesystem;

namespace {
// libpng reports an error by a call that must not return, so it jumps. Each function that calls setjmp therefore has
// nothing to destroy and no variable that it changes.
void jump(png_structp png, png_const_charp why) {
    *static_cast<std::string*>(png_get_error_ptr(png)) = why;
    png_longjmp(png, 1);
}
void ignore(png_structp, png_const_charp) {}

// Tag 0x0112 of the first directory of EXIF's TIFF structure; 1 where it is not there or makes no sense.
int orientationOf(std::span<const unsigned char> exif) {
    const bool little = exif.size() > 8 && exif[0] == 'I', big = exif.size() > 8 && exif[0] == 'M';
    if (!little && !big) return 1;
    const auto number = [&](size_t at, size_t bytes) {
        uint32_t n = 0;
        for (size_t i = 0; i < bytes && at + bytes <= exif.size(); i++)
            n = n << 8 | exif[at + (little ? bytes - 1 - i : i)];
        return n;
    };
    const size_t directory = number(4, 4), entries = number(directory, 2);
    for (size_t i = 0; i < entries && directory + 2 + 12 * (i + 1) <= exif.size(); i++)
        if (const size_t entry = directory + 2 + 12 * i; number(entry, 2) == 0x0112) return int(number(entry + 8, 2));
    return 1;
}

class Reader {
  public:
    explicit Reader(const fs::path& file) : file_(std::fopen(file.c_str(), "rb"), std::fclose) {
        if (!file_) throw InputError(file.string() + ": cannot be opened; check its permissions");
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &why_, jump, ignore);
        info_ = png_ ? png_create_info_struct(png_) : nullptr;
        if (!info_) throw std::bad_alloc();
    }
    ~Reader() { png_destroy_read_struct(&png_, &info_, nullptr); }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    // Codes of 8 or 16 bits in the machine's order, palette as colours, transparent colours as alpha.
    // Whether what stands before the pixels is as long as it says: libpng makes room for it before it reads.
    bool chunksFit() {
        constexpr long kSignature = 8, kAround = 12;  // length, name; sum
        std::FILE* const file = file_.get();
        std::fseek(file, 0, SEEK_END);
        const long size = std::ftell(file);
        bool fit = true;
        for (long at = kSignature; fit && at + kAround <= size;) {
            unsigned char head[8];
            fit = std::fseek(file, at, SEEK_SET) == 0 && std::fread(head, sizeof head, 1, file) == 1;
            if (!fit || std::memcmp(head + 4, "IDAT", 4) == 0) break;
            const long length = long(png_get_uint_32(head));
            fit = length <= size - at - kAround;
            at += length + kAround;
        }
        std::rewind(file);
        return fit;  // where there are no pixels, libpng says so
    }
    bool readHeader() {
        if (setjmp(png_jmpbuf(png_))) return false;
        png_init_io(png_, file_.get());
        png_read_info(png_, info_);
        png_set_expand(png_);
        if constexpr (std::endian::native == std::endian::little) png_set_swap(png_);
        png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
        return true;
    }
    int64_t width() const { return png_get_image_width(png_, info_); }
    int64_t height() const { return png_get_image_height(png_, info_); }
    int channels() const { return png_get_channels(png_, info_); }
    int bits() const { return png_get_bit_depth(png_, info_); }
    size_t rowBytes() const { return png_get_rowbytes(png_, info_); }
    // Of the EXIF data, which may stand behind the pixels: ask when they are read.
    int orientation() {
        png_uint_32 size = 0;
        png_bytep bytes = nullptr;
        return png_get_eXIf_1(png_, info_, &size, &bytes) ? orientationOf({bytes, size}) : 1;
    }
    bool readPixels(png_bytepp rows) {
        if (setjmp(png_jmpbuf(png_))) return false;
        png_read_image(png_, rows);
        png_read_end(png_, info_);
        return true;
    }
    const std::string& why() const { return why_; }

  private:
    std::string why_;
    std::unique_ptr<FILE, int (*)(FILE*)> file_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
};

// One row of interleaved codes into row y of the planes.
template <class T>
void unpackRow(const T* codes, int channels, int y, StoredPicture& to) {
    constexpr float kScale = 1.0f / float(std::numeric_limits<T>::max());
    for (int x = 0; x < to.rgb.width(); x++, codes += channels) {
        for (int c = 0; c < 3; c++) to.rgb.c[size_t(c)].at(x, y) = float(codes[channels < 3 ? 0 : c]) * kScale;
        if (!to.alpha.empty()) to.alpha.at(x, y) = float(codes[channels - 1]) * kScale;
    }
}

class Writer {
  public:
    Writer() {
        png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, &why_, jump, ignore);
        info_ = png_ ? png_create_info_struct(png_) : nullptr;
        if (!info_) throw std::bad_alloc();
    }
    ~Writer() { png_destroy_write_struct(&png_, &info_); }
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;

    bool write(png_const_bytep codes, png_uint_32 width, png_uint_32 height, PngOptions options) {
        if (setjmp(png_jmpbuf(png_))) return false;
        png_set_write_fn(png_, &bytes_, append, [](png_structp) {});
        constexpr int kQuickLevel = 2;
        png_set_compression_level(png_, options.quick ? kQuickLevel : options.compressionLevel);
        if (options.quick) png_set_filter(png_, PNG_FILTER_TYPE_BASE, PNG_FILTER_UP);
        png_set_IHDR(png_, info_, width, height, 8, options.alpha ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB,
                     PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
        if (options.srgb) png_set_sRGB_gAMA_and_cHRM(png_, info_, PNG_sRGB_INTENT_ABSOLUTE);
        png_write_info(png_, info_);
        for (png_uint_32 y = 0; y < height; y++)
            png_write_row(png_, codes + size_t(y) * width * (options.alpha ? 4 : 3));
        png_write_end(png_, info_);
        return true;
    }
    const std::string& why() const { return why_; }
    std::vector<unsigned char> take() { return std::move(bytes_); }

  private:
    static void append(png_structp png, png_bytep data, size_t count) {
        auto& bytes = *static_cast<std::vector<unsigned char>*>(png_get_io_ptr(png));
        try {
            bytes.insert(bytes.end(), data, data + count);
        } catch (const std::bad_alloc&) {
            png_error(png, "out of memory");
        }
    }
    std::string why_;
    std::vector<unsigned char> bytes_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
};
}  // namespace

bool isPng(const fs::path& file) {
    unsigned char bytes[8] = {};
    std::ifstream(file, std::ios::binary).read(reinterpret_cast<char*>(bytes), sizeof bytes);
    return png_sig_cmp(bytes, 0, sizeof bytes) == 0;
}

StoredPicture readPng(const fs::path& file) {
    Reader in(file);
    const auto damaged = [&](const char* what) {
        return InputError(file.string() + ": " + what + " (" + in.why() + "); write the file again");
    };
    if (!in.chunksFit())
        throw InputError(file.string() +
                         ": damaged PNG header (a chunk is longer than the file); write the file again");
    if (!in.readHeader()) throw damaged("damaged PNG header");
    if (in.width() > kLargestSide || in.height() > kLargestSide)
        throw InputError(file.string() + ": " + std::to_string(in.width()) + " x " + std::to_string(in.height()) +
                         " pixels; expected 1..16384 a side");
    const int width = int(in.width()), height = int(in.height());
    constexpr size_t kDeflate = 1032,
                     kSlack = 1 << 20;  // bytes out per byte in, at most; small pictures go as they are
    std::error_code ignored;
    const size_t stored = size_t(fs::file_size(file, ignored)), unpacked = in.rowBytes() * size_t(height);
    if (unpacked > kSlack && unpacked / kDeflate > stored)
        throw InputError(file.string() + ": " + std::to_string(width) + " x " + std::to_string(height) +
                         " pixels cannot be in a file of " + std::to_string(stored) + " bytes; write the file again");
    std::vector<unsigned char> codes(unpacked);
    std::vector<png_bytep> rows;
    for (int y = 0; y < height; y++) rows.push_back(codes.data() + in.rowBytes() * size_t(y));
    if (!in.readPixels(rows.data())) throw damaged("truncated or damaged");
    StoredPicture picture{Rgb(width, height)};
    if (in.channels() % 2 == 0) picture.alpha = PlaneF(width, height);
    for (int y = 0; y < height; y++)
        if (in.bits() == 16)
            unpackRow(reinterpret_cast<const uint16_t*>(rows[size_t(y)]), in.channels(), y, picture);
        else
            unpackRow(rows[size_t(y)], in.channels(), y, picture);
    picture.orientation = in.orientation();
    return picture;
}

std::vector<unsigned char> codesOf(const Rgb& encoded, const PlaneF* alpha) {
    const int w = encoded.width(), h = encoded.height();
    std::vector<const PlaneF*> planes = {&encoded.c[0], &encoded.c[1], &encoded.c[2]};
    if (alpha) planes.push_back(alpha);
    const size_t count = planes.size();
    std::vector<unsigned char> codes(size_t(w) * size_t(h) * count);
    forRows({}, h, [&](int y0, int y1) {
        for (size_t c = 0; c < count; c++)
            for (int y = y0; y < y1; y++) {
                const float* const row = planes[c]->row(y);
                unsigned char* const to = codes.data() + size_t(y) * size_t(w) * count + c;
                for (int x = 0; x < w; x++) to[size_t(x) * count] = uint8_t(code8(row[x]));
            }
    });
    return codes;
}

std::vector<unsigned char> pngBytes(std::span<const unsigned char> codes, int width, int height, PngOptions options) {
    assert(codes.size() == size_t(width) * size_t(height) * (options.alpha ? 4 : 3));
    Writer out;
    if (!out.write(codes.data(), png_uint_32(width), png_uint_32(height), options))
        throw InputError("a picture of " + std::to_string(width) + " x " + std::to_string(height) +
                         " pixels cannot be encoded as PNG (" + out.why() + ")");
    return out.take();
}

}  // namespace aa
