// Lossless packing of pictures for the report's page (web/viewer/codec.js unpacks). Methods' pictures differ from one
// another and from frame to frame in few places, mostly edges, so a picture is coded as its difference from one that
// the page has already: with 42 methods it takes about half of what PNG does.
//
//   1. words: 8-bit codes, or floats as integers of the same order
//   2. minus the same pixel of another picture, if any; red and blue minus green
//   3. minus a guess from the neighbours west, north and north-west (MED of [Weinberger 2000]), if that is smaller
//   4. an adaptive binary arithmetic coder; a word is its number of bits (in unary, by context), its sign, and the bits
//      after the first, of which the highest is modelled, too
//
// The context of a word is how large the words around it were, in the same channel and in the one before. All is
// integer arithmetic modulo 2^8 or 2^32, so that the page gets the same bits on every machine.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "image/plane.h"

namespace aa {

// Three channels of width x height words, channel by channel: green, red, blue.
struct Words {
    int width = 0, height = 0;
    int bits = 8;  // of a word: 8 or 32
    std::vector<uint32_t> values;
    size_t perChannel() const { return size_t(width) * size_t(height); }
};
// codesOf() of encoded values.
Words codeWords(const Rgb& encoded);
// The bits of floats as integers that ascend as the floats do, so that close values have close words.
Words floatWords(const Rgb& linear);

// Step 3 of the above: a difference from another picture is mostly 0 beside an edge, too, where a guess misleads.
enum class Guess : unsigned char { zero, med };

std::vector<unsigned char> packed(const Words& picture, const Words* other, Guess guess);
// Bytes that packed() will need, roughly: enough to choose between others.
double packedSize(const Words& picture, const Words* other, Guess guess);
// The inverse, for tests; the page has its own.
Words unpacked(std::span<const unsigned char> bytes, int width, int height, int bits, const Words* other, Guess guess);

}  // namespace aa
