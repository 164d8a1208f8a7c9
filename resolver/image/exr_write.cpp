// Writes EXR files, headers by OpenEXR and pixels by image/exr_zip.h: its own writer packs with zlib alone, which took
// most of a run's time.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfVersion.h>
#include <tbb/enumerable_thread_specific.h>

#include <cassert>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "image/exr.h"
#include "image/exr_zip.h"
#include "image/io.h"
#include "kernels/dispatch.h"

namespace aa {
namespace fs = std::filesystem;

namespace {
// The same image must give the same file, so the date of every file is this one.
constexpr const char* kNoDate = "2000:01:01 00:00:00";
constexpr size_t kShortName = 31;  // longer names, which older readers refuse, set a flag

// A file that remembers its first failure.
class OutputStream : public Imf::OStream {
  public:
    explicit OutputStream(const fs::path& file) : Imf::OStream(file.c_str()), out_(file, std::ios::binary) { check(); }
    void write(const char bytes[], int count) override { put(bytes, size_t(count)); }
    void put(const void* bytes, size_t count) {
        out_.write(static_cast<const char*>(bytes), std::streamsize(count));
        check();
    }
    void putNumber(int32_t value) { put(&value, sizeof value); }
    uint64_t tellp() override { return uint64_t(std::streamoff(out_.tellp())); }
    void seekp(uint64_t position) override {
        out_.seekp(std::streamoff(position));
        check();
    }
    void close() {
        out_.close();
        check();
    }

  private:
    void check() {
        if (out_) return;
        if (why_.empty()) why_ = std::generic_category().message(errno);
        throw std::runtime_error(why_);
    }
    std::ofstream out_;
    std::string why_;
};

std::pair<int, int> sizeOf(const ChannelSource& source) {
    return std::visit([](auto* plane) { return std::pair(plane->width(), plane->height()); }, source.plane);
}
// The pixels' place where the display window begins at 0, 0.
Imath::Box2i windowOf(const PartSource& part) {
    const auto [w, h] = sizeOf(part.channels.at(0));
    const int x = part.shown ? -part.shown->x : 0, y = part.shown ? -part.shown->y : 0;
    return {{x, y}, {x + w - 1, y + h - 1}};
}
Imath::Box2i displayWindowOf(const PartSource& part) {
    if (!part.shown) return windowOf(part);
    return {{0, 0}, {part.shown->width - 1, part.shown->height - 1}};
}
int chunksOf(const PartSource& part) { return (sizeOf(part.channels[0]).second + kZipLines - 1) / kZipLines; }

Imf::Header headerOf(const PartSource& part, const Imath::Box2i& displayWindow, bool ofSeveral) {
    Imf::Header header(displayWindow, windowOf(part));
    header.compression() = Imf::ZIP_COMPRESSION;
    header.insert("capDate", Imf::StringAttribute(kNoDate));
    for (const auto& [key, value] : part.integers) header.insert(key, Imf::IntAttribute(value));
    if (!part.name.empty()) header.setName(part.name);
    for (const auto& c : part.channels)
        header.channels().insert(c.channel,
                                 Imf::Channel(std::holds_alternative<const PlaneU*>(c.plane) ? Imf::UINT : Imf::FLOAT));
    if (ofSeveral) {
        header.setType(Imf::SCANLINEIMAGE);
        header.setChunkCount(chunksOf(part));
    }
    header.sanityCheck(false, ofSeveral);
    return header;
}
bool hasLongNames(const Imf::Header& header) {
    for (auto a = header.begin(); a != header.end(); ++a)
        if (std::strlen(a.name()) > kShortName) return true;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
        if (std::strlen(c.name()) > kShortName) return true;
    return false;
}

// The rows of a part in the order in which the file has them: by line, within it by the channels' names.
class PartRows {
  public:
    explicit PartRows(const PartSource& part) {
        std::map<std::string, const ChannelSource*> byName;
        for (const auto& c : part.channels) {
            assert(sizeOf(c) == sizeOf(part.channels[0]));
            byName[c.channel] = &c;
        }
        for (const auto& [name, channel] : byName) channels_.push_back(channel);
        const auto [width, height] = sizeOf(part.channels[0]);
        rowBytes_ = size_t(width) * sizeof(float);
        height_ = height;
    }
    size_t chunkBytes() const { return size_t(kZipLines) * channels_.size() * rowBytes_; }
    void copyChunk(int chunk, std::vector<uint8_t>& to) const {
        const int first = chunk * kZipLines, last = std::min(first + kZipLines, height_);
        to.resize(size_t(last - first) * channels_.size() * rowBytes_);
        uint8_t* at = to.data();
        for (int y = first; y < last; y++)
            for (const ChannelSource* c : channels_) {
                std::visit([&](auto* plane) { std::memcpy(at, plane->row(y), rowBytes_); }, c->plane);
                at += rowBytes_;
            }
    }

  private:
    std::vector<const ChannelSource*> channels_;
    size_t rowBytes_ = 0;
    int height_ = 0;
};

// Packs the chunks of parts on all threads and writes them in order.
class ChunkWriter {
  public:
    ChunkWriter(OutputStream& out, bool ofSeveral) : out_(out), ofSeveral_(ofSeveral) {}
    // Returns where in the file each chunk begins.
    std::vector<uint64_t> write(const PartSource& part, int index) {
        constexpr size_t kBytesAtOnce = 32u << 20;
        const PartRows rows(part);
        const int count = chunksOf(part), firstLine = windowOf(part).min.y;
        const int atOnce = int(std::max<size_t>(1, kBytesAtOnce / rows.chunkBytes()));
        std::vector<std::vector<uint8_t>> packed(size_t(std::min(count, atOnce)));
        std::vector<uint64_t> offsets;
        for (int first = 0; first < count; first += atOnce) {
            const int now = std::min(atOnce, count - first);
            parallelRows(now, 1, [&](int c0, int c1) {
                Packing& mine = packing_.local();
                for (int c = c0; c < c1; c++) {
                    rows.copyChunk(first + c, mine.chunk);
                    const auto bytes = mine.packer.pack(mine.chunk);
                    packed[size_t(c)].assign(bytes.begin(), bytes.end());
                }
            });
            for (int c = 0; c < now; c++) {
                offsets.push_back(out_.tellp());
                if (ofSeveral_) out_.putNumber(index);
                out_.putNumber(firstLine + (first + c) * kZipLines);
                out_.putNumber(int32_t(packed[size_t(c)].size()));
                out_.put(packed[size_t(c)].data(), packed[size_t(c)].size());
            }
        }
        return offsets;
    }

  private:
    struct Packing {
        ZipPacker packer;
        std::vector<uint8_t> chunk;
    };
    OutputStream& out_;
    bool ofSeveral_;
    tbb::enumerable_thread_specific<Packing> packing_;
};

void writeFile(OutputStream& out, const std::vector<PartSource>& parts) {
    const bool several = parts.size() > 1;
    // All parts show one picture: a list of another size keeps its display window.
    const Imath::Box2i displayWindow = displayWindowOf(parts.at(0));
    std::vector<Imf::Header> headers;
    int version = Imf::EXR_VERSION | (several ? Imf::MULTI_PART_FILE_FLAG : 0);
    for (const auto& part : parts) {
        headers.push_back(headerOf(part, displayWindow, several));
        if (hasLongNames(headers.back())) version |= Imf::LONG_NAMES_FLAG;
    }
    out.putNumber(Imf::MAGIC);
    out.putNumber(version);
    for (const auto& header : headers) header.writeTo(out);
    if (several) out.put("", 1);
    const uint64_t table = out.tellp();
    size_t chunks = 0;
    for (const auto& part : parts) chunks += size_t(chunksOf(part));
    std::vector<uint64_t> offsets(chunks);
    out.put(offsets.data(), offsets.size() * sizeof(uint64_t));  // filled in below
    offsets.clear();
    ChunkWriter writer(out, several);
    for (size_t i = 0; i < parts.size(); i++) {
        const auto ofPart = writer.write(parts[i], int(i));
        offsets.insert(offsets.end(), ofPart.begin(), ofPart.end());
    }
    out.seekp(table);
    out.put(offsets.data(), offsets.size() * sizeof(uint64_t));
}
}  // namespace

void writeParts(const fs::path& file, const std::vector<PartSource>& parts) {
    try {
        OutputStream stream(temporaryName(file));
        writeFile(stream, parts);
        stream.close();
    } catch (const std::exception& e) {
        giveUpWriting(file, e.what());
    }
    renameInto(temporaryName(file), file);
}

}  // namespace aa
