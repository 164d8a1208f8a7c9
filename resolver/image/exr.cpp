#include "image/exr.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cassert>
#include <cstring>
#include <fstream>
#include <limits>

#include "image/channel_order.h"
#include "image/error.h"
#include "image/exr_header.h"
#include "image/exr_lines.h"
#include "image/inputs.h"
#include "image/io.h"
#include "image/readable.h"

namespace aa {
namespace fs = std::filesystem;

namespace {
// A damaged size must not ask for the machine's memory: bytes of planes per byte of the file, at most, half values
// doubled. ZIP packs a thousandfold; what unpacks furthest is DWA: an 8 x 8 block of one colour is two bytes, which are
// zipped.
constexpr uint64_t kAlwaysBytes = 16u << 20;
uint64_t mostBytesPerByte(std::string_view compression) {
    constexpr uint64_t kDeflate = 1032;
    if (compression == "none") return 2;
    if (compression == "rle") return 2 * 128;
    if (compression == "b44" || compression == "b44a") return 2 * 16;
    if (compression == "zip" || compression == "zips" || compression == "pxr24") return 2 * kDeflate;
    return 256 * kDeflate;
}

// OpenEXR's words without the file's name, which our messages begin with: 'Cannot read image file "a.exr". Early end.'
std::string whyOf(const std::exception& e) {
    const std::string text = e.what(), line = text.substr(0, text.find('\n'));
    const size_t name = line.find("\". ");
    return name == std::string::npos ? line : line.substr(name + 3);
}

// At the first file, not at the program's start. With one thread allowed OpenEXR works in the caller's.
void startThreads() {
    static const int threads = [] {
        const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
        const int count = allowed > 1 ? int(allowed) : 0;
        Imf::setGlobalThreadCount(count);
        return count;
    }();
    (void)threads;
}

ChannelType typeOf(Imf::PixelType type) {
    return type == Imf::HALF    ? ChannelType::half
           : type == Imf::FLOAT ? ChannelType::real
           : type == Imf::UINT  ? ChannelType::uint
                                : ChannelType::other;
}
std::string nameOf(Imf::Compression compression) {
    switch (compression) {
        case Imf::NO_COMPRESSION:
            return "none";
        case Imf::RLE_COMPRESSION:
            return "rle";
        case Imf::ZIPS_COMPRESSION:
            return "zips";
        case Imf::ZIP_COMPRESSION:
            return "zip";
        case Imf::PIZ_COMPRESSION:
            return "piz";
        case Imf::PXR24_COMPRESSION:
            return "pxr24";
        case Imf::B44_COMPRESSION:
            return "b44";
        case Imf::B44A_COMPRESSION:
            return "b44a";
        case Imf::DWAA_COMPRESSION:
            return "dwaa";
        case Imf::DWAB_COMPRESSION:
            return "dwab";
        default:  // newer than OpenEXR 3.1
            return "another";
    }
}

int lengthOf(int first, int last) {
    constexpr int64_t kMost = std::numeric_limits<int>::max();
    return int(std::clamp<int64_t>(int64_t(last) - first + 1, 0, kMost));
}
int apart(int a, int b) {
    constexpr int64_t kMost = std::numeric_limits<int>::max();
    return int(std::clamp<int64_t>(int64_t(a) - b, -kMost, kMost));
}
ExrPart described(const Imf::Header& header) {
    const auto data = header.dataWindow(), display = header.displayWindow();
    ExrPart part;
    if (header.hasName()) part.name = header.name();
    part.width = lengthOf(data.min.x, data.max.x);
    part.height = lengthOf(data.min.y, data.max.y);
    part.compression = nameOf(header.compression());
    part.storage = header.hasType() ? header.type() : header.hasTileDescription() ? "tiledimage" : "scanlineimage";
    part.deep = header.hasType() && header.type().starts_with("deep");
    part.shown = {apart(display.min.x, data.min.x), apart(display.min.y, data.min.y),
                  lengthOf(display.min.x, display.max.x), lengthOf(display.min.y, display.max.y)};
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
        part.channels.push_back(
            {c.name(), typeOf(c.channel().type), c.channel().xSampling != 1 || c.channel().ySampling != 1});
    orderChannels(part.channels);
    for (auto a = header.begin(); a != header.end(); ++a)
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&a.attribute()))
            part.texts[a.name()] = text->value();
        else if (const auto* number = dynamic_cast<const Imf::IntAttribute*>(&a.attribute()))
            part.integers[a.name()] = number->value();
    return part;
}

// Where OpenEXR finds or puts a channel's samples.
template <class T>
Imf::Slice slice(Imf::PixelType type, const Plane<T>& plane, const Imath::Box2i& window) {
    return Imf::Slice::Make(type, plane.row(0), window, sizeof(T), sizeof(T) * size_t(plane.stride()));
}
// The first row that cannot be read.
int unreadableRow(Imf::InputPart& in, const Imath::Box2i& window) {
    for (int y = window.min.y; y <= window.max.y; y++) try {
            in.readPixels(y);
        } catch (const std::exception&) {
            return y - window.min.y;
        }
    return 0;
}
// Ids that were stored as numbers. Throws InputError when one is no whole number.
void idsOf(const PlaneF& numbers, PlaneU& ids, const std::string& where) {
    for (int y = 0; y < numbers.height(); y++)
        for (int x = 0; x < numbers.width(); x++) {
            const float v = numbers.at(x, y);
            if (!(v >= 0 && v < 4294967296.0f) || v != float(uint32_t(v)))
                throw InputError(where + ", pixel (" + std::to_string(x) + ", " + std::to_string(y) +
                                 "): expected a whole number, found a fraction; export the shot again");
            ids.at(x, y) = uint32_t(v);
        }
}
}  // namespace

std::string_view name(ChannelType type) {
    switch (type) {
        case ChannelType::half:
            return "half";
        case ChannelType::real:
            return "float";
        case ChannelType::uint:
            return "uint";
        case ChannelType::other:
            break;
    }
    return "another type";
}

const ExrChannel* ExrPart::find(std::string_view channel) const {
    for (const auto& c : channels)
        if (c.name == channel) return &c;
    return nullptr;
}

bool isExr(const fs::path& file) {
    char bytes[4] = {};
    std::ifstream(file, std::ios::binary).read(bytes, sizeof bytes);
    return std::memcmp(bytes, "\x76\x2f\x31\x01", sizeof bytes) == 0;
}

void requireWhole(const ExrPart& part, const std::string& where, const std::string& advice) {
    if (!part.cropped()) return;
    const Window stored{-part.shown.x, -part.shown.y, part.width, part.height};
    throw InputError(where + ": expected a data window that is the display window (" +
                     std::to_string(part.shown.width) + " x " + std::to_string(part.shown.height) + " px), found " +
                     inWords(stored) + "; " + advice);
}

struct ExrFile::Input {
    explicit Input(const char* name) : file(name) {}
    Imf::MultiPartInputFile file;
};
ExrFile::~ExrFile() = default;
ExrFile::ExrFile(ExrFile&&) noexcept = default;
ExrFile& ExrFile::operator=(ExrFile&&) noexcept = default;

ExrFile::ExrFile(const fs::path& file, std::string advice) : path_(file), advice_("; " + std::move(advice)) {
    noteInput(file);
    std::error_code ignored;
    requireReadable(file, advice_);
    if (fs::is_directory(file, ignored)) throw InputError(file.string() + ": is a folder; expected an EXR file");
    if (!fs::is_regular_file(file, ignored))
        throw InputError(file.string() + ": is a pipe or a device; expected an EXR file");
    if (!isExr(file)) throw InputError(file.string() + ": not an EXR file" + advice_);
    startThreads();
    try {
        checkAttributeSizes(file);
        input_ = std::make_unique<Input>(file.c_str());
        for (int i = 0; i < input_->file.parts(); i++) parts_.push_back(described(input_->file.header(i)));
    } catch (const std::exception& e) {
        throw InputError(file.string() + ": damaged EXR header (" + whyOf(e) + ")" + advice_);
    }
}

const ExrPart* ExrFile::find(std::string_view part) const {
    for (const auto& p : parts_)
        if (p.name == part) return &p;
    return nullptr;
}

struct ExrFile::Slices : Imf::FrameBuffer {};

bool ExrFile::readLines(int index, const Slices& samples) {
    if (!hasZipLines(input_->file.header(index))) return false;
    try {
        Imf::InputPart in(input_->file, index);
        if (readZipLines(in, samples)) return true;
    } catch (const std::exception&) {  // said by OpenEXR's reader
    }
    input_ = std::make_unique<Input>(path_.c_str());  // it keeps chunks, and what we read is none that it knows of
    return false;
}

void ExrFile::readByOpenExr(int index, const Slices& samples, const std::string& where) {
    const Imath::Box2i window = input_->file.header(index).dataWindow();
    std::unique_ptr<Imf::InputPart> in;
    try {
        in = std::make_unique<Imf::InputPart>(input_->file, index);
        in->setFrameBuffer(samples);
        in->readPixels(window.min.y, window.max.y);
    } catch (const std::exception& e) {
        throw InputError(where + ": truncated or damaged at row " +
                         std::to_string(in ? unreadableRow(*in, window) : 0) + " (" + whyOf(e) + ")" + advice_);
    }
}

void ExrFile::read(const ExrPart& part, std::vector<ChannelTarget>& targets) {
    const std::string where = path_.string() + (part.name.empty() ? "" : ": part '" + part.name + "'");
    if (part.width < 1 || part.height < 1 || part.width > kLargestSide || part.height > kLargestSide)
        throw InputError(where + ": " + std::to_string(part.width) + " x " + std::to_string(part.height) +
                         " pixels; expected 1..16384 a side");
    if (part.deep)
        throw InputError(where + ": deep pixels (" + part.storage +
                         "), of which each holds several values; not supported, flatten it to one value per pixel");
    // All channels of a part lie in its blocks, and OpenEXR unpacks a block as a whole.
    const uint64_t channels = std::max(targets.size(), part.channels.size());
    const uint64_t asked = uint64_t(part.width) * uint64_t(part.height) * sizeof(float) * channels;
    std::error_code ignored;
    const uint64_t stored = fs::file_size(path_, ignored);
    if (asked > kAlwaysBytes && asked / mostBytesPerByte(part.compression) > stored)
        throw InputError(where + ": " + std::to_string(part.width) + " x " + std::to_string(part.height) +
                         " pixels cannot be in a file of " + std::to_string(stored) + " bytes" + advice_);
    const int index = int(&part - parts_.data());
    const Imath::Box2i window = input_->file.header(index).dataWindow();
    Slices samples;
    std::map<size_t, PlaneF> numbers;  // ids that are stored as numbers, by target
    for (size_t i = 0; i < targets.size(); i++) {
        ChannelTarget& t = targets[i];
        const ExrChannel* c = part.find(t.channel);
        if (!c) throw InputError(where + " has no channel '" + t.channel + "'; export the shot again with this pass");
        const bool id = std::holds_alternative<PlaneU*>(t.plane);
        if (c->type == ChannelType::other || (!id && c->type == ChannelType::uint))
            throw InputError(where + ", channel '" + t.channel + "': expected " + (id ? "uint" : "half or float") +
                             ", found " + std::string(name(c->type)) + "; export the shot again");
        if (c->subsampled)
            throw InputError(where + ", channel '" + t.channel +
                             "': sub-sampled, one value for several pixels, as luminance and chroma are stored; not "
                             "supported, write R, G and B with one value per pixel");
        t.stored = c->type;
        std::visit([&](auto* p) { *p = std::remove_pointer_t<decltype(p)>::unset(part.width, part.height); }, t.plane);
        assert(!samples.findSlice(t.channel));
        if (id && c->type == ChannelType::uint)
            samples.insert(t.channel, slice(Imf::UINT, *std::get<PlaneU*>(t.plane), window));
        else
            samples.insert(
                t.channel,
                slice(Imf::FLOAT,
                      id ? numbers[i] = PlaneF::unset(part.width, part.height) : *std::get<PlaneF*>(t.plane), window));
    }
    if (targets.empty()) return;
    if (!readLines(index, samples)) readByOpenExr(index, samples, where);
    for (const auto& [i, plane] : numbers)
        idsOf(plane, *std::get<PlaneU*>(targets[i].plane), where + ", channel '" + targets[i].channel + "'");
}

}  // namespace aa
