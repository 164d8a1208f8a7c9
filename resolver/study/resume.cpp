#include "study/resume.h"

#include <sys/stat.h>

#include <algorithm>
#include <set>
#include <utility>

#include "image/error.h"
#include "study/external.h"
#include "study/prepare.h"
#include "study/warm_up.h"

namespace aa {
namespace fs = std::filesystem;
namespace {

void requireSame(const RunResults& a, const RunResults& b, const RunOptions& o) {
    const auto same = [&](const std::string& what, const std::string& before, const std::string& now) {
        if (before != now)
            throw InputError((o.out / "results.json").string() + ": cannot go on: " + what + ": before " + before +
                             ", now " + now + "; run as before, or without --resume and --add");
    };
    const auto program = [](const RunResults& r) { return r.programVersion + " " + r.provenance.commit; };
    same("the program", program(a), program(b));
    same("the precision", a.precision, b.precision);
    const auto device = [](const RunResults& r) {
        return r.device ? r.device->name + " " + r.device->precision : "none";
    };
    same("the device", device(a), device(b));
    same("the number of frames", std::to_string(a.framesAsked), std::to_string(b.framesAsked));
    same("the shot's content", a.shotHash, b.shotHash);
    same("the protocol", "'" + inOneField(a.protocol) + "'", "'" + inOneField(b.protocol) + "'");
    same("what is measured and written", "'" + a.asked + "'", "'" + b.asked + "'");
}
const MethodResult* find(const RunResults& run, const std::string& text) {
    const auto i = indexOf(run, text);
    return i ? &run.methods[*i] : nullptr;
}
MethodSpec specOf(const MethodResult& m, const Protocol& protocol) {
    return m.family == kExternalFamily ? externalMethod(m.id, m.source, protocol.display) : parseMethod(m.text);
}
bool hasItsPictures(const MethodResult& m, const fs::path& out) {
    std::error_code ignored;
    return std::all_of(m.frames.begin(), m.frames.end(),
                       [&](const FrameResult& f) { return f.image.empty() || fs::exists(out / f.image, ignored); });
}
bool isPictureName(const std::string& name) {
    const size_t digits = std::min(name.find_first_not_of("0123456789", name.starts_with('-') ? 1 : 0), name.size());
    const std::string end = name.substr(digits);
    return digits >= 6 && (end == ".exr" || end == ".png" || end == ".layers.exr");
}
}  // namespace

Resumption goOnWith(RunResults earlier, const ShotReader& shot, RunOptions& o) {
    Resumption r{std::move(earlier), {}, {}};
    std::vector<MethodSpec> given = o.methods;
    for (const MethodResult& m : r.before.methods) {
        const auto again =
            std::find_if(given.begin(), given.end(), [&](const auto& s) { return s.folderName() == m.folder; });
        r.all.push_back(again == given.end() ? specOf(m, o.protocol) : *again);
        if (again != given.end()) given.erase(again);
    }
    r.all.insert(r.all.end(), given.begin(), given.end());
    o.allMethods = o.methods = r.all;
    requireSame(r.before, describeRun(shot.manifest(), o), o);

    // What the whole set of methods decides for each of them must be what it was when it ran.
    const size_t warmUp = warmUpPasses(o, shot.manifest()) * o.frames.size();
    const bool overTime = planInput(shot, o).overTime;
    std::set<std::string> running;  // and whose peers have to
    const auto isFinished = [&](const MethodSpec& spec) {
        const MethodResult* m = find(r.before, spec.text);
        return m && m->frames.size() == o.frames.size() && hasItsPictures(*m, o.out) &&
               r.before.warmUpFrames == warmUp && (m->temporal.has_value() == overTime || r.before.isReference(*m));
    };
    for (const MethodSpec& spec : r.all)
        if (!isFinished(spec)) running.insert(withoutStages(spec.text));
    o.methods.clear();
    for (const MethodSpec& spec : r.all) {
        const bool isNeeded = !running.empty() && spec.text == o.protocol.reference;
        // Methods that differ in their stages alone share the mask of rejected history.
        if (isNeeded || running.contains(withoutStages(spec.text)))
            o.methods.push_back(spec);
        else
            r.kept.push_back(spec.text);
    }
    for (const MethodSpec& spec : o.methods)
        if (const MethodResult* m = find(r.before, spec.text)) o.known[spec.text] = m->frames;
    return r;
}

void merge(const Resumption& r, RunResults& results, std::vector<TileErrors>& errors) {
    if (results.methods.empty()) results = r.before;  // nothing had to run
    std::vector<MethodResult> methods;
    std::vector<TileErrors> tiles;
    for (const MethodSpec& spec : r.all) {
        const auto ran = std::find_if(results.methods.begin(), results.methods.end(),
                                      [&](const auto& m) { return m.text == spec.text; });
        const bool isKept = std::find(r.kept.begin(), r.kept.end(), spec.text) != r.kept.end();
        if (isKept) {
            methods.push_back(*find(r.before, spec.text));
            tiles.emplace_back();  // its results keep what comparing takes
        } else {
            const auto k = size_t(ran - results.methods.begin());
            methods.push_back(*ran);
            tiles.push_back(k < errors.size() ? errors[k] : TileErrors{});
        }
    }
    results.methods = std::move(methods);
    errors = std::move(tiles);
    results.complete = std::all_of(results.methods.begin(), results.methods.end(),
                                   [&](const auto& m) { return m.frames.size() == results.framesAsked; });
}

namespace {
uint64_t inodeOf(const fs::path& file) {
    struct stat about = {};
    return ::stat(file.c_str(), &about) == 0 ? uint64_t(about.st_ino) : 0;
}
}  // namespace

Earlier::Earlier(const RunOptions& o) {
    std::error_code ignored;
    if (!fs::exists(o.out / "results.json", ignored)) return;
    RunResults before;
    try {
        before = readResults(o.out);
    } catch (const InputError&) {
        return;  // nobody knows what it names
    }
    std::set<std::string> runs, folders = {"truth"};
    for (const MethodSpec& spec : o.every()) runs.insert(spec.folderName());
    if (o.protocol.reference.empty()) runs.insert("truth");
    for (const MethodResult& m : before.methods) {
        if (!runs.contains(m.folder)) methods_.push_back(m.text);
        if (fs::path(m.folder).filename() == m.folder && m.folder != "..") folders.insert(m.folder);
    }
    const auto find = [&](const fs::path& folder, bool stays) {
        for (fs::directory_iterator it(folder, ignored), end; !ignored && it != end; it.increment(ignored))
            if (it->is_regular_file(ignored) && isPictureName(it->path().filename().string()))
                pictures_.emplace_back(it->path(), inodeOf(it->path()));
        ignored.clear();
        if (!stays) emptied_.push_back(folder);
    };
    for (const auto& folder : folders) {
        find(o.out / folder, runs.contains(folder));
        for (const auto& kind : before.maps) find(o.out / "maps" / kind.first / folder, false);
    }
    for (const char* file : {"sheet.png", "report.html", "sweep.html"})
        if (fs::exists(o.out / file, ignored)) files_.emplace_back(file);
}
bool Earlier::mayBeReplacedBy(const RunResults& sofar) const {
    const auto hasPicture = [](const FrameResult& f) { return !f.image.empty(); };
    return isCleared_ || pictures_.empty() ||
           std::any_of(sofar.methods.begin(), sofar.methods.end(), [&](const MethodResult& m) {
               return std::any_of(m.frames.begin(), m.frames.end(), hasPicture);
           });
}
void Earlier::clear() {
    if (std::exchange(isCleared_, true)) return;
    std::error_code ignored;  // a folder in which something else lies stays
    for (const auto& [picture, inode] : pictures_)
        if (inodeOf(picture) == inode) fs::remove(picture, ignored);
    for (const auto& folder : emptied_) fs::remove(folder, ignored);
}
void Earlier::tell(RunResults& results) const {
    results.replacedMethods = methods_;
    results.outdatedFiles = files_;
}

}  // namespace aa
