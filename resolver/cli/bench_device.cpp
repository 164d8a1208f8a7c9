#include <algorithm>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/bench.h"
#include "gpu/method.h"
#include "image/error.h"
#include "image/json_text.h"
#include "methods/driver.h"
#include "study/megabyte.h"

namespace aa {
namespace {

constexpr int kWarmUp = 12;  // frames: pipelines are made, clocks rise

struct PassCost {
    std::string shader;
    std::vector<double> seconds;
    size_t bytesRead = 0, bytesWritten = 0;
};
struct DeviceRow {
    std::string text;
    int width = 0, height = 0;
    std::vector<PassCost> passes;
    Spread total;  // s per frame
    size_t stateBytes = 0;
    double pixels() const { return double(width) * height; }
    double bytes() const {
        double sum = 0;
        for (const PassCost& p : passes) sum += double(p.bytesRead + p.bytesWritten);
        return sum;
    }
    double bytesPerSecond() const { return bytes() / total.median; }
};

DeviceRow time(const MethodSpec& spec, const Frames& all, gpu::Session& session, int runs) {
    DeviceRow row;
    row.text = spec.text, row.width = all.info.width, row.height = all.info.height;
    const std::vector<Frame>& frames = all.of(spec);
    const auto method = gpu::create(session, spec, all.info);
    auto& form = dynamic_cast<gpu::GpuMethod&>(*method);
    session.forget();
    for (size_t i = 0; i < std::min(frames.size(), size_t(2)); i++) session.share(frames[i]);
    std::vector<double> totals;
    for (int r = 0; r < kWarmUp + runs; r++) {
        Frame const& frame = frames[size_t(r) % std::min(frames.size(), size_t(2))];
        const auto& times = form.run(frame);
        if (times.empty()) throw gpu::DeviceError("--device: " + session.device().info().name + " has no clock");
        if (r < kWarmUp) continue;
        double total = 0;
        row.passes.resize(std::max(row.passes.size(), times.size()));
        for (size_t i = 0; i < times.size(); i++) {
            PassCost& p = row.passes[i];
            p.shader = times[i].shader, p.bytesRead = times[i].bytesRead, p.bytesWritten = times[i].bytesWritten;
            p.seconds.push_back(times[i].seconds);
            total += times[i].seconds;
        }
        totals.push_back(total);
    }
    row.total = spreadOf(totals);
    row.stateBytes = method->stateBytes();
    session.forget();
    return row;
}

void printHead(const gpu::Session& session, const BenchOptions& o) {
    std::printf("%s, %s, %d frames after %d to warm up; bytes: every image that a pass binds, once\n",
                session.device().info().name.c_str(), session.fast() ? "fast" : "exact", o.runs, kWarmUp);
    if (session.device().info().isCpu()) std::puts("software on the processor: these are no card's times");
    std::printf("%-28s %10s %9s %17s %9s %9s %7s %9s  %s\n", "method", "size", "ms", "quartiles", "B/px read",
                "written", "GB/s", "of copy", "state MB");
}
void print(const DeviceRow& r, double copyRate) {
    double read = 0, written = 0;
    for (const PassCost& p : r.passes) read += double(p.bytesRead), written += double(p.bytesWritten);
    char size[32];
    std::snprintf(size, sizeof size, "%dx%d", r.width, r.height);
    std::printf("%-28s %10s %9.4f %8.4f %8.4f %9.1f %9.1f %7.0f %8.0f%%  %.1f\n", r.text.c_str(), size,
                1e3 * r.total.median, 1e3 * r.total.low, 1e3 * r.total.high, read / r.pixels(), written / r.pixels(),
                1e-9 * r.bytesPerSecond(), 100 * r.bytesPerSecond() / copyRate, double(r.stateBytes) / kMegabyte);
    if (r.passes.size() > 1)
        for (const PassCost& p : r.passes)
            std::printf("    %-35s %9.4f\n", p.shader.c_str(), 1e3 * spreadOf(p.seconds).median);
    std::fflush(stdout);
}
nlohmann::ordered_json json(const Spread& s) {
    return {{"medianMs", 1e3 * s.median},
            {"lowQuartileMs", 1e3 * s.low},
            {"highQuartileMs", 1e3 * s.high},
            {"minMs", 1e3 * s.least}};
}
nlohmann::ordered_json json(const DeviceRow& r, double copyRate) {
    nlohmann::ordered_json j = {{"method", r.text}, {"size", {r.width, r.height}}, {"time", json(r.total)}};
    for (const PassCost& p : r.passes)
        j["passes"].push_back({{"shader", p.shader},
                               {"time", json(spreadOf(p.seconds))},
                               {"bytesReadPerPixel", double(p.bytesRead) / r.pixels()},
                               {"bytesWrittenPerPixel", double(p.bytesWritten) / r.pixels()}});
    j["bytesPerSecond"] = r.bytesPerSecond();
    j["shareOfCopy"] = r.bytesPerSecond() / copyRate;
    j["stateBytes"] = r.stateBytes;
    return j;
}
}  // namespace

void benchDevice(const BenchOptions& o, const std::vector<MethodSpec>& methods) {
    if (o.markdown) throw UsageError("--markdown: no effect with --device; tests/gpu/page.py makes docs/gpu.md");
    if (o.everyIsa || o.noError) throw UsageError("--every-isa, --no-error: no effect with --device");
    const auto session = o.work.session();
    const gpu::DeviceInfo& info = session->device().info();
    nlohmann::ordered_json all = {{"device", info.name},   {"deviceKind", info.kind},
                                  {"driver", info.driver}, {"precision", session->fast() ? "fast" : "exact"},
                                  {"frames", o.runs},      {"rows", nlohmann::ordered_json::array()}};
    if (!o.json) printHead(*session, o);
    const MethodSpec copy = parseMethod("noaa");
    std::vector<MethodSpec> both = methods;
    both.push_back(copy);
    for (const auto& size : o.sizes) {
        BenchFrames source{o.shot, o.scene, 0, 0, 2, inputPolicyByName(o.nonFinite)};
        std::tie(source.width, source.height) = sizeOf("--size", size);
        std::optional<Frames> frames;
        double copyRate = 0;  // bytes per second of the shader that copies a picture: what this size can reach
        const auto run = [&](const MethodSpec& spec) {
            framesFor(frames, source, spec, both, o.work.exec());
            return time(spec, *frames, *session, o.runs);
        };
        copyRate = run(copy).bytesPerSecond();
        for (const MethodSpec& spec : methods) {
            const DeviceRow row = run(spec);
            if (!o.json) print(row, copyRate);
            all["rows"].push_back(json(row, copyRate));
        }
        all["copyBytesPerSecond"][size] = copyRate;
        if (!o.shot.empty()) break;
    }
    if (o.json) std::cout << jsonText(all) << "\n";
}

}  // namespace aa
