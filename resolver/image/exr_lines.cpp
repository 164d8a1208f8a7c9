#include "image/exr_lines.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfPartType.h>
#include <half.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cstring>
#include <mutex>
#include <vector>

#include "image/exr_zip.h"
#include "kernels/dispatch.h"

namespace aa {
namespace {
size_t bytesOf(Imf::PixelType type) { return type == Imf::HALF ? 2 : 4; }

// A channel within a line of the file, and where it goes.
struct LineChannel {
    size_t offset;
    Imf::PixelType stored;
    const Imf::Slice* slice;
};

class ZipLines {
  public:
    ZipLines(Imf::InputPart& part, const Imf::FrameBuffer& slices)
        : part_(part),
          window_(part.header().dataWindow()),
          lines_(part.header().compression() == Imf::ZIPS_COMPRESSION ? 1 : kZipLines) {
        width_ = size_t(window_.max.x - window_.min.x + 1);
        const Imf::ChannelList& channels = part.header().channels();
        for (auto c = channels.begin(); c != channels.end(); ++c) {
            const Imf::PixelType stored = c.channel().type;
            if (const Imf::Slice* slice = slices.findSlice(c.name())) {
                assert(slice->xStride == 4 && (slice->type == stored || stored == Imf::HALF));
                channels_.push_back({lineBytes_, stored, slice});
            }
            lineBytes_ += width_ * bytesOf(stored);
        }
    }

    bool read() {
        const int chunks = (window_.max.y - window_.min.y) / lines_ + 1;
        std::atomic<bool> whole = true;
        parallelRows(chunks, lines_ == 1 ? kZipLines : 1, [&](int c0, int c1) {
            Reading& mine = reading_.local();
            for (int c = c0; c < c1 && whole; c++)
                if (!readChunk(window_.min.y + c * lines_, mine)) whole = false;
        });
        return whole;
    }

  private:
    struct Reading {
        ZipUnpacker unpacker;
        std::vector<uint8_t> packed;
        std::vector<half> halves;
    };

    bool readChunk(int y, Reading& mine) {
        const int end = std::min(y + lines_, window_.max.y + 1);
        if (!fetch(y, mine.packed) || !mine.unpacker.unpack(mine.packed, size_t(end - y) * lineBytes_)) return false;
        for (int line = y; line < end; line++)
            for (const LineChannel& c : channels_) unpackLine(c, size_t(line - y) * lineBytes_ + c.offset, line, mine);
        return true;
    }
    // The part has one place for it, and one in the file.
    bool fetch(int y, std::vector<uint8_t>& packed) {
        const std::lock_guard one(fetching_);
        try {
            const char* bytes = nullptr;
            int count = 0;
            part_.rawPixelData(y, bytes, count);
            packed.assign(bytes, bytes + count);
            return true;
        } catch (const std::exception&) {
            return false;
        }
    }
    void unpackLine(const LineChannel& c, size_t from, int y, Reading& mine) const {
        char* const to = c.slice->base + ptrdiff_t(y) * ptrdiff_t(c.slice->yStride) + ptrdiff_t(window_.min.x) * 4;
        if (c.stored != Imf::HALF) {
            mine.unpacker.copy(from, 4 * width_, to);
            return;
        }
        mine.halves.resize(width_);
        mine.unpacker.copy(from, 2 * width_, mine.halves.data());
        std::copy(mine.halves.begin(), mine.halves.end(), reinterpret_cast<float*>(to));
    }

    Imf::InputPart& part_;
    Imath::Box2i window_;
    int lines_;
    size_t width_ = 0, lineBytes_ = 0;
    std::vector<LineChannel> channels_;
    std::mutex fetching_;
    tbb::enumerable_thread_specific<Reading> reading_;
};
}  // namespace

bool hasZipLines(const Imf::Header& header) {
    if (header.compression() != Imf::ZIP_COMPRESSION && header.compression() != Imf::ZIPS_COMPRESSION) return false;
    if (header.hasType() ? header.type() != Imf::SCANLINEIMAGE : header.hasTileDescription()) return false;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
        const Imf::Channel& channel = c.channel();
        const bool known = channel.type == Imf::HALF || channel.type == Imf::FLOAT || channel.type == Imf::UINT;
        if (!known || channel.xSampling != 1 || channel.ySampling != 1) return false;
    }
    return true;
}

bool readZipLines(Imf::InputPart& part, const Imf::FrameBuffer& slices) { return ZipLines(part, slices).read(); }

}  // namespace aa
