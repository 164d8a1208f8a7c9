#include "shot/exr_parts.h"

#include <OpenImageIO/imageio.h>
// Conversion by arithmetic: the table would need libImath at link time.
#define IMATH_HALF_NO_LOOKUP_TABLE
#include <half.h>

#include <cstring>

#include "image/error.h"
#include "image/io.h"
#include "image/no_date.h"
#include "shot/manifest.h"

namespace aa {
namespace fs = std::filesystem;
using OIIO::ImageInput;
using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

namespace {
// Rows per read: several ZIP chunks of 16 rows, so that OpenEXR decodes them in parallel, yet small beside a plane.
constexpr int kBlockRows = 128;

ChannelType typeOf(TypeDesc t) {
    return t == TypeDesc::HALF     ? ChannelType::half
           : t == TypeDesc::FLOAT  ? ChannelType::real
           : t == TypeDesc::UINT32 ? ChannelType::uint
                                   : ChannelType::other;
}
size_t bytesOf(ChannelType t) { return t == ChannelType::half ? 2 : 4; }

std::string firstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

// One channel of a row of interleaved native samples into a row of a plane.
void unpackRow(const std::byte* from, size_t step, ChannelType type, int width, float* to) {
    if (type == ChannelType::half)
        for (int x = 0; x < width; x++, from += step) {
            uint16_t bits;
            std::memcpy(&bits, from, 2);
            to[x] = imath_half_to_float(bits);
        }
    else if (type == ChannelType::real)
        for (int x = 0; x < width; x++, from += step) std::memcpy(to + x, from, 4);
    else
        for (int x = 0; x < width; x++, from += step) {
            uint32_t v;
            std::memcpy(&v, from, 4);
            to[x] = float(v);
        }
}
// Ids: uint as it is; a float must hold a whole number. Returns the first column that does not, or -1.
int unpackRow(const std::byte* from, size_t step, ChannelType type, int width, uint32_t* to) {
    if (type == ChannelType::uint) {
        for (int x = 0; x < width; x++, from += step) std::memcpy(to + x, from, 4);
        return -1;
    }
    for (int x = 0; x < width; x++, from += step) {
        float v;
        if (type == ChannelType::half) {
            uint16_t bits;
            std::memcpy(&bits, from, 2);
            v = imath_half_to_float(bits);
        } else
            std::memcpy(&v, from, 4);
        if (!(v >= 0 && v < 4294967296.0f) || v != float(uint32_t(v))) return x;
        to[x] = uint32_t(v);
    }
    return -1;
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

struct ExrFile::Input {
    std::unique_ptr<ImageInput> image;
};
ExrFile::~ExrFile() = default;
ExrFile::ExrFile(ExrFile&&) noexcept = default;
ExrFile& ExrFile::operator=(ExrFile&&) noexcept = default;

ExrFile::ExrFile(const fs::path& file) : path_(file), input_(std::make_unique<Input>()) {
    std::error_code ignored;
    if (!fs::exists(file, ignored)) throw InputError(file.string() + ": no such file; export the frame again");
    if (fs::is_directory(file, ignored)) throw InputError(file.string() + ": is a folder; expected an EXR file");
    try {
        input_->image = ImageInput::create("exr");
        ImageSpec spec;
        if (!input_->image || !input_->image->valid_file(file.string()))
            throw InputError(file.string() + ": not an EXR file; export the frame again");
        if (!input_->image->open(file.string(), spec))
            throw InputError(file.string() + ": damaged EXR header (" + firstLine(input_->image->geterror()) +
                             "); export the frame again");
        for (int i = 0; input_->image->seek_subimage(i, 0); i++) {
            const ImageSpec& s = input_->image->spec();
            ExrPart part;
            part.name = s.get_string_attribute("oiio:subimagename");
            part.width = s.width;
            part.height = s.height;
            part.compression = s.get_string_attribute("compression", "none");
            part.cropped = s.x != s.full_x || s.y != s.full_y || s.width != s.full_width || s.height != s.full_height;
            for (const auto& a : s.extra_attribs)
                if (a.type() == TypeDesc::STRING) part.texts[a.name().string()] = a.get_string();
            for (int c = 0; c < s.nchannels; c++)
                part.channels.push_back({s.channel_name(c), typeOf(s.channelformat(c))});
            parts_.push_back(std::move(part));
        }
        input_->image->geterror();  // seeking past the last part is how the list ends
    } catch (const InputError&) {
        throw;
    } catch (const std::exception& e) {
        throw InputError(file.string() + ": damaged EXR header (" + firstLine(e.what()) + "); export the frame again");
    }
}

const ExrPart* ExrFile::find(std::string_view part) const {
    for (const auto& p : parts_)
        if (p.name == part) return &p;
    return nullptr;
}

void ExrFile::read(const ExrPart& part, std::vector<ChannelTarget>& targets) {
    const std::string where = path_.string() + ": part '" + part.name + "'";
    if (part.width < 1 || part.height < 1 || part.width > kMaxResolution || part.height > kMaxResolution)
        throw InputError(where + ": " + std::to_string(part.width) + " x " + std::to_string(part.height) +
                         " pixels; expected 1..16384 a side");
    std::vector<size_t> index;  // of each target in the part
    size_t first = SIZE_MAX, last = 0;
    for (auto& t : targets) {
        const ExrChannel* c = part.find(t.channel);
        if (!c) throw InputError(where + " has no channel '" + t.channel + "'; export the shot again with this pass");
        const bool id = std::holds_alternative<PlaneU*>(t.plane);
        if (c->type == ChannelType::other || (!id && c->type == ChannelType::uint))
            throw InputError(where + ", channel '" + t.channel + "': expected " + (id ? "uint" : "half or float") +
                             ", found " + std::string(name(c->type)) + "; export the shot again");
        t.stored = c->type;
        index.push_back(size_t(c - part.channels.data()));
        first = std::min(first, index.back());
        last = std::max(last, index.back());
        std::visit([&](auto* p) { *p = std::remove_pointer_t<decltype(p)>(part.width, part.height); }, t.plane);
    }
    if (targets.empty()) return;
    std::vector<size_t> offset(part.channels.size());  // bytes from the first channel read
    size_t step = 0;
    for (size_t c = first; c <= last; c++) {
        offset[c] = step;
        step += bytesOf(part.channels[c].type);
    }
    const int subimage = int(&part - parts_.data());
    const ImageSpec spec = input_->image->spec_dimensions(subimage);
    std::vector<std::byte> block(step * size_t(part.width) * size_t(std::min(kBlockRows, part.height)));
    for (int y0 = 0; y0 < part.height; y0 += kBlockRows) {
        const int y1 = std::min(y0 + kBlockRows, part.height);
        bool ok = false;
        std::string why;
        try {
            ok = input_->image->read_scanlines(subimage, 0, spec.y + y0, spec.y + y1, 0, int(first), int(last) + 1,
                                               TypeDesc::UNKNOWN, block.data());
            if (!ok) why = input_->image->geterror();
        } catch (const std::exception& e) {
            why = e.what();
        }
        if (!ok)
            throw InputError(where + ": truncated or damaged in rows " + std::to_string(y0) + ".." +
                             std::to_string(y1 - 1) + (why.empty() ? "" : " (" + firstLine(why) + ")") +
                             "; export the frame again");
        for (size_t i = 0; i < targets.size(); i++)
            for (int y = y0; y < y1; y++) {
                const std::byte* row = block.data() + size_t(y - y0) * size_t(part.width) * step + offset[index[i]];
                if (auto* real = std::get_if<PlaneF*>(&targets[i].plane))
                    unpackRow(row, step, targets[i].stored, part.width, (*real)->row(y));
                else if (const int x = unpackRow(row, step, targets[i].stored, part.width,
                                                 std::get<PlaneU*>(targets[i].plane)->row(y));
                         x >= 0)
                    throw InputError(where + ", channel '" + targets[i].channel + "', pixel (" + std::to_string(x) +
                                     ", " + std::to_string(y) +
                                     "): expected a whole number, found a fraction; export the shot again");
            }
    }
}

void writeParts(const fs::path& file, const std::vector<PartSource>& parts) {
    const fs::path temporary = temporaryName(file);
    std::vector<ImageSpec> specs;
    for (const auto& part : parts) {
        const auto size = [](auto* p) { return std::pair(p->width(), p->height()); };
        const auto [w, h] = std::visit(size, part.channels.at(0).plane);
        ImageSpec spec(w, h, int(part.channels.size()), TypeDesc::FLOAT);
        spec.channelnames.clear();
        for (const auto& c : part.channels) {
            assert(std::visit(size, c.plane) == std::pair(w, h));
            spec.channelnames.push_back(c.channel);
            spec.channelformats.push_back(std::holds_alternative<const PlaneU*>(c.plane) ? TypeDesc::UINT32
                                                                                         : TypeDesc::FLOAT);
        }
        if (std::all_of(spec.channelformats.begin(), spec.channelformats.end(),
                        [&](auto f) { return f == spec.channelformats[0]; })) {
            spec.set_format(spec.channelformats[0]);
            spec.channelformats.clear();
        }
        // All parts show one picture: a list of another size keeps its display window.
        spec.full_width = specs.empty() ? w : specs[0].full_width;
        spec.full_height = specs.empty() ? h : specs[0].full_height;
        spec.attribute("oiio:subimagename", part.name);
        spec.attribute("compression", "zip");
        spec.attribute("DateTime", kNoDate);
        specs.push_back(std::move(spec));
    }
    const auto attempt = [&]() -> std::string {
        auto out = ImageOutput::create("exr");
        if (!out) return OIIO::geterror();
        for (size_t i = 0; i < parts.size(); i++) {
            const bool opened = i == 0 ? out->open(temporary.string(), int(specs.size()), specs.data())
                                       : out->open(temporary.string(), specs[i], ImageOutput::AppendSubimage);
            if (!opened) return out->geterror();
            const int w = specs[i].width, h = specs[i].height, n = specs[i].nchannels;
            std::vector<std::byte> block(size_t(w) * size_t(n) * 4 * size_t(std::min(h, kBlockRows)));
            for (int y0 = 0; y0 < h; y0 += kBlockRows) {
                const int y1 = std::min(y0 + kBlockRows, h);
                for (int c = 0; c < n; c++)
                    std::visit(
                        [&](auto* plane) {
                            for (int y = y0; y < y1; y++) {
                                std::byte* to = block.data() + (size_t(y - y0) * size_t(w) * size_t(n) + size_t(c)) * 4;
                                for (int x = 0; x < w; x++, to += size_t(n) * 4) std::memcpy(to, plane->row(y) + x, 4);
                            }
                        },
                        parts[i].channels[size_t(c)].plane);
                if (!out->write_scanlines(y0, y1, 0, TypeDesc::UNKNOWN, block.data())) return out->geterror();
            }
        }
        return out->close() ? "" : out->geterror() + " ";
    };
    std::string why;
    try {
        why = attempt();
    } catch (const std::exception& e) {
        why = e.what();
    }
    if (!why.empty()) {
        std::error_code ignored;
        fs::remove(temporary, ignored);
        throw InputError(file.string() + ": cannot be written (" + firstLine(why) +
                         "); check permissions and free disk space");
    }
    renameInto(temporary, file);
}

}  // namespace aa
