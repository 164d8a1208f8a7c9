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
struct Options {
    std::string method, in, out, debugLayers, display = "srgb";
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

void filter(const Options& o) {
    if (splitMethods(o.method).size() > 1 || isMethodSet(o.method))
        throw UsageError("filter: expected one method, found '" + o.method + "'");
    const MethodSpec spec = parseMethod(o.method);
    if (const PassSet missing = spec.passes().without(Pass::color); !missing.empty()) {
        std::string list;
        for (auto n : names(missing)) list += (list.empty() ? "" : ", ") + std::string(n);
        throw UsageError("filter: " + std::string(spec.method->id) + " needs more than one image (" + list +
                         "); use `aaresolve run` on a shot");
    }
    if (std::filesystem::path(o.out).extension() != ".exr" && !isPng(o.out))
        throw UsageError("filter: expected an output name ending in .png or .exr, found '" + o.out + "'");
    if (o.dither && !isPng(o.out)) throw UsageError("--dither: no effect on an EXR file, which keeps floats");
    const Exec exec = o.work.exec();
    const LoadedImage image = readImage(o.in);
    const DisplayChain display{.transfer = transferByName(o.display)};
    const Frame frame = frameOf(image, display, exec);
    const ShotInfo info{.width = frame.width, .height = frame.height, .isStatic = true};
    const auto session = o.work.session();
    if (session && !o.debugLayers.empty()) throw UsageError("--debug-layers: the shaders keep none; use --device cpu");
    RunningMethod running(spec, session ? gpu::create(*session, spec, info) : spec.create(info));
    running.method->keepDebugLayers = !o.debugLayers.empty();
    double seconds = 0;
    withThreads(o.work.threads, [&] { seconds = running.resolve(frame, frame.display, exec).wall; });
    if (isPng(o.out)) {
        if (o.dither) dither8(running.outEncoded, frame.number, exec);
        writePng(o.out, running.outEncoded);
    } else if (spec.outputSpace() == Space::linear && display.transfer != Transfer::identity) {
        writeExr(o.out, running.out, false);
    } else {
        Rgb linear;
        decode(running.out, display, exec, linear);
        writeExr(o.out, linear, true);
    }
    if (!o.debugLayers.empty()) writeLayers(o.debugLayers, running.method->debugLayers());
    if (running.method->deviceSeconds()) {
        std::printf("%s %dx%d %.4f ms on %s -> %s\n", spec.text.c_str(), frame.width, frame.height,
                    1e3 * *running.method->deviceSeconds(), session->device().info().name.c_str(), o.out.c_str());
        return;
    }
    std::printf("%s %dx%d %.3f ms %.2f ns/px -> %s\n", spec.text.c_str(), frame.width, frame.height, seconds * 1e3,
                seconds * 1e9 / (double(frame.width) * frame.height), o.out.c_str());
}
}  // namespace

void addFilter(CommandLine& line, Context&) {
    auto o = std::make_shared<Options>();
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
    addWorkOptions(c, o->work);
    addDeviceOptions(c, o->work);
    c.run([o] { filter(*o); });
}

}  // namespace aa
