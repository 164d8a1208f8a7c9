#include "image/io.h"

#include <OpenEXR/ImfArray.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <fstream>

#include "image/error.h"
#include "image/exr.h"
#include "image/io_testing.h"
#include "image/output_error.h"
#include "image/png.h"

namespace aa {
namespace {
namespace fs = std::filesystem;
using OIIO::ImageInput;
using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;
using ::testing::StartsWith;

constexpr int kPictureWidth = 37, kPictureHeight = 23;

class ImageFiles : public testing::Test {
  protected:
    void SetUp() override {
        folder = fs::path(testing::TempDir()) /
                 (std::string("aa_image_") + testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder);
        fs::create_directories(folder);
    }
    void TearDown() override { fs::remove_all(folder); }

    static std::string errorOf(const fs::path& file) {
        try {
            readImage(file);
        } catch (const InputError& e) {
            EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
            return e.what();
        }
        return "no error";
    }
    void cut(const fs::path& file, double share) const {
        fs::resize_file(file, uintmax_t(double(fs::file_size(file)) * share));
    }
    fs::path folder;
};

// Values in [0,1] that no two channels or pixels share.
float valueAt(int x, int y, int c) { return float((x * 7 + y * 131 + c * 977) % 4001) / 4000.0f; }
Rgb ramp() {
    Rgb image(kPictureWidth, kPictureHeight);
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < kPictureHeight; y++)
            for (int x = 0; x < kPictureWidth; x++) image.c[c].at(x, y) = valueAt(x, y, int(c));
    return image;
}
// Written by OpenImageIO.
void writeByOther(const fs::path& file, ImageSpec spec, const std::vector<TypeDesc>& formats = {}) {
    if (!formats.empty()) spec.channelformats = formats;
    std::vector<float> pixels;
    for (int y = 0; y < spec.height; y++)
        for (int x = 0; x < spec.width; x++)
            for (int c = 0; c < spec.nchannels; c++) pixels.push_back(valueAt(x, y, c));
    auto out = ImageOutput::create(file.string());
    ASSERT_TRUE(out->open(file.string(), spec)) << out->geterror();
    ASSERT_TRUE(out->write_image(TypeDesc::FLOAT, pixels.data())) << out->geterror();
    ASSERT_TRUE(out->close());
}
// The first three channels (or the first, repeated) as OpenImageIO reads them. OpenImageIO 2.4 gives the same bits; the
// tolerance of 4 units in the last place is for other versions' scaling of codes.
void expectAsOther(const fs::path& file) {
    auto in = ImageInput::open(file.string());
    ASSERT_TRUE(in) << file;
    const ImageSpec& spec = in->spec();
    std::vector<float> pixels(size_t(spec.width) * size_t(spec.height) * size_t(spec.nchannels));
    ASSERT_TRUE(in->read_image(0, 0, 0, spec.nchannels, TypeDesc::FLOAT, pixels.data())) << in->geterror();
    const LoadedImage image = readImage(file);
    EXPECT_EQ(image.space, spec.format.is_floating_point() ? FileSpace::linear : FileSpace::encoded) << file;
    ASSERT_EQ(image.rgb.width(), spec.width);
    ASSERT_EQ(image.rgb.height(), spec.height);
    for (int y = 0; y < spec.height; y++)
        for (int x = 0; x < spec.width; x++)
            for (int c = 0; c < 3; c++) {
                const float* pixel =
                    pixels.data() + (size_t(y) * size_t(spec.width) + size_t(x)) * size_t(spec.nchannels);
                ASSERT_FLOAT_EQ(image.rgb.c[size_t(c)].at(x, y), pixel[spec.nchannels < 3 ? 0 : c])
                    << file << " pixel " << x << ", " << y << " channel " << c;
            }
}

TEST_F(ImageFiles, ExrOfEveryCompressionTypeAndLayout) {
    const fs::path file = folder / "a.exr";
    for (const char* compression : {"none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"})
        for (const auto type : {TypeDesc::HALF, TypeDesc::FLOAT}) {
            ImageSpec spec(kPictureWidth, kPictureHeight, 3, type);
            spec.attribute("compression", compression);
            writeByOther(file, spec);
            expectAsOther(file);
        }
    for (const auto& names : std::vector<std::vector<std::string>>{{"Y"},
                                                                   {"Y", "A"},
                                                                   {"R", "G", "B", "A"},
                                                                   {"zeta", "b", "A", "Z", "R"},
                                                                   {"N.X", "N.Y", "N.Z", "L.R", "L.G", "L.B"},
                                                                   {"Depth", "green", "Red", "U"}}) {
        ImageSpec spec(kPictureWidth, kPictureHeight, int(names.size()), TypeDesc::FLOAT);
        spec.channelnames = names;
        writeByOther(file, spec);
        expectAsOther(file);
    }
    ImageSpec spec(kPictureWidth, kPictureHeight, 3, TypeDesc::UINT);
    writeByOther(file, spec);
    expectAsOther(file);
    spec.format = TypeDesc::FLOAT;
    writeByOther(file, spec, {TypeDesc::UINT, TypeDesc::FLOAT, TypeDesc::HALF});
    expectAsOther(file);
    spec = ImageSpec(kPictureWidth, kPictureHeight, 3, TypeDesc::HALF);
    spec.tile_width = spec.tile_height = 16;
    writeByOther(file, spec);
    expectAsOther(file);
    spec.tile_width = spec.tile_height = 0;
    spec.x = 5, spec.y = -3, spec.full_width = 64, spec.full_height = 48;
    writeByOther(file, spec);
    expectAsOther(file);
}

TEST_F(ImageFiles, ExrThatHasNotOneValuePerPixelIsRefused) {
    const fs::path file = folder / "yc.exr";
    Imf::Array2D<Imf::Rgba> pixels(kPictureHeight + 1, kPictureWidth + 1);
    {
        Imf::RgbaOutputFile out(file.c_str(), kPictureWidth + 1, kPictureHeight + 1, Imf::WRITE_YC);
        out.setFrameBuffer(&pixels[0][0], 1, kPictureWidth + 1);
        out.writePixels(kPictureHeight + 1);
    }
    EXPECT_THAT(errorOf(file), AllOf(HasSubstr("yc.exr"), HasSubstr("sub-sampled"), Not(HasSubstr("damaged"))));
    const fs::path deep = folder / "deep.exr";
    ImageSpec spec(4, 4, 1, TypeDesc::FLOAT);
    spec.channelnames = {"Z"};
    spec.deep = true;
    auto out = ImageOutput::create("exr");
    OIIO::DeepData data(spec);
    data.set_samples(0, 2);
    ASSERT_TRUE(out->open(deep.string(), spec) && out->write_deep_image(data) && out->close()) << out->geterror();
    EXPECT_THAT(errorOf(deep), AllOf(HasSubstr("deep.exr"), HasSubstr("deep pixels"), Not(HasSubstr("damaged"))));
}

TEST_F(ImageFiles, WrittenExrIsWhatOthersExpect) {
    const fs::path file = folder / "a.exr";
    const Rgb image = ramp();
    for (const bool mark : {false, true}) {
        writeExr(file, image, mark);
        EXPECT_EQ(readImage(file).displayReferred, mark);
        EXPECT_TRUE(readImage(file).rgb.samePixels(image));
        expectAsOther(file);
        const ImageSpec spec = ImageInput::open(file.string())->spec();
        EXPECT_EQ(spec.channelnames, (std::vector<std::string>{"R", "G", "B"}));
        EXPECT_EQ(spec.format, TypeDesc::FLOAT);
        EXPECT_EQ(spec.get_string_attribute("compression"), "zip");
        EXPECT_EQ(spec.get_string_attribute("DateTime"), "2000:01:01 00:00:00");
        EXPECT_THAT(std::string(spec.get_string_attribute("oiio:ColorSpace")), MatchesRegex("[Ll]in.*"));
        EXPECT_EQ(spec.get_int_attribute("aaresolve:displayReferred", -1), mark);
    }
    writeLayers(file, {{"weight", {image.c[0]}}, {"edge", {image.c[0], image.c[1], image.c[2]}}});
    EXPECT_EQ(ImageInput::open(file.string())->spec().channelnames,
              (std::vector<std::string>{"weight", "edge.R", "edge.G", "edge.B"}));
    PlaneF real(8, 5, 0.5f), list(3, 1, 2.0f);
    PlaneU id(8, 5, 4'000'000'000u);
    writeParts(file, {{"one", {{"Z", &real}, {"id", &id}}}, {"two", {{"v", &list}}}});
    auto in = ImageInput::open(file.string());
    EXPECT_EQ(in->spec().get_string_attribute("oiio:subimagename"), "one");
    ASSERT_EQ(in->spec().channelnames, (std::vector<std::string>{"Z", "id"}));
    EXPECT_EQ(in->spec().channelformat(0), TypeDesc::FLOAT);
    EXPECT_EQ(in->spec().channelformat(1), TypeDesc::UINT32);
    ASSERT_TRUE(in->seek_subimage(1, 0));
    EXPECT_EQ(in->spec().get_string_attribute("oiio:subimagename"), "two");
    EXPECT_EQ(in->spec().width, 3);
    EXPECT_EQ(in->spec().full_width, 8);
    EXPECT_FALSE(in->seek_subimage(2, 0));
    in->geterror();
}

// A file of any depth and colour type, its codes as they lie in the file.
void writeCodes(const fs::path& file, int bits, int type, const std::vector<unsigned char>& rows, size_t rowBytes,
                double gamma = 0) {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    std::unique_ptr<FILE, int (*)(FILE*)> out(std::fopen(file.c_str(), "wb"), std::fclose);
    png_init_io(png, out.get());
    const int height = int(rows.size() / rowBytes);
    png_set_IHDR(png, info, kPictureWidth, png_uint_32(height), bits, type, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (gamma > 0) png_set_gAMA(png, info, gamma);
    std::vector<png_color> palette;
    for (int i = 0; i < 1 << std::min(bits, 8); i++)
        palette.push_back({png_byte(i * 3), png_byte(255 - i), png_byte(i ^ 0x55)});
    if (type == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(png, info, palette.data(), int(palette.size()));
    png_write_info(png, info);
    for (int y = 0; y < height; y++) png_write_row(png, rows.data() + size_t(y) * rowBytes);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
}
std::vector<unsigned char> bytes(size_t count) {
    std::vector<unsigned char> r(count);
    for (size_t i = 0; i < count; i++) r[i] = static_cast<unsigned char>(i * 2654435761u >> 13);
    return r;
}

TEST_F(ImageFiles, PngOfEveryDepthAndType) {
    const fs::path file = folder / "a.png";
    for (const auto& [type, channels] :
         {std::pair{PNG_COLOR_TYPE_GRAY, 1}, {PNG_COLOR_TYPE_PALETTE, 1}, {PNG_COLOR_TYPE_RGB, 3}})
        for (const int bits : {1, 2, 4, 8, 16}) {
            if ((channels == 3 && bits < 8) || (type == PNG_COLOR_TYPE_PALETTE && bits > 8)) continue;
            const size_t rowBytes = size_t((kPictureWidth * channels * bits + 7) / 8);
            writeCodes(file, bits, type, bytes(rowBytes * kPictureHeight), rowBytes);
            expectAsOther(file);
        }
}

TEST_F(ImageFiles, AlphaChangesNoColourAndIsKept) {
    const fs::path file = folder / "a.png";
    const auto codes = bytes(size_t(kPictureWidth) * kPictureHeight * 4);
    for (const double gamma : {0.0, 1.0, 1 / 2.2}) {
        writeCodes(file, 8, PNG_COLOR_TYPE_RGB_ALPHA, codes, size_t(kPictureWidth) * 4, gamma);
        const LoadedImage image = readImage(file);
        for (int y = 0; y < kPictureHeight; y++)
            for (int x = 0; x < kPictureWidth; x++) {
                const unsigned char* p = codes.data() + (size_t(y) * kPictureWidth + size_t(x)) * 4;
                for (size_t c = 0; c < 3; c++) ASSERT_FLOAT_EQ(image.rgb.c[c].at(x, y), p[c] / 255.0f);
                ASSERT_FLOAT_EQ(image.alpha.at(x, y), p[3] / 255.0f);
            }
        EXPECT_FALSE(image.isOpaque());
        writePng(folder / "again.png", image.rgb, &image.alpha);
        const LoadedImage again = readImage(folder / "again.png");
        EXPECT_TRUE(again.rgb.samePixels(image.rgb));
        EXPECT_TRUE(again.alpha.samePixels(image.alpha));
    }
    writeCodes(file, 16, PNG_COLOR_TYPE_GRAY_ALPHA, codes, size_t(kPictureWidth) * 4);
    const LoadedImage grey = readImage(file);
    EXPECT_NEAR(grey.rgb.c[0].at(0, 0) * 65535, uint32_t(codes[0]) << 8 | codes[1], 0.01);
    EXPECT_NEAR(grey.alpha.at(0, 0) * 65535, uint32_t(codes[2]) << 8 | codes[3], 0.01);
    EXPECT_TRUE(grey.rgb.c[0].samePixels(grey.rgb.c[2]));
    writeExr(folder / "a.exr", grey.rgb, false, {&grey.alpha});
    EXPECT_TRUE(readImage(folder / "a.exr").alpha.samePixels(grey.alpha));
    writeExr(folder / "a.exr", grey.rgb, false);
    EXPECT_TRUE(readImage(folder / "a.exr").isOpaque());
}

// A part of an EXR that OpenImageIO writes: its name, channels, and a value that tells it from others.
struct Part {
    std::string name;
    std::vector<std::string> channels;
    float value;
};
void writePartsByOther(const fs::path& file, const std::vector<Part>& parts) {
    std::vector<ImageSpec> specs;
    for (const auto& p : parts) {
        ImageSpec spec(8, 4, int(p.channels.size()), TypeDesc::HALF);
        spec.channelnames = p.channels;
        if (!p.name.empty()) spec.attribute("oiio:subimagename", p.name);
        specs.push_back(spec);
    }
    auto out = ImageOutput::create(file.string());
    ASSERT_TRUE(out->open(file.string(), int(specs.size()), specs.data())) << out->geterror();
    for (size_t i = 0; i < parts.size(); i++) {
        if (i > 0) {
            ASSERT_TRUE(out->open(file.string(), specs[i], ImageOutput::AppendSubimage)) << out->geterror();
        }
        std::vector<float> pixels;
        for (int n = 0; n < 8 * 4; n++)
            for (size_t c = 0; c < parts[i].channels.size(); c++) pixels.push_back(parts[i].value + float(c));
        ASSERT_TRUE(out->write_image(TypeDesc::FLOAT, pixels.data())) << out->geterror();
    }
    ASSERT_TRUE(out->close());
}
std::vector<std::string> named(const std::string& layer, const std::vector<std::string>& letters) {
    std::vector<std::string> all;
    for (const auto& l : letters) all.push_back(layer + "." + l);
    return all;
}
std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

TEST_F(ImageFiles, ThePictureAmongLayersAndPartsIsChosenByName) {
    const fs::path file = folder / "a.exr";
    const std::vector<std::string> rgb = {"R", "G", "B"}, rgba = {"R", "G", "B", "A"};
    struct Case {
        std::vector<Part> parts;
        std::string asked, layer;
        float red;  // negative: refused
    };
    // In a part OpenImageIO writes channels in the order given; the value of channel c is the part's plus c.
    const Case cases[] = {
        {{{"", joined(named("L.AO", rgb), named("L.Combined", rgba)), 1}}, "", "L.Combined", 4},
        {{{"", joined(named("L.AO", rgb), named("L.Combined", rgba)), 1}}, "AO", "L.AO", 1},
        {{{"", joined(named("L.AO", rgb), named("L.Combined", rgba)), 1}}, "l.ao", "L.AO", 1},
        {{{"", joined(named("L.AO", rgb), named("L.Combined", rgba)), 1}}, "Mist", "", -1},
        {{{"", joined(named("A.Combined", rgb), named("B.Combined", rgb)), 1}}, "", "", -1},
        {{{"", joined(named("A.Combined", rgb), named("B.Combined", rgb)), 1}}, "B.Combined", "B.Combined", 4},
        {{{"", joined(named("L.AO", rgb), named("L.Mist", rgb)), 1}}, "", "", -1},
        {{{"", joined(named("L.Depth", {"Z"}), named("L.AO", rgb)), 1}}, "", "L.AO", 2},
        {{{"", joined(named("L.AO", rgb), rgb), 1}}, "", "RGB", 4},
        {{{"Depth", {"Z"}, 1}, {"Combined", rgb, 5}}, "", "Combined", 5},
        {{{"Depth", {"Z"}, 1}, {"Combined", rgb, 5}}, "Depth", "Depth", 1},
        {{{"left", rgb, 1}, {"right", rgb, 5}}, "", "", -1},
        {{{"left", rgb, 1}, {"right", rgb, 5}}, "right", "right", 5},
        {{{"left", named("L.Combined", rgb), 1}, {"right", named("L.Combined", rgb), 5}},
         "right",
         "right/L.Combined",
         5},
        {{{"", named("L.with.dots.Combined", rgb), 3}}, "", "", 3},
        {{{"", {"X", "Y", "Z"}, 3}}, "", "", 3},
    };
    for (const auto& c : cases) {
        writePartsByOther(file, c.parts);
        std::string tried = c.parts[0].name + " " + c.parts[0].channels[0] + ", asked '" + c.asked + "'";
        try {
            const LoadedImage image = readImage(file, {.layer = c.asked});
            EXPECT_EQ(image.layer, c.layer) << tried;
            EXPECT_EQ(image.rgb.c[0].at(0, 0), c.red) << tried;
        } catch (const InputError& e) {
            EXPECT_LT(c.red, 0) << tried << ": " << e.what();
            EXPECT_THAT(e.what(), AllOf(HasSubstr("--layer"), HasSubstr("'"))) << tried;
        }
    }
    writePng(folder / "a.png", ramp());
    EXPECT_THROW(readImage(folder / "a.png", {.layer = "Combined"}), UsageError);
}

TEST_F(ImageFiles, DisplayWindowDecidesWhatIsShown) {
    const fs::path file = folder / "a.exr";
    const auto write = [&](int x, int y) {
        ImageSpec spec(kPictureWidth, kPictureHeight, 4, TypeDesc::FLOAT);
        spec.x = x, spec.y = y, spec.full_x = 2, spec.full_y = 1, spec.full_width = 64, spec.full_height = 48;
        writeByOther(file, spec);
        LoadedImage image = readImage(file);
        EXPECT_FALSE(image.allShown());
        showDisplayWindow(image, file);
        EXPECT_TRUE(image.allShown());
        return image;
    };
    const LoadedImage a = write(12, 6), b = write(22, 16), over = write(-3, -4);
    ASSERT_EQ(std::pair(a.rgb.width(), a.rgb.height()), std::pair(64, 48));
    EXPECT_FALSE(a.rgb.samePixels(b.rgb));
    EXPECT_EQ(a.rgb.c[1].at(10, 5), valueAt(0, 0, 1));
    EXPECT_EQ(b.rgb.c[1].at(20, 15), valueAt(0, 0, 1));
    EXPECT_EQ(over.rgb.c[1].at(0, 0), valueAt(5, 5, 1));
    EXPECT_EQ(a.rgb.c[1].at(9, 5), 0);
    EXPECT_EQ(a.alpha.at(10, 5), valueAt(0, 0, 3));
    EXPECT_EQ(a.alpha.at(9, 5), 0);
    // Written again it lies where it lay.
    const LoadedImage stored = readImage(file);
    writeExr(folder / "again.exr", stored.rgb, false, {&stored.alpha, stored.shown});
    LoadedImage again = readImage(folder / "again.exr");
    EXPECT_EQ(again.shown, stored.shown);
    showDisplayWindow(again, folder / "again.exr");
    EXPECT_TRUE(again.rgb.samePixels(over.rgb));
}

TEST_F(ImageFiles, TurnedPicturesAreUpright) {
    // Where EXIF says that the first row and the first column lie. Of a JPEG, which changes values, the size alone.
    struct Side {
        char row, column;
    };
    const Side sides[] = {{'t', 'l'}, {'t', 'r'}, {'b', 'r'}, {'b', 'l'},
                          {'l', 't'}, {'r', 't'}, {'r', 'b'}, {'l', 'b'}};
    const auto from = [](char side, int at, int length) { return side == 't' || side == 'l' ? at : length - 1 - at; };
    for (const char* name : {"a.tif", "a.jpg"})
        for (int orientation = 1; orientation <= 8; orientation++) {
            const Side& side = sides[orientation - 1];
            const bool rowsStand = side.row == 'l' || side.row == 'r';
            ImageSpec spec(kPictureWidth, kPictureHeight, 3, TypeDesc::UINT8);
            spec.attribute("Orientation", orientation);
            writeByOther(folder / name, spec);
            const LoadedImage image = readImage(folder / name);
            ASSERT_EQ(image.rgb.width(), rowsStand ? kPictureHeight : kPictureWidth) << name << orientation;
            ASSERT_EQ(image.rgb.height(), rowsStand ? kPictureWidth : kPictureHeight) << name << orientation;
            for (int j = 0; j < kPictureHeight && std::string(name) == "a.tif"; j++)
                for (int i = 0; i < kPictureWidth; i++) {
                    const int row = from(side.row, j, kPictureHeight), column = from(side.column, i, kPictureWidth);
                    const float found = rowsStand ? image.rgb.c[1].at(row, column) : image.rgb.c[1].at(column, row);
                    ASSERT_NEAR(found, valueAt(i, j, 1), 3e-3) << orientation;
                }
        }
    // PNG: an eXIf chunk with the one tag, in either byte order.
    for (const bool little : {true, false}) {
        std::vector<unsigned char> exif =
            little ? std::vector<unsigned char>{'I', 'I', 42, 0, 8, 0, 0, 0, 1, 0, 0x12, 1, 3,
                                                0,   1,   0,  0, 0, 6, 0, 0, 0, 0, 0,    0, 0}
                   : std::vector<unsigned char>{'M', 'M', 0, 42, 0, 0, 0, 8, 0, 1, 1, 0x12, 0,
                                                3,   0,   0, 0,  1, 0, 6, 0, 0, 0, 0, 0,    0};
        const fs::path file = folder / "turned.png";
        png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
        png_infop info = png_create_info_struct(png);
        std::unique_ptr<FILE, int (*)(FILE*)> out(std::fopen(file.c_str(), "wb"), std::fclose);
        png_init_io(png, out.get());
        png_set_IHDR(png, info, 2, 1, 8, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                     PNG_FILTER_TYPE_DEFAULT);
        png_set_eXIf_1(png, info, png_uint_32(exif.size()), exif.data());
        png_write_info(png, info);
        const unsigned char row[] = {10, 200};
        png_write_row(png, row);
        png_write_end(png, info);
        png_destroy_write_struct(&png, &info);
        out.reset();
        const LoadedImage image = readImage(file);  // 6: to be turned right, so that the left lies on top
        ASSERT_EQ(std::pair(image.rgb.width(), image.rgb.height()), std::pair(1, 2)) << little;
        EXPECT_FLOAT_EQ(image.rgb.c[0].at(0, 0), 10 / 255.0f);
        EXPECT_FLOAT_EQ(image.rgb.c[0].at(0, 1), 200 / 255.0f);
    }
}

TEST_F(ImageFiles, OnePolicyForValuesThatAreNoNumbers) {
    const fs::path file = folder / "a.exr";
    Rgb image(8, 4, 0.5f);
    image.c[0].at(3, 2) = NAN, image.c[1].at(0, 0) = INFINITY, image.c[2].at(1, 1) = -1, image.c[2].at(7, 3) = 1e30f;
    writeExr(file, image, false);
    const auto read = [&](InputPolicy policy, ColourUse use) { return readImage(file, {"", policy, use}); };
    const LoadedImage raw = read(InputPolicy::raw, ColourUse::method);
    EXPECT_TRUE(std::isnan(raw.rgb.c[0].at(3, 2)));
    EXPECT_EQ(inWords(raw.counts), "1 NaN, 1 Inf, 1 negative, 1 above 1e18");
    const LoadedImage repaired = read(InputPolicy::sanitise, ColourUse::method);
    EXPECT_EQ(inWords(repaired.counts), inWords(raw.counts));
    EXPECT_EQ(repaired.rgb.c[0].at(3, 2), 0.5f);
    EXPECT_EQ(repaired.rgb.c[1].at(0, 0), kLargestRadiance);
    EXPECT_EQ(repaired.rgb.c[2].at(1, 1), 0);
    EXPECT_EQ(repaired.rgb.c[2].at(7, 3), kLargestRadiance);
    const LoadedImage measured = read(InputPolicy::sanitise, ColourUse::measured);
    EXPECT_EQ(measured.rgb.c[2].at(1, 1), -1);
    EXPECT_EQ(measured.rgb.c[2].at(7, 3), 1e30f);
    try {
        read(InputPolicy::strict, ColourUse::method);
        ADD_FAILURE();
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), AllOf(HasSubstr("a.exr"), HasSubstr("pixel (3, 2)"), HasSubstr("NaN"),
                                    HasSubstr("--non-finite sanitise")));
    }
}

TEST_F(ImageFiles, WrittenPngIsWhatOthersExpect) {
    const fs::path file = folder / "a.png";
    Rgb image = ramp();
    image.c[0].at(0, 0) = -1, image.c[0].at(1, 0) = 2, image.c[0].at(2, 0) = NAN;
    writePng(file, image);
    expectAsOther(file);
    const Rgb back = readImage(file).rgb;
    EXPECT_EQ(back.c[0].at(0, 0), 0);
    EXPECT_EQ(back.c[0].at(1, 0), 1);
    EXPECT_EQ(back.c[0].at(2, 0), 0);
    for (size_t c = 0; c < 3; c++)
        for (int x = 3; x < kPictureWidth; x++)
            EXPECT_EQ(std::lround(255 * back.c[c].at(x, 0)), std::floor(255 * image.c[c].at(x, 0) + 0.5f));
    const ImageSpec spec = ImageInput::open(file.string())->spec();
    EXPECT_THAT(std::string(spec.get_string_attribute("oiio:ColorSpace")), AnyOf("sRGB", StartsWith("srgb")));
    EXPECT_EQ(spec.format, TypeDesc::UINT8);
    EXPECT_LT(pngBytes(codesOf(image), kPictureWidth, kPictureHeight, {.compressionLevel = 9}).size(),
              pngBytes(codesOf(image), kPictureWidth, kPictureHeight, {.compressionLevel = 0}).size());
}

TEST_F(ImageFiles, ContentDecidesAndNotTheName) {
    writePng(folder / "png.png", ramp());
    fs::rename(folder / "png.png", folder / "png.exr");
    EXPECT_EQ(readImage(folder / "png.exr").space, FileSpace::encoded);
    writeExr(folder / "exr.exr", ramp(), false);
    fs::rename(folder / "exr.exr", folder / "exr");
    EXPECT_EQ(readImage(folder / "exr").space, FileSpace::linear);
}

TEST_F(ImageFiles, DamageIsNamed) {
    for (const char* name : {"a.png", "a.exr"}) {
        const fs::path file = folder / name;
        const auto write = [&] { file.extension() == ".png" ? writePng(file, ramp()) : writeExr(file, ramp(), false); };
        write();
        cut(file, 0.6);
        EXPECT_THAT(errorOf(file), AllOf(HasSubstr(name), HasSubstr("truncated or damaged")));
        fs::resize_file(file, 24);
        EXPECT_THAT(errorOf(file), AllOf(HasSubstr(name), HasSubstr("damaged"), HasSubstr("header")));
        write();
        std::fstream(file, std::ios::in | std::ios::out | std::ios::binary)
                .seekp(std::streamoff(fs::file_size(file) / 2))
            << std::string(100, '\x5a');
        EXPECT_THAT(errorOf(file), AllOf(HasSubstr(name), HasSubstr("truncated or damaged")));
    }
    EXPECT_THAT(errorOf(folder / "none.png"), HasSubstr("no such file"));
    ImageSpec wide(kLargestSide + 1, 1, 1, TypeDesc::UINT8);
    writeByOther(folder / "wide.png", wide);
    EXPECT_THAT(errorOf(folder / "wide.png"), HasSubstr("16385 x 1 pixels"));
    wide.format = TypeDesc::HALF;
    writeByOther(folder / "wide.exr", wide);
    EXPECT_THAT(errorOf(folder / "wide.exr"), HasSubstr("16385 x 1 pixels"));
}

void patch(const fs::path& file, size_t at, std::string_view bytes) {
    std::fstream(file, std::ios::in | std::ios::out | std::ios::binary).seekp(std::streamoff(at)) << bytes;
}
TEST_F(ImageFiles, ASizeThatTheFileCannotHoldAsksForNoMemory) {
    const fs::path png = folder / "a.png", exr = folder / "a.exr";
    writePng(png, ramp());
    constexpr size_t kSize = 16, kCrc = 29;  // of the header's chunk
    const std::string header("IHDR\0\0\x40\0\0\0\x40\0\x08\x02\0\0\0", 17);
    const auto crc = uint32_t(crc32(0, reinterpret_cast<const Bytef*>(header.data()), uInt(header.size())));
    patch(png, kSize, std::string_view(header).substr(4));
    patch(png, kCrc, std::string{char(crc >> 24), char(crc >> 16), char(crc >> 8), char(crc)});
    EXPECT_THAT(errorOf(png), HasSubstr("16384 x 16384 pixels cannot be in a file of "));

    Rgb noise(120, 90);  // of rows that no compression shortens: the table of blocks of the false size fits in
    for (PlaneF& plane : noise.c)
        for (int y = 0; y < noise.height(); y++)
            for (int x = 0; x < noise.width(); x++) plane.at(x, y) = std::sin(float(x * 977 + y * y * 131));
    writeExr(exr, noise, false);
    std::string content(fs::file_size(exr), '\0');
    std::ifstream(exr, std::ios::binary).read(content.data(), std::streamsize(content.size()));
    const size_t window = content.find("dataWindow");
    ASSERT_NE(window, std::string::npos);
    constexpr size_t kCorner = sizeof("dataWindow") + sizeof("box2i") + 4 + 8;  // names, length, the first corner
    patch(exr, window + kCorner, std::string_view("\xff\x3f\0\0\xff\x3f\0\0", 8));
    EXPECT_THAT(errorOf(exr), HasSubstr("16384 x 16384 pixels cannot be in a file of "));
}

TEST_F(ImageFiles, WhatKilledProcessesLeftIsRemovedAndWhatLivingOnesWriteIsNot) {
    const fs::path dead = leftover(folder / "a.exr"), alive = temporaryName(folder / "b.exr");
    const fs::path foreign = folder / ".c.1234567-99999999.partial.exr", own = folder / "d.partial.exr";
    for (const fs::path& file : {dead, alive, foreign, own}) std::ofstream(file) << "x";
    makeWritableFolder(folder);
    EXPECT_FALSE(fs::exists(dead));
    for (const fs::path& file : {alive, foreign, own}) EXPECT_TRUE(fs::exists(file)) << file;
}

TEST_F(ImageFiles, AFileThatIsAskedForClearsWhatKilledProcessesLeftOfIt) {
    const fs::path other = folder / "other", dead = other / leftover(folder / "a.png").filename();
    fs::create_directories(other);
    std::ofstream(dead) << "x";
    writePng(other / "a.png", ramp());
    EXPECT_FALSE(fs::exists(dead));
    EXPECT_TRUE(fs::exists(other / "a.png"));
}
TEST_F(ImageFiles, WhatCannotBeWrittenIsSaidAndLeavesNothing) {
    for (const char* name : {"a.png", "a.exr", "asked"}) {
        const fs::path file = folder / "nowhere" / name;
        try {
            if (file.extension() == ".png")
                writePng(file, ramp());
            else if (file.extension() == ".exr")
                writeExr(file, ramp(), false);
            else
                requireWritable(file);
            ADD_FAILURE() << name;
        } catch (const InputError& e) {
            EXPECT_THAT(e.what(), AllOf(HasSubstr(name), HasSubstr("cannot be written"), HasSubstr("No such file")));
        }
    }
    EXPECT_THROW(requireWritable(folder), OutputError) << "a folder is there";
    writeText(folder / "a", "");
    EXPECT_THROW(requireWritable(folder / "a" / "b"), OutputError) << "in a file";
    EXPECT_NO_THROW(requireWritable(folder / "a"));
    EXPECT_NO_THROW(requireWritable(folder / "new"));
}

}  // namespace
}  // namespace aa
