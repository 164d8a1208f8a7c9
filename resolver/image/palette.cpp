#include "image/palette.h"

#include <algorithm>
#include <cstdint>
#include <unordered_map>

namespace aa {
namespace {
constexpr size_t kColours = 256;

struct Counted {
    std::array<unsigned char, 3> colour;
    double count;
};
struct Box {
    size_t first, last;  // of the colours, [first, last)
    std::array<double, 3> mean;
    size_t channel;  // the most spread one
    double spread;   // sum of squared distances from the mean, in that channel
};

Box boxOf(const std::vector<Counted>& colours, size_t first, size_t last) {
    Box box{first, last, {}, 0, 0};
    double all = 0;
    std::array<double, 3> squares{};
    for (size_t i = first; i < last; i++) {
        all += colours[i].count;
        for (size_t c = 0; c < 3; c++) box.mean[c] += colours[i].count * colours[i].colour[c];
    }
    for (size_t c = 0; c < 3; c++) box.mean[c] /= all;
    for (size_t i = first; i < last; i++)
        for (size_t c = 0; c < 3; c++) {
            const double d = colours[i].colour[c] - box.mean[c];
            squares[c] += colours[i].count * d * d;
        }
    box.channel = size_t(std::max_element(squares.begin(), squares.end()) - squares.begin());
    box.spread = last - first > 1 ? squares[box.channel] : 0;
    return box;
}
uint32_t key(const unsigned char* code) { return uint32_t(code[0]) << 16 | uint32_t(code[1]) << 8 | code[2]; }
}  // namespace

Paletted paletted(std::span<const std::vector<unsigned char>> pictures) {
    std::unordered_map<uint32_t, double> counts;
    for (const auto& codes : pictures)
        for (size_t i = 0; i + 2 < codes.size(); i += 3) counts[key(&codes[i])]++;
    std::vector<Counted> colours;
    for (const auto& [k, count] : counts)
        colours.push_back(
            {{static_cast<unsigned char>(k >> 16), static_cast<unsigned char>(k >> 8), static_cast<unsigned char>(k)},
             count});
    // The map's own order is not the same everywhere.
    std::sort(colours.begin(), colours.end(), [](const Counted& a, const Counted& b) { return a.colour < b.colour; });
    std::vector<Box> boxes;
    if (!colours.empty()) boxes.push_back(boxOf(colours, 0, colours.size()));
    while (!boxes.empty() && boxes.size() < kColours) {
        const auto widest = std::max_element(boxes.begin(), boxes.end(),
                                             [](const Box& a, const Box& b) { return a.spread < b.spread; });
        if (widest->spread == 0) break;
        const Box box = *widest;
        const auto middle =
            std::stable_partition(colours.begin() + ptrdiff_t(box.first), colours.begin() + ptrdiff_t(box.last),
                                  [&](const Counted& c) { return c.colour[box.channel] <= box.mean[box.channel]; });
        const auto cut = size_t(middle - colours.begin());
        *widest = boxOf(colours, box.first, cut);
        boxes.push_back(boxOf(colours, cut, box.last));
    }
    Paletted out;
    std::unordered_map<uint32_t, unsigned char> indexOf;
    for (size_t b = 0; b < boxes.size(); b++) {
        for (const double mean : boxes[b].mean) out.palette.push_back(static_cast<unsigned char>(mean + 0.5));
        for (size_t i = boxes[b].first; i < boxes[b].last; i++)
            indexOf[key(colours[i].colour.data())] = static_cast<unsigned char>(b);
    }
    for (const auto& codes : pictures) {
        auto& frame = out.frames.emplace_back();
        frame.reserve(codes.size() / 3);
        for (size_t i = 0; i + 2 < codes.size(); i += 3) frame.push_back(indexOf.at(key(&codes[i])));
    }
    return out;
}

}  // namespace aa
