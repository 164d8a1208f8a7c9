#include "targets.h"

#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "image/error.h"
#include "image/exr.h"
#include "image/exr_layers.h"
#include "image/io.h"
#include "image/png.h"
#include "methods/spec.h"
#include "report/angles.h"
#include "report/survey.h"
#include "report/survey_questions.h"
#include "shot/frame_notes.h"
#include "shot/import/engine_layout.h"
#include "shot/import/frame.h"
#include "shot/import/pitfalls.h"
#include "shot/manifest.h"
#include "shot/reader.h"
#include "shot/segments.h"
#include "study/results.h"
#include "study/survey.h"
#include "study/sweep.h"

namespace aa::fuzz {
namespace fs = std::filesystem;

namespace {
// The size of fuzz.py's smallest shot, and its pattern.
constexpr int kWidth = 8, kHeight = 6;

// A folder of this process, in memory where the system has such a place; emptied at exit.
class Folder {
  public:
    Folder() {
        const fs::path memory = "/dev/shm";
        const fs::path root = fs::is_directory(memory) ? memory : fs::temp_directory_path();
        path_ = root / ("aaresolve-fuzz-" + std::to_string(getpid()));
        fs::create_directories(path_ / "frames");
    }
    ~Folder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    fs::path write(const char* name, Bytes input) const {
        const fs::path file = path_ / name;
        std::ofstream(file, std::ios::binary)
            .write(reinterpret_cast<const char*>(input.data()), std::streamsize(input.size()));
        return file;
    }
    const fs::path& path() const { return path_; }

  private:
    fs::path path_;
};
const Folder& folder() {
    static const Folder one;
    return one;
}
std::string asText(Bytes input) { return {reinterpret_cast<const char*>(input.data()), input.size()}; }

// Pictures that only take longer; those above what is read at all are refused without room being made for them.
bool takesLong(int width, int height) {
    constexpr int kMost = 1 << 16;
    return width <= kLargestSide && height <= kLargestSide && int64_t(width) * height > kMost;
}
// Nor is room made for more than could be unpacked from so few bytes.
bool isLarge(const ExrPart& part, Bytes input) {
    constexpr int64_t kMostUnpacked = 256 * 1032;
    return takesLong(part.width, part.height) &&
           int64_t(part.width) * part.height * int64_t(part.channels.size()) * int64_t(sizeof(float)) / kMostUnpacked <=
               int64_t(input.size());
}
// Every channel of every part, each as what it is stored as.
void readParts(Bytes input) {
    ExrFile file(folder().write("parts.exr", input));
    for (const ExrPart& part : file.parts()) {
        if (isLarge(part, input)) continue;
        std::vector<PlaneF> numbers(part.channels.size());
        std::vector<PlaneU> ids(part.channels.size());
        std::vector<ChannelTarget> targets;
        for (size_t i = 0; i < part.channels.size(); i++) {
            const ExrChannel& c = part.channels[i];
            const bool id = c.type == ChannelType::uint;
            targets.push_back({c.name, id ? PlaneRef(&ids[i]) : PlaneRef(&numbers[i])});
        }
        file.read(part, targets);
    }
}
// A shot of one frame, whose files are the input.
const ShotReader& shotOfOne() {
    static const ShotReader shot = [] {
        const Folder& at = folder();
        Manifest m;
        m.folder = at.path();
        m.width = kWidth, m.height = kHeight;
        m.subsamplePattern = "own";
        m.subsamplePositionsPx = {{-0.25, -0.25}, {0.25, 0.25}};
        m.truthSamplesPerHalf = 4;
        m.frames.emplace_back();
        m.frames[0].file = "frames/000001.exr";
        m.frames[0].truth = "frames/truth.exr";
        writeManifest(m);
        return ShotReader(at.path());
    }();
    return shot;
}
void readFrame(Bytes input) {  // all passes that it offers
    folder().write("frames/000001.exr", input);
    SanitiseCounts counts;
    shotOfOne().read(0, shotOfOne().offered(), &counts);
}
void readTruth(Bytes input) {
    folder().write("frames/truth.exr", input);
    shotOfOne().readTruth(0);
}
void readBlenderFrame(Bytes input) {
    const fs::path file = folder().write("blender.exr", input);
    ImportReport report;
    const ImportPlan plan = planImport(file, {}, report);
    if (takesLong(plan.width, plan.height)) return;
    FrameEntry entry;
    ImportCounts counts;
    importFrame(file, plan, entry, {}, counts);
    BlenderExr whole(file);
    whole.choose(plan.layer, plan.view);
    std::vector<std::string> notes;
    cryptomatteNames(whole, notes);
    headerPitfalls(whole);
}
// By itself and each of its layers by name.
void readExrPicture(Bytes input) {
    const fs::path file = folder().write("picture.exr", input);
    {
        const ExrFile exr(file);
        const auto large = [&](const ExrPart& p) { return isLarge(p, input); };
        if (std::any_of(exr.parts().begin(), exr.parts().end(), large)) return;
        for (const ExrLayer& layer : layersOf(exr)) try {
                chooseLayer(exr, layer.name);
            } catch (const InputError&) {  // two that are called so
            }
    }
    LoadedImage image = readImage(file);
    if (!takesLong(image.shown.width, image.shown.height)) showDisplayWindow(image, file);
}
void readPng(Bytes input) { readImage(folder().write("picture.png", input)); }
void readShotManifest(Bytes input) { parseManifest(asText(input), folder().path() / "shot.json"); }
void readNotes(Bytes input) { readFrameNotes(folder().write("notes.json", input)); }
void readRun(Bytes input) {
    folder().write("results.json", input);
    const RunResults run = readResults(folder().path());
    toJsonText(run);
    toCsvText(run);
}
void readKey(Bytes input) { toJsonText(readSurveyKey(folder().write("survey.key.json", input))); }
// That of one question of each kind.
const SurveyKey& surveyKey() {
    static const SurveyKey key = [] {
        SurveyKey k;
        k.survey = "s1";
        for (const QuestionKind kind : {QuestionKind::rank, QuestionKind::pair, QuestionKind::rating}) {
            SurveyQuestion q;
            q.id = "q" + std::to_string(k.questions.size() + 1);
            q.kind = kind;
            for (const char* code : {"aa", "bb"}) {
                q.pictures.emplace_back();
                q.pictures.back().code = q.pictures.back().method = code;
            }
            k.questions.push_back(q);
        }
        return k;
    }();
    return key;
}
void readSurveyAnswers(Bytes input) {
    const std::string file = folder().write("answers.json", input).string();
    readAnswers({file, file}, surveyKey());  // the second time they are known
}
void readSurveyPage(Bytes input) {
    static const SurveyScores scores = [] {
        SurveyScores s;
        s.key = &surveyKey();
        return s;
    }();
    scoresHtml(scores, asText(input));
}
void readLayout(Bytes input) {
    const fs::path file = folder().write("layout.json", input);
    colourFilesOf(file);
    readEngineLayout(file, kWidth, kHeight);
}
void readAngles(Bytes input) {
    folder().write("angles.json", input);
    anglesForReport(folder().path());
}
void readMethod(Bytes input) {
    const MethodSpec spec = parseMethod(asText(input));
    spec.params();
    spec.folderName();
    withParameters(spec.text, "a=1");
}
void readVaried(Bytes input) {
    SweepOptions o;
    o.methods = {"uncharted"};
    o.vary = {asText(input)};
    o.with = {};
    variantsOf(o);
}
void readQuestion(Bytes input) { wishOf(asText(input)); }

// Chunks are length, name, data, CRC of name and data.
size_t mendPng(uint8_t* bytes, size_t size) {
    constexpr size_t kSignature = 8, kAround = 12;
    const auto big = [&](size_t at) {
        return size_t(bytes[at]) << 24 | size_t(bytes[at + 1]) << 16 | size_t(bytes[at + 2]) << 8 | bytes[at + 3];
    };
    for (size_t at = kSignature; at + kAround <= size;) {
        const size_t length = big(at);
        if (length > size - at - kAround) break;
        const size_t end = at + 8 + length;
        const auto crc = uint32_t(crc32(0, bytes + at + 4, uInt(length + 4)));
        for (size_t i = 0; i < 4; i++) bytes[end + i] = uint8_t(crc >> (24 - 8 * i));
        at = end + 4;
    }
    return size;
}

std::vector<uint8_t> contentOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}
PlaneF ramp(int width, int height, float scale) {
    PlaneF p(width, height);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) p.at(x, y) = scale * float(x + 3 * y);
    return p;
}
Seed written(const char* name, const std::vector<PartSource>& parts) {
    const fs::path file = folder().path() / "seed.exr";
    writeParts(file, parts);
    return {name, contentOf(file)};
}
Seed partsSeed() {
    const PlaneF a = ramp(9, 5, 0.1f), b = ramp(3, 1, 1);
    const PlaneU ids(9, 5, 7);
    return written("parts.exr", {{"one", {{"R", &a}, {"id", &ids}}, {{"aaresolve", 1}}}, {"two", {{"value", &b}}}});
}
Seed pictureSeed() {
    const PlaneF a = ramp(40, 20, 0.1f);  // of several blocks
    return written("zip.exr", {{"", {{"A", &a}, {"R", &a}, {"G", &a}, {"B", &a}}}});
}
// Frames that the program does not write itself: ids stored as numbers, lists of edges, parts that do not fit.
std::vector<Seed> frameSeeds() {
    const PlaneF a = ramp(kWidth, kHeight, 0.1f), ids = ramp(kWidth, kHeight, 1), ends = ramp(5, 1, 1),
                 tall = ramp(3, 2, 1), other = ramp(kWidth + 1, kHeight, 0.1f);
    const PlaneU whole(kWidth, kHeight, 7);
    const auto part = [](const char* name, std::vector<std::string> channels, const PlaneF& plane) {
        PartSource p{name, {}};
        for (const auto& c : channels) p.channels.push_back({c, &plane});
        return p;
    };
    const auto color = part("color", {"R", "G", "B"}, a);
    std::vector<std::string> ofSegments(kSegmentChannels.begin(), kSegmentChannels.end());
    return {
        written("numbers.exr", {color, part("object", {"id"}, ids)}),
        written("bad-fraction.exr", {color, part("object", {"id"}, a)}),
        written("bad-type.exr", {{"color", {{"R", &whole}, {"G", &whole}, {"B", &whole}}}}),
        written("bad-channel.exr", {part("color", {"R", "G"}, a)}),
        written("bad-size.exr", {part("color", {"R", "G", "B"}, other)}),
        written("segments.exr", {color, part("segments", ofSegments, ends)}),
        written("bad-segments.exr", {color, part("segments", ofSegments, tall)}),
    };
}
std::vector<Seed> truthSeeds() {
    const PlaneF a = ramp(kWidth, kHeight, 0.1f), other = ramp(kWidth + 1, kHeight, 0.1f);
    const auto half = [](const char* name, const PlaneF& p) {
        return PartSource{name, {{"R", &p}, {"G", &p}, {"B", &p}}};
    };
    return {written("bad-half.exr", {half("a", a)}), written("bad-size.exr", {half("a", a), half("b", other)})};
}
Seed pngSeed() {
    Rgb picture;
    for (PlaneF& p : picture.c) p = ramp(7, 5, 0.02f);
    return {"rgb8.png", pngBytes(codesOf(picture), 7, 5, {})};
}
}  // namespace

const std::vector<Target>& targets() {
    static const std::vector<Target> all = {
        {"manifest", readShotManifest, true},
        {"notes", readNotes, true},
        {"results", readRun, true},
        {"key", readKey, true},
        {"answers", readSurveyAnswers, true},
        {.name = "page", .read = readSurveyPage, .isText = true, .refuses = false},
        {"layout", readLayout, true},
        {"angles", readAngles, true},
        {"method", readMethod, true},
        {"vary", readVaried, true},
        {"question", readQuestion, true},
        {"parts", readParts},
        {"picture", readExrPicture},
        {"frame", readFrame},
        {"truth", readTruth},
        {"blender", readBlenderFrame},
        {"png", readPng, false, mendPng},
    };
    return all;
}
const Target* find(std::string_view name) {
    for (const Target& t : targets())
        if (t.name == name) return &t;
    return nullptr;
}

bool readOrAbort(const Target& target, Bytes input) {
    std::string said;
    try {
        target.read(input);
        return true;
    } catch (const InputError& e) {
        said = e.what();
    } catch (const UsageError& e) {
        said = e.what();
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%.*s: '%s' would reach the user\n", int(target.name.size()), target.name.data(),
                     e.what());
        std::abort();
    }
    if (!said.empty()) return false;
    std::fprintf(stderr, "%.*s: refused without a word\n", int(target.name.size()), target.name.data());
    std::abort();
}

std::vector<Seed> pictureSeeds(std::string_view target) {
    if (target == "parts") return {partsSeed()};
    if (target == "picture") return {pictureSeed()};
    if (target == "frame") return frameSeeds();
    if (target == "truth") return truthSeeds();
    if (target == "png") return {pngSeed()};
    return {};
}

}  // namespace aa::fuzz
