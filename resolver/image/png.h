// PNG through libpng.
#pragma once
#include <filesystem>
#include <span>
#include <vector>

#include "image/stored_picture.h"

namespace aa {

bool isPng(const std::filesystem::path& file);  // by its first bytes

// Encoded values code / max of 1 to 16 bits, with or without palette; grey is repeated. Alpha stands beside the
// colours, which it never changes. Throws InputError: truncated, damaged, larger than kLargestSide.
StoredPicture readPng(const std::filesystem::path& file);

struct PngOptions {
    bool srgb = true;          // say that the codes are sRGB
    int compressionLevel = 6;  // 0 to 9, zlib's
    bool alpha = false;        // four codes per pixel
    bool quick = false;  // for pictures, of which a run writes hundreds (decisions 58); compressionLevel is ignored
};
// 8-bit codes floor(255 v + 0.5) of encoded values in [0,1], R G B R G B ..., or R G B A.
std::vector<unsigned char> codesOf(const Rgb& encoded, const PlaneF* alpha = nullptr);
// The file of width x height such codes.
std::vector<unsigned char> pngBytes(std::span<const unsigned char> codes, int width, int height, PngOptions options);

}  // namespace aa
