#include "shot/import/frame.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>

#include "image/error.h"
#include "shot/import/blender_motion.h"
#include "shot/pass_table.h"

namespace aa {
namespace {
constexpr float kUnitTolerance = 2e-3f;  // of a normal's length; half has 1e-3

std::vector<std::variant<PlaneF*, PlaneU*>> planesOf(Rgb& rgb) { return {&rgb.c[0], &rgb.c[1], &rgb.c[2]}; }

bool zeroEverywhere(BlenderExr& file, BlenderPass pass) {
    PlaneF plane;
    file.want(pass, {&plane});
    file.read();
    for (int y = 0; y < plane.height(); y++)
        for (int x = 0; x < plane.width(); x++)
            if (plane.at(x, y) != 0) return false;
    return true;
}

IdSource chooseIds(BlenderExr& file, const ImportOptions& o, ImportReport& report) {
    const bool index = file.has(BlenderPass::objectIndex), crypto = file.has(BlenderPass::cryptoObject);
    if (o.ids == "cryptomatte" && !crypto)
        throw InputError(file.path().string() + ": has no pass CryptoObject00; switch it on (" +
                         std::string(blenderPass(BlenderPass::cryptoObject).whereToSwitchOn) + ") or leave --ids out");
    if (o.ids == "index" && !index)
        throw InputError(file.path().string() + ": has no pass IndexOB; switch it on (" +
                         std::string(blenderPass(BlenderPass::objectIndex).whereToSwitchOn) + ") or leave --ids out");
    if (o.ids == "index" || (o.ids == "auto" && index && !zeroEverywhere(file, BlenderPass::objectIndex)))
        return IdSource::index;
    if (!crypto) {
        if (index)
            report.notes.push_back(
                "the pass index of every object is 0, so there are no ids: give the objects different ones (Object "
                "properties > Relations > Pass Index), or switch on Cryptomatte");
        return IdSource::none;
    }
    report.notes.push_back("ids come from Cryptomatte: instances of one object share their id");
    return IdSource::cryptomatte;
}

// The id pass of the file in ids of the shot.
void takeIds(PlaneF& stored, const ImportPlan& plan, const std::filesystem::path& file, Frame& f,
             ImportCounts& counts) {
    f.objectId = PlaneU(f.width, f.height);
    for (int y = 0; y < f.height; y++)
        for (int x = 0; x < f.width; x++) {
            const float v = stored.at(x, y);
            const bool background = plan.depth && f.depthView.at(x, y) >= kBackgroundFrom;
            uint32_t id = 0;
            if (plan.ids == IdSource::cryptomatte)
                id = std::bit_cast<uint32_t>(v);
            else if (v >= 0 && v < 4294967296.0f && v == float(uint32_t(v)))
                id = uint32_t(v);
            else
                throw InputError(file.string() + ": pass IndexOB, pixel (" + std::to_string(x) + ", " +
                                 std::to_string(y) + "): expected a whole number, found " + std::to_string(v) +
                                 "; render without denoising this pass and with ZIP compression");
            if (background) {
                counts.idOnBackground += id != 0;
                id = 0;
            } else if (id == 0 && plan.depth) {
                counts.noIndex++;
                id = kNoPassIndex;
            }
            f.objectId.at(x, y) = id;
        }
}

// Where several samples of a pixel hit several surfaces, Cycles delivers the mean of their normals.
void finishNormals(Frame& f, bool hasDepth, ImportCounts& counts) {
    auto& n = f.normalWorld.c;
    for (int y = 0; y < f.height; y++)
        for (int x = 0; x < f.width; x++) {
            const double a = n[0].at(x, y), b = n[1].at(x, y), c = n[2].at(x, y),
                         length = std::sqrt(a * a + b * b + c * c);
            const bool background = hasDepth && f.depthView.at(x, y) >= kBackgroundFrom;
            if (background ? length == 0 : !(std::abs(length - 1) > kUnitTolerance) || length == 0) continue;
            n[0].at(x, y) = background ? 0 : float(a / length);
            n[1].at(x, y) = background ? 0 : float(b / length);
            n[2].at(x, y) = background ? 0 : float(c / length);
            counts.normalised++;
        }
}
}  // namespace

PassSet ImportPlan::passes() const {
    PassSet r = Pass::color;
    if (albedo) r |= Pass::albedo;
    if (depth) r |= Pass::depth;
    if (normal) r |= Pass::normal;
    if (ids != IdSource::none) r |= Pass::object;
    if (vector) r |= Pass::motion;
    return r;
}

ImportPlan planImport(const std::filesystem::path& firstFile, const ImportOptions& o, ImportReport& report) {
    BlenderExr file(firstFile);
    file.choose(o.viewLayer, o.view);
    ImportPlan plan{file.layer(), file.view(), file.width(), file.height()};
    if (!file.has(BlenderPass::combined))
        throw InputError(firstFile.string() + ": view layer '" + plan.layer +
                         "' has no pass Combined; switch it on and render again");
    plan.depth = file.has(BlenderPass::depth);
    plan.normal = file.has(BlenderPass::normal);
    plan.vector = file.has(BlenderPass::vector);
    const bool denoising = file.has(BlenderPass::denoisingAlbedo), diffuse = file.has(BlenderPass::diffuseColor);
    plan.albedo = denoising || diffuse;
    plan.ids = chooseIds(file, o, report);
    const auto miss = [&](Pass pass, bool there, BlenderPass from) {
        if (!there) report.missing.push_back({pass, "switch on " + std::string(blenderPass(from).whereToSwitchOn)});
    };
    miss(Pass::albedo, plan.albedo, BlenderPass::denoisingAlbedo);
    miss(Pass::depth, plan.depth, BlenderPass::depth);
    miss(Pass::normal, plan.normal, BlenderPass::normal);
    miss(Pass::object, plan.ids != IdSource::none, BlenderPass::objectIndex);
    miss(Pass::motion, plan.vector, BlenderPass::vector);
    const PassSet rendered = Pass::color | Pass::albedo | Pass::depth | Pass::normal | Pass::object | Pass::motion;
    for (const auto& info : allPasses())
        if (!rendered.has(info.pass)) report.missing.push_back({info.pass, "only the AA Resolve add-on exports it"});
    if (plan.albedo && !denoising)
        report.notes.push_back("no Denoising Albedo: the albedo is Diffuse Color, which is black on metals");
    if (denoising && !file.has(BlenderPass::emission))
        report.notes.push_back("no Emission pass: emission stays in the albedo");
    if (plan.ids != IdSource::none && !plan.depth)
        report.notes.push_back("no depth: an id of 0 may be background or an object without a pass index");
    return plan;
}

Frame importFrame(const std::filesystem::path& path, const ImportPlan& plan, const FrameEntry& entry,
                  const std::optional<Camera>& before, ImportCounts& counts) {
    BlenderExr file(path);
    file.choose(plan.layer, plan.view);
    if (file.width() != plan.width || file.height() != plan.height)
        throw InputError(path.string() + ": expected " + std::to_string(plan.width) + "x" +
                         std::to_string(plan.height) + " pixels as in the first frame, found " +
                         std::to_string(file.width()) + "x" + std::to_string(file.height()) +
                         "; render the frame again");
    Frame f;
    f.number = entry.frame;
    f.width = plan.width;
    f.height = plan.height;
    f.passes = plan.passes();
    f.jitterPx = entry.jitterPx;
    f.camera = entry.camera;
    PlaneF ids;
    AlbedoPasses albedo;
    const auto wantRgb = [&](BlenderPass pass, Rgb& to) {
        if (file.has(pass)) file.want(pass, planesOf(to));
    };
    file.want(BlenderPass::combined, planesOf(f.colorLinear));
    if (plan.depth) file.want(BlenderPass::depth, {&f.depthView});
    if (plan.normal) file.want(BlenderPass::normal, planesOf(f.normalWorld));
    if (plan.vector) file.want(BlenderPass::vector, {&f.motionXPx, &f.motionYPx});
    if (plan.ids == IdSource::index) file.want(BlenderPass::objectIndex, {&ids});
    if (plan.ids == IdSource::cryptomatte) file.want(BlenderPass::cryptoObject, {&ids});
    if (plan.albedo) {
        wantRgb(BlenderPass::denoisingAlbedo, albedo.denoising);
        wantRgb(BlenderPass::emission, albedo.emission);
        wantRgb(BlenderPass::diffuseColor, albedo.diffuse);
        wantRgb(BlenderPass::glossyColor, albedo.glossy);
        wantRgb(BlenderPass::transmissionColor, albedo.transmission);
        wantRgb(BlenderPass::environment, albedo.environment);
    }
    file.read();
    if (plan.depth)
        for (int y = 0; y < f.height; y++)
            for (int x = 0; x < f.width; x++)
                if (f.depthView.at(x, y) >= kBackgroundFrom) f.depthView.at(x, y) = kBackgroundDepth;
    if (plan.ids != IdSource::none) takeIds(ids, plan, path, f, counts);
    if (plan.normal) finishNormals(f, plan.depth, counts);
    if (plan.vector) motionFromVector(f.motionXPx, f.motionYPx, f.depthView, entry.jitterPx, entry.camera, before);
    if (plan.albedo) f.albedoLinear = unlitAlbedo(albedo, f.depthView, f.colorLinear);
    return f;
}

// The denoising albedo less the emission that it contains. The sum of the colour passes is no albedo (a Principled
// shader's glossy colour is white); it only serves where the denoising albedo is empty although a surface was hit
// (mirrors and clear glass). What only emits keeps its emission as its colour (the exporter's rendering.py).
Rgb unlitAlbedo(const AlbedoPasses& p, const PlaneF& depthView, const Rgb& combined) {
    constexpr float kReflects = 1e-5f;
    const int w = combined.width(), h = combined.height();
    const auto at = [](const Rgb& rgb, size_t c, int x, int y) { return rgb.empty() ? 0.0f : rgb.c[c].at(x, y); };
    const Rgb& base = p.denoising.empty() ? p.diffuse : p.denoising;
    const bool emissionInside = !p.denoising.empty();
    Rgb r(w, h);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            const bool background = !depthView.empty() && depthView.at(x, y) >= kBackgroundFrom;
            float colour[3], most = 0, left[3];
            for (size_t c = 0; c < 3; c++) {
                left[c] = std::max(at(base, c, x, y) - (emissionInside ? at(p.emission, c, x, y) : 0.0f), 0.0f);
                most = std::max(most, left[c]);
            }
            float strongest = 0;
            for (size_t c = 0; c < 3; c++) {
                colour[c] = most > kReflects ? left[c] : at(p.emission, c, x, y);
                strongest = std::max(strongest, colour[c]);
            }
            for (size_t c = 0; c < 3; c++) {
                if (background)
                    colour[c] = p.environment.empty() ? combined.c[c].at(x, y) : p.environment.c[c].at(x, y);
                else if (!(strongest > 0))
                    colour[c] =
                        std::min(1.0f, at(p.diffuse, c, x, y) + at(p.transmission, c, x, y) + at(p.glossy, c, x, y));
                r.c[c].at(x, y) = colour[c];
            }
        }
    return r;
}

namespace {
std::optional<uint32_t> hashOf(std::string_view text) {
    uint32_t id = 0;
    const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), id, 16);
    if (failed != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return id;
}
// A list that is no JSON, because a name with a quote was written as it is: NAME":"8 digits", up to the next ,".
std::map<uint32_t, std::string> namesOfBrokenList(const std::string& list) {
    constexpr std::string_view kBetween = "\":\"";
    constexpr size_t kDigits = 8;
    std::map<uint32_t, std::string> names;
    size_t start = list.find('"');
    for (size_t at = list.find(kBetween); at != std::string::npos && start != std::string::npos;
         at = list.find(kBetween, at + 1)) {
        const size_t digits = at + kBetween.size(), end = digits + kDigits;
        const auto id = end < list.size() && list[end] == '"' ? hashOf(std::string_view(list).substr(digits, kDigits))
                                                              : std::nullopt;
        if (!id || start >= at) continue;
        names[*id] = list.substr(start + 1, at - start - 1);
        start = list.find('"', end + 1);
    }
    return names;
}
}  // namespace

std::map<uint32_t, std::string> cryptomatteNames(const BlenderExr& file, std::vector<std::string>& notes) {
    std::map<uint32_t, std::string> names;
    for (const auto& part : file.file().parts())
        for (const auto& [key, value] : part.texts) {
            if (!key.starts_with("cryptomatte/") || !key.ends_with("/name") || !value.ends_with("CryptoObject"))
                continue;
            const auto manifest = part.texts.find(key.substr(0, key.size() - 4) + "manifest");
            if (manifest == part.texts.end()) continue;
            const auto j = nlohmann::json::parse(manifest->second, nullptr, false);
            if (!j.is_object()) {
                names.merge(namesOfBrokenList(manifest->second));
                notes.push_back(
                    "Cryptomatte's list of names is no JSON (Blender writes a quote or a backslash in an "
                    "object's name as it is): " +
                    std::to_string(names.size()) + " names were read from it all the same");
                continue;
            }
            for (const auto& [name, hash] : j.items())
                if (const auto id = hash.is_string() ? hashOf(hash.get<std::string>()) : std::nullopt)
                    names[*id] = name;
        }
    return names;
}

}  // namespace aa
