#include "targets.h"

#include <unistd.h>
#include <zlib.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "image/error.h"
#include "image/exr.h"
#include "image/io.h"
#include "image/png.h"
#include "methods/spec.h"
#include "report/survey_questions.h"
#include "shot/frame_notes.h"
#include "shot/import/frame.h"
#include "shot/import/pitfalls.h"
#include "shot/manifest.h"
#include "shot/reader.h"
#include "study/results.h"
#include "study/survey.h"
#include "study/sweep.h"

namespace aa::fuzz {
namespace fs = std::filesystem;

namespace {
// The size and pattern of fuzz.py's corpus.
constexpr int kWidth = 24, kHeight = 16;

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
std::string textOf(Bytes input) { return {reinterpret_cast<const char*>(input.data()), input.size()}; }

// Every channel of every part, each as what it is stored as.
void readParts(Bytes input) {
    ExrFile file(folder().write("parts.exr", input));
    for (const ExrPart& part : file.parts()) {
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
    if (plan.width > 256 || plan.height > 256) return;  // only slower
    FrameEntry entry;
    ImportCounts counts;
    importFrame(file, plan, entry, {}, counts);
    BlenderExr whole(file);
    whole.choose(plan.layer, plan.view);
    std::vector<std::string> notes;
    cryptomatteNames(whole, notes);
    headerPitfalls(whole);
}
void readPicture(Bytes input) { readImage(folder().write("picture.png", input)); }
void readShotManifest(Bytes input) { parseManifest(textOf(input), folder().path() / "shot.json"); }
void readNotes(Bytes input) { readFrameNotes(folder().write("notes.json", input)); }
void readRun(Bytes input) {
    folder().write("results.json", input);
    const RunResults run = readResults(folder().path());
    toJsonText(run);
    toCsvText(run);
}
void readKey(Bytes input) { toJsonText(readSurveyKey(folder().write("survey.key.json", input))); }
// The key is that of one question of each kind.
void readSurveyAnswers(Bytes input) {
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
    readParticipant(folder().write("answers.json", input), key);
}
void readMethod(Bytes input) {
    const MethodSpec spec = parseMethod(textOf(input));
    spec.params();
    spec.folderName();
    withParameters(spec.text, "a=1");
}
void readVaried(Bytes input) {
    SweepOptions o;
    o.methods = {"uncharted"};
    o.vary = {textOf(input)};
    o.with = {};
    variantsOf(o);
}
void readQuestion(Bytes input) { wishOf(textOf(input)); }

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
Seed partsSeed() {
    const PlaneF a = ramp(9, 5, 0.1f), b = ramp(3, 1, 1);
    const PlaneU ids(9, 5, 7);
    const fs::path file = folder().path() / "seed.exr";
    writeParts(file, {{"one", {{"R", &a}, {"id", &ids}}, {{"aaresolve", 1}}}, {"two", {{"value", &b}}}});
    return {"parts.exr", contentOf(file)};
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
        {"method", readMethod, true},
        {"vary", readVaried, true},
        {"question", readQuestion, true},
        {"parts", readParts},
        {"frame", readFrame},
        {"truth", readTruth},
        {"blender", readBlenderFrame},
        {"png", readPicture, false, mendPng},
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
    if (target == "png") return {pngSeed()};
    return {};
}

}  // namespace aa::fuzz
