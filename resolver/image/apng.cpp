#include "image/apng.h"

#include <zlib.h>

#include <cassert>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "image/png.h"

namespace aa {
namespace {
using Bytes = std::vector<unsigned char>;

void put(Bytes& to, uint32_t number, int bytes) {
    for (int i = bytes - 1; i >= 0; i--) to.push_back(static_cast<unsigned char>(number >> (8 * i)));
}
uint32_t numberAt(const Bytes& from, size_t at) {
    return uint32_t(from[at]) << 24 | uint32_t(from[at + 1]) << 16 | uint32_t(from[at + 2]) << 8 | from[at + 3];
}
void putChunk(Bytes& to, std::string_view name, std::span<const unsigned char> data) {
    put(to, uint32_t(data.size()), 4);
    const size_t checked = to.size();
    to.insert(to.end(), name.begin(), name.end());
    to.insert(to.end(), data.begin(), data.end());
    put(to, uint32_t(crc32(0, to.data() + checked, uInt(to.size() - checked))), 4);
}
// Calls each(name, data, whole) for every chunk of a PNG.
template <class Each>
void forChunks(const Bytes& png, Each each) {
    constexpr size_t kSignature = 8, kAround = 12;  // length and name before the data, its sum behind
    for (size_t at = kSignature; at < png.size();) {
        const size_t length = numberAt(png, at);
        const std::span<const unsigned char> whole(png.data() + at, length + kAround);
        each(std::string_view(reinterpret_cast<const char*>(whole.data()) + 4, 4), whole.subspan(8, length), whole);
        at += whole.size();
    }
}
Bytes frameControl(uint32_t number, int width, int height, int milliseconds) {
    Bytes control;
    put(control, number, 4);
    put(control, uint32_t(width), 4), put(control, uint32_t(height), 4);
    put(control, 0, 4), put(control, 0, 4);  // its place
    put(control, uint32_t(milliseconds), 2), put(control, 1000, 2);
    put(control, 0, 1), put(control, 0, 1);  // it stays, and replaces what is there
    return control;
}
}  // namespace

Bytes apngBytes(std::span<const Bytes> frames, int width, int height, int milliseconds) {
    assert(!frames.empty() && milliseconds > 0 && milliseconds < 65536);
    Bytes all;
    uint32_t number = 0;  // counts the control chunks and the frames' parts together
    for (size_t i = 0; i < frames.size(); i++) {
        const Bytes png = pngBytes(frames[i], width, height, {.srgb = false});
        if (i == 0) all.assign(png.begin(), png.begin() + 8);
        bool controlled = false;
        forChunks(png, [&](std::string_view name, auto data, auto whole) {
            if (name == "IDAT") {
                if (!controlled) putChunk(all, "fcTL", frameControl(number++, width, height, milliseconds));
                controlled = true;
                Bytes part;
                if (i > 0) put(part, number++, 4);
                part.insert(part.end(), data.begin(), data.end());
                putChunk(all, i == 0 ? "IDAT" : "fdAT", part);
            } else if (i == 0 && name != "IEND") {
                all.insert(all.end(), whole.begin(), whole.end());
                if (name != "IHDR") return;
                Bytes control;
                put(control, uint32_t(frames.size()), 4), put(control, 0, 4);  // 0: for ever
                putChunk(all, "acTL", control);
            }
        });
    }
    putChunk(all, "IEND", {});
    return all;
}

}  // namespace aa
