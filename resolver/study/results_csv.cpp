// results.csv: one line per method and frame, and one per method over all.
#include <cmath>
#include <cstdio>
#include <set>
#include <sstream>

#include "study/non_finite.h"
#include "study/results.h"

namespace aa {
namespace {

std::string csvNumber(double v) {
    if (const char* word = nonFinite(v)) return word;
    char text[40];
    std::snprintf(text, sizeof text, "%.9g", v);
    return text;
}
std::string csvNumber(const std::optional<double>& v) { return v ? csvNumber(*v) : ""; }
std::string csvText(const std::string& s) {
    if (s.find_first_of(",\"\n") == std::string::npos) return s;
    std::string quoted = "\"";
    for (const char c : s) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + '"';
}
}  // namespace

std::vector<const Figure*> figuresIn(const RunResults& run) {
    std::set<std::string_view> present = {"mse", "psnr", "snr"};
    for (const auto& m : run.methods)
        for (const auto& f : m.frames)
            if (f.metrics)
                for (const auto& other : f.metrics->others) present.insert(other.first);
    std::vector<const Figure*> figures;
    for (const Metric& metric : metrics())
        for (const Figure& f : metric.figures)
            if (present.contains(f.name)) figures.push_back(&f);
    return figures;
}

void writeCsv(const RunResults& run, std::ostream& out) {
    const std::string protocol = csvText(inOneField(run.protocol));
    const std::vector<const Figure*> figures = figuresIn(run);
    out << "method,frame";
    for (const Figure* f : figures) out << ',' << f->name;
    if (run.device) out << ",deviceSeconds";
    out << ",seconds,protocol\n";
    const auto line = [&](const std::string& method, const std::string& frame, const FrameMetrics* m, double seconds,
                          std::optional<double> deviceSeconds) {
        out << csvText(method) << ',' << frame;
        for (const Figure* f : figures) out << ',' << csvNumber(m ? m->figure(f->name) : std::nullopt);
        if (run.device) out << ',' << csvNumber(deviceSeconds);
        out << ',' << csvNumber(seconds) << ',' << protocol << '\n';
    };
    for (const auto& m : run.methods) {
        for (const auto& f : m.frames)
            line(m.text, std::to_string(f.frame), f.metrics ? &*f.metrics : nullptr, f.seconds, f.deviceSeconds);
        line(m.text, "pooled", m.pooled ? &m.pooled->mean : nullptr, m.secondsMedian, m.deviceSecondsMedian);
    }
}
std::string toCsvText(const RunResults& run) {
    std::ostringstream out;
    writeCsv(run, out);
    return out.str();
}

}  // namespace aa
