#include <cstdio>

#include "cli/cli.h"
#include "gpu/method.h"
#include "image/error.h"
#include "image/io.h"
#include "methods/choosing.h"
#include "methods/driver.h"
#include "metrics/metrics.h"
#include "study/protocol.h"

namespace aa {
namespace {
struct FilterArguments {
    std::string method, in, out, debugLayers, layer, display = "srgb", nonFinite = "sanitise";
    bool dither = false;
    WorkOptions work;
};
bool isPng(const std::filesystem::path& p) { return p.extension() == ".png" || p.extension() == ".PNG"; }

// One image is a static shot of one unjittered frame.
Frame frameOf(const LoadedImage& image, const DisplayChain& display, const Exec& exec) {
    Frame f;
    f.width = image.rgb.width();
    f.height = image.rgb.height();
    f.reset = true;
    f.passes = Pass::color;
    if (image.space == FileSpace::encoded) {
        f.colorEncoded = image.rgb;
        decode(image.rgb, display, exec, f.colorLinear);
        f.display = display;
    } else {
        f.colorLinear = image.rgb;
        encodeFrame(f, display, exec);
    }
    return f;
}

// A PNG's colours are straight, an EXR's multiplied by alpha: what goes from one to the other would need colours that
// a clear pixel has not.
void requireAlphaKept(const FilterArguments& o, const LoadedImage& image, bool toPng) {
    if (toPng == (image.space == FileSpace::encoded) || image.isOpaque()) return;
    throw InputError(o.in + ": has alpha that is not 1 everywhere, which " +
                     (toPng
                          ? "an EXR's colours are multiplied by and a PNG's are not; write an EXR, or put the picture "
                            "over a background first"
                          : "these files' colours are not multiplied by and an EXR's are; write a PNG, or put the "
                            "picture over a background first"));
}
// Layer, what the policy met, and what a method of displayed colours cuts off. On stdout, each a line.
void sayWhatWasRead(const FilterArguments& o, const MethodSpec& spec, const LoadedImage& image, const Frame& frame,
                    const RunningMethod& running) {
    if (!image.layer.empty()) std::printf("layer '%s' of %s\n", image.layer.c_str(), o.in.c_str());
    if (const std::string found = inWords(image.counts); !found.empty())
        std::printf("%s values in %s: %s\n", o.nonFinite == "raw" ? "left as they are," : "replaced", o.in.c_str(),
                    found.c_str());
    if (const uint64_t broken = nonFiniteValues(running.out))
        std::printf("%llu values of the result are no numbers\n", static_cast<unsigned long long>(broken));
    if (image.space != FileSpace::linear || !spec.readsEncoded()) return;
    const size_t clipped = clippedPixels(frame.colorLinear, frame.display);
    if (clipped > 0)
        std::printf("%s works on displayed colours: %zu pixels brighter than the display's white are cut off at 1\n",
                    std::string(spec.method->id).c_str(), clipped);
}

void filter(const FilterArguments& o) {
    if (splitMethods(o.method).size() > 1 || isMethodSet(o.method))
        throw UsageError("filter: expected one method, found '" + o.method + "'");
    const MethodSpec spec = parseMethod(o.method);
    if (const PassSet missing = spec.passes().without(Pass::color); !missing.empty()) {
        throw UsageError("filter: " + std::string(spec.method->id) + " needs more than one image (" +
                         listOf(missing, ", ") + "); use `aaresolve run` on a shot");
    }
    if (std::filesystem::path(o.out).extension() != ".exr" && !isPng(o.out))
        throw UsageError("filter: expected an output name ending in .png or .exr, found '" + o.out + "'");
    if (o.dither && !isPng(o.out)) throw UsageError("--dither: no effect on an EXR file, which keeps floats");
    const Exec exec = o.work.exec();
    const LoadedImage image = readImage(o.in, {o.layer, inputPolicyByName(o.nonFinite), ColourUse::method});
    const bool toPng = isPng(o.out);
    requireAlphaKept(o, image, toPng);
    const DisplayChain display{.transfer = transferByName(o.display)};
    const Frame frame = frameOf(image, display, exec);
    const ShotInfo info{.width = frame.width, .height = frame.height, .isStatic = true};
    const auto session = o.work.session();
    if (session && !o.debugLayers.empty()) throw UsageError("--debug-layers: the shaders keep none; use --device cpu");
    RunningMethod running(spec, session ? gpu::create(*session, spec, info) : spec.create(info));
    running.method->keepDebugLayers = !o.debugLayers.empty();
    double seconds = 0;
    withThreads(o.work.threads, [&] { seconds = running.resolve(frame, frame.display, exec).wall; });
    const PlaneF* alpha = image.alpha.empty() || toPng != (image.space == FileSpace::encoded) ? nullptr : &image.alpha;
    if (toPng) {
        if (o.dither) dither8(running.changeShown(), frame.number, exec);
        LoadedImage shown{running.shown(), FileSpace::encoded, false, alpha ? *alpha : PlaneF(), image.shown};
        showDisplayWindow(shown, o.in);
        writePng(o.out, shown.rgb, alpha ? &shown.alpha : nullptr);
    } else {
        const Beside beside{alpha, image.allShown() ? std::nullopt : std::optional(image.shown)};
        if (spec.outputSpace() == Space::linear && display.transfer != Transfer::identity) {
            writeExr(o.out, running.out, false, beside);
        } else {
            Rgb linear;
            decode(running.out, display, exec, linear);
            writeExr(o.out, linear, true, beside);
        }
    }
    sayWhatWasRead(o, spec, image, frame, running);
    if (!o.debugLayers.empty()) writeLayers(o.debugLayers, running.method->debugLayers());
    if (running.method->deviceSeconds()) {
        std::printf("%s %dx%d %.4f ms on %s -> %s\n", spec.text.c_str(), frame.width, frame.height,
                    1e3 * *running.method->deviceSeconds(), session->device().info().name.c_str(), o.out.c_str());
        return;
    }
    std::printf("%s %dx%d %.3f ms, the first and only time: `aaresolve bench` measures speed -> %s\n",
                spec.text.c_str(), frame.width, frame.height, seconds * 1e3, o.out.c_str());
}
}  // namespace

void addFilter(CommandLine& line, Context&) {
    auto o = std::make_shared<FilterArguments>();
    Command c = line.command("filter", "One image through one spatial method; PNG = 8-bit sRGB codes, EXR = linear");
    c.option("METHOD", o->method, "for example smaa1x:preset=HIGH").required().typeName("METHOD");
    c.option("IN", o->in, "PNG or EXR").required().typeName("FILE");
    c.option("OUT", o->out, "PNG or EXR").required().typeName("FILE");
    c.option("--debug-layers", o->debugLayers, "also write the method's intermediate images to this EXR")
        .typeName("FILE");
    c.option("--display", o->display,
             "srgb = EXR values are linear light; identity = they are the displayed values, as the codes of a PNG")
        .oneOf({"srgb", "identity"});
    c.flag(
        "--dither", o->dither,
        "codes of a PNG rounded up or down by chance, the same in every run: noise instead of bands on slow gradients");
    c.option("--layer", o->layer, "layer of a multilayer or multi-part EXR; default: the one colour, or Combined");
    addNonFinite(c, o->nonFinite);
    addWorkOptions(c, o->work);
    addDeviceOptions(c, o->work);
    c.run([o] { filter(*o); });
}

}  // namespace aa
