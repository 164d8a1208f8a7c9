#include "study/gate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>

#include "image/error.h"
#include "image/json_text.h"
#include "image/markup.h"
#include "study/json_number.h"
#include "study/non_finite.h"

namespace aa {
namespace {

// A figure that can be held, whatever part of the results has it.
struct Held {
    std::string name;
    FigureForm form = FigureForm::significant;
    bool higherIsBetter = false;
    std::optional<double> (*overTime)(const TemporalMetrics&) = nullptr;  // null: a figure of the frames
    bool isTime = false;
    bool isRoot = false;  // of a sum of squares, whose decibels count twice
};
// Over the sequence: metrics/temporal.h.
const std::vector<Held>& heldOverTime() {
    static const std::vector<Held> all = {
        {"tPsnr", FigureForm::decibels, true, [](const TemporalMetrics& t) { return t.tPsnr; }},
        {"flickerStatic", FigureForm::significant, false, [](const TemporalMetrics& t) { return t.flickerStatic; },
         false, true},
        {"flickerMoving", FigureForm::significant, false, [](const TemporalMetrics& t) { return t.flickerMoving; },
         false, true},
        {"ghostMse", FigureForm::significant, false, [](const TemporalMetrics& t) { return t.ghostMse; }},
    };
    return all;
}
// MSE and SNR say what PSNR says: they are held where they are named.
bool repeatsPsnr(const Figure& f) { return f.ofSquares && f.name != "psnr"; }
Held heldOf(const Figure& f) {
    return {
        .name = std::string(f.name), .form = f.form, .higherIsBetter = f.higherIsBetter, .isRoot = f.name == "rmse"};
}
Held heldTime() { return {"time", FigureForm::significant, false, nullptr, true}; }

// 0.05 dB is a hundredth of what methods differ by; 2 % of a small figure is its last shown digits.
Tolerance usualTolerance(FigureForm form) {
    if (form == FigureForm::decibels) return {0.05, false};
    if (form == FigureForm::similarity) return {0.0005, false};
    return {0.02, true};
}
std::string number(double v, const char* format = "%.4g") {
    if (const char* word = nonFinite(v)) return word;
    char text[40];
    std::snprintf(text, sizeof text, format, v);
    return text;
}
std::string inUnit(double v, const Held& h) {
    if (h.isTime) return number(v) + " ns/px";
    return h.form == FigureForm::decibels ? number(v, "%.3f") + " dB" : number(v, "%.6g");
}
std::string toleranceInWords(const Tolerance& t, const Held& h) {
    return t.isShare                        ? number(100 * t.value) + " %"
           : h.form == FigureForm::decibels ? number(t.value) + " dB"
                                            : number(t.value);
}
std::vector<Held> allHeld() {
    std::vector<Held> all;
    for (const Metric& metric : metrics())
        for (const Figure& f : metric.figures) all.push_back(heldOf(f));
    all.insert(all.end(), heldOverTime().begin(), heldOverTime().end());
    return all;
}
Held heldByName(const std::string& name) {
    for (const Held& h : allHeld())
        if (h.name == name) return h;
    return heldTime();
}

std::optional<double> valueOf(const MethodResult& m, const Held& h) {
    if (h.isTime) return m.nsPerPixel > 0 ? std::optional(m.nsPerPixel) : std::nullopt;
    if (h.overTime) return m.temporal ? h.overTime(*m.temporal) : std::nullopt;
    return m.pooled ? m.pooled->mean.figure(h.name) : std::nullopt;
}

struct Interval {
    double low = 0, high = 0;
    std::string unit;
};
std::optional<Interval> overParts(const MethodResult& before, const MethodResult& now) {
    if (!comparable(before, now)) return {};
    const auto gain = gainOnThisPicture(before.parts[0], now.parts[0]);
    return gain ? std::optional(Interval{gain->low, gain->high, "dB"}) : std::nullopt;
}
std::optional<Interval> decibelsOverFrames(const std::vector<FrameSum>& before, const std::vector<FrameSum>& now) {
    if (before.size() != now.size()) return {};
    const auto c = compareOverTime(before, now);  // 10 log10(now / before)
    return c ? std::optional(Interval{c->low, c->high, "dB"}) : std::nullopt;
}
std::vector<FrameSum> sumsOf(const MethodResult& m, const Held& h) {
    if (h.name == "ghostMse") return ghostSums(m);
    if (h.name != "tPsnr") return flickerSums(m);
    std::vector<FrameSum> sums;
    for (const FrameResult& f : m.frames)
        if (f.metrics && f.temporal) sums.push_back({f.metrics->mse, 1});
    return sums;
}
std::optional<Interval> overFrames(const MethodResult& before, const MethodResult& now, const Held& h) {
    std::vector<FrameSum> worsening;
    const auto judged = [](const FrameResult& f) { return f.judged && f.metrics; };
    double sum = 0;
    for (size_t i = 0; i < before.frames.size() && i < now.frames.size(); i++) {
        if (!judged(before.frames[i]) || !judged(now.frames[i])) continue;
        const auto a = before.frames[i].metrics->figure(h.name), b = now.frames[i].metrics->figure(h.name);
        if (!a || !b) return {};
        worsening.push_back({h.higherIsBetter ? *a - *b : *b - *a, 1});
        sum += worsening.back().sum;
    }
    const auto half = errorOverTime(worsening);  // only of what got worse
    if (!half) return {};
    const double mean = sum / double(worsening.size());
    return Interval{mean - *half, mean + *half, ""};
}
std::optional<Interval> intervalOf(const MethodResult& before, const MethodResult& now, const Held& h) {
    if (h.isTime) return {};
    if (h.overTime) return decibelsOverFrames(sumsOf(before, h), sumsOf(now, h));
    const Figure* figure = figureByName(h.name);
    if (figure && figure->ofSquares) return overParts(before, now);
    return overFrames(before, now, h);
}

// An interval in the terms in which its row tells the change.
Interval inTermsOf(const GateRow& row, const Held& h, const Interval& i) {
    if (i.unit == "dB" && h.form == FigureForm::decibels && !row.tolerance.isShare) return i;
    const double before = std::abs(*row.before);
    const auto changed = [&](double v) {
        if (i.unit != "dB") return v;
        if (h.form == FigureForm::decibels) return v;
        return before * (std::pow(10, v / (h.isRoot ? 20 : 10)) - 1);
    };
    const double unit = row.tolerance.isShare ? 100 / before : 1;
    return {unit * changed(i.low), unit * changed(i.high), row.tolerance.isShare ? "%" : ""};
}

Verdict judged(GateRow& row, const MethodResult& before, const MethodResult& now, const Held& h,
               const std::function<std::optional<Interval>()>& interval) {
    const double a = *row.before, b = *row.now;
    if (a == b || (std::isnan(a) && std::isnan(b))) return Verdict::same;
    if (std::isnan(a) || std::isnan(b)) {
        row.worsening = NAN;
        return std::isnan(b) ? Verdict::worse : Verdict::better;
    }
    const double change = h.higherIsBetter ? a - b : b - a;  // infinite where one of them is
    row.worsening = !row.tolerance.isShare ? change : a != 0 ? change / std::abs(a) : std::copysign(INFINITY, change);
    if (-row.worsening > row.tolerance.value) return Verdict::better;
    if (!(row.worsening > row.tolerance.value)) return Verdict::within;
    // A machine that was busy for a while lengthens the median; the quickest frame it lengthens less.
    if (h.isTime && !(now.secondsMin > before.secondsMin * (1 + row.tolerance.value))) return Verdict::unresolved;
    if (std::isinf(row.worsening)) return Verdict::worse;
    if (const auto i = interval()) {
        const Interval told = inTermsOf(row, h, *i);
        row.low = told.low, row.high = told.high, row.intervalUnit = told.unit;
        if (!(i->low > 0)) return Verdict::unresolved;
    }
    return Verdict::worse;
}

// What makes two runs incomparable.
void requireComparable(const RunResults& a, const RunResults& b) {
    for (const auto& [run, which] : {std::pair{&a, "the base"}, {&b, "the new run"}})
        if (!run->complete)
            throw InputError(std::string("gate: ") + which + " was " + incompleteInWords(*run) +
                             "; finish it with `run --resume`");
    const auto same = [](const std::string& what, const std::string& before, const std::string& now) {
        if (before != now)
            throw InputError("gate: cannot be compared: " + what + ": before " + before + ", now " + now +
                             "; run both alike");
    };
    const auto size = [](const RunResults& r) { return std::to_string(r.width) + "x" + std::to_string(r.height); };
    if (a.shotHash.empty() || a.shotHash != b.shotHash) same("the shot", "'" + a.shot + "'", "'" + b.shot + "'");
    same("the resolution", size(a), size(b));
    same("the shot", a.isStatic ? "static" : "moving", b.isStatic ? "static" : "moving");
    same("the protocol", "'" + inOneField(a.protocol) + "'", "'" + inOneField(b.protocol) + "'");
    const auto frames = [](const MethodResult& m) {
        std::string list;
        for (const auto& f : m.frames) list += (list.empty() ? "" : ",") + std::to_string(f.frame);
        return list.size() > 60 ? list.substr(0, 60) + "... (" + std::to_string(m.frames.size()) + ")" : list;
    };
    if (!a.methods.empty() && !b.methods.empty()) same("the frames", frames(a.methods[0]), frames(b.methods[0]));
}
void noteDifferences(const RunResults& a, const RunResults& b, bool times, std::vector<std::string>& notes) {
    const auto note = [&](const std::string& what, const std::string& before, const std::string& now) {
        if (before != now) notes.push_back(what + ": before " + before + ", now " + now);
    };
    if (!a.shotHash.empty() && !b.shotHash.empty() && a.shotHash != b.shotHash)
        notes.push_back("the shot '" + b.shot + "' is not the same: its content was " + a.shotHash + " and is " +
                        b.shotHash);
    note("the jitter", a.jitterSequence, b.jitterSequence);
    note("the program", a.programVersion + (a.provenance.commit.empty() ? "" : " (" + a.provenance.commit + ")"),
         b.programVersion + (b.provenance.commit.empty() ? "" : " (" + b.provenance.commit + ")"));
    note("the precision", a.precision, b.precision);
    const auto device = [](const RunResults& r) {
        return r.device && r.device->judged ? r.device->name : "the processor";
    };
    note("what the methods ran on", device(a), device(b));
    note("the truth", std::to_string(a.truthSamplesPerHalf) + " samples per half",
         std::to_string(b.truthSamplesPerHalf) + " samples per half");
    if (times) note("the machine", a.machine, b.machine);
}
std::string inLine(const std::map<std::string, std::string, std::less<>>& parameters,
                   const std::map<std::string, std::string, std::less<>>& other) {
    std::string line;
    for (const auto& [name, value] : parameters)
        if (const auto it = other.find(name); it == other.end() || it->second != value)
            line += (line.empty() ? "" : ",") + name + "=" + value;
    return line.empty() ? "nothing of it" : line;
}
}  // namespace

const char* name(Verdict v) {
    constexpr const char* kNames[] = {"same", "within", "unresolved", "better", "worse", "missing", "added"};
    return kNames[size_t(v)];
}

void addTolerance(GateOptions& options, const std::string& text) {
    const size_t equals = text.find('=');
    const std::string given = text.substr(0, equals), name = given == "ssim" ? "ssimLuma" : given;
    std::vector<std::string> names = {"time"};
    for (const Held& h : allHeld()) names.push_back(h.name);
    if (std::find(names.begin(), names.end(), name) == names.end()) {
        const std::string near = suggestion(name, {names.begin(), names.end()});
        throw UsageError("--tol: unknown figure '" + given + "'" +
                         (near.empty() ? "" : "; did you mean '" + near + "'?") + " (see aaresolve gate --help)");
    }
    char* end = nullptr;
    const char* begin = equals == std::string::npos ? "" : text.c_str() + equals + 1;
    Tolerance t{std::strtod(begin, &end), false};
    const bool share = *end == '%';
    if (end == begin || *(share ? end + 1 : end) || !(t.value >= 0) || std::isinf(t.value))
        throw UsageError("--tol: expected FIGURE=NUMBER or FIGURE=NUMBER% such as psnr=0.1 or flip=5%, found '" + text +
                         "'");
    if (share) t = {t.value / 100, true};
    if (name == "time" && !share) throw UsageError("--tol: a time is held by its share, such as time=50%");
    options.tolerances[name] = t;
}
std::string listOfTolerances() {
    std::string list;
    for (const Held& h : allHeld()) {
        const Figure* f = figureByName(h.name);
        list += "\n  " + h.name + std::string(h.name.size() < 15 ? 15 - h.name.size() : 1, ' ') +
                toleranceInWords(usualTolerance(h.form), h) +
                (f && repeatsPsnr(*f) ? ", only where it is named: PSNR says the same" : "");
    }
    return list + "\n  time           only where it is named, as in time=50%";
}

std::string GateRow::inWords() const {
    const Held h = heldByName(figure);
    if (verdict == Verdict::missing) return (figure.empty() ? "the method" : figure) + " is missing";
    if (verdict == Verdict::added) return (figure.empty() ? "the method" : figure) + " is new";
    std::string s = figure + " " + inUnit(*now, h);
    if (verdict == Verdict::same) return s + ", the same";
    s += ", was " + inUnit(*before, h) + ": ";
    const double by = std::abs(worsening);
    s += (tolerance.isShare                ? number(100 * by) + " %"
          : h.form == FigureForm::decibels ? number(by, "%.3f") + " dB"
                                           : number(by)) +
         (worsening > 0 || std::isnan(worsening) ? " worse" : " better");
    if (low) {
        const std::string unit = intervalUnit.empty() ? "" : " " + intervalUnit;
        s += " (95 %: " + number(*low) + " to " + number(*high) + unit + ")";
    }
    return s + ", tolerance " + toleranceInWords(tolerance, h);
}
size_t GateReport::count(Verdict v) const {
    return size_t(std::count_if(rows.begin(), rows.end(), [&](const GateRow& r) { return r.verdict == v; }));
}

namespace {
// The method under the same text, or else with the same parameters however they were written.
const MethodResult* sameIn(const RunResults& run, const MethodResult& m) {
    if (const auto at = indexOf(run, m.text)) return &run.methods[*at];
    const auto stages = [](const std::string& text) { return text.substr(std::min(text.size(), text.find('+'))); };
    const auto found = std::find_if(run.methods.begin(), run.methods.end(), [&](const MethodResult& other) {
        return other.id == m.id && !m.id.empty() && other.parameters == m.parameters &&
               stages(other.text) == stages(m.text);
    });
    return found == run.methods.end() ? nullptr : &*found;
}
}  // namespace

GateReport gate(const RunResults& base, const RunResults& now, const GateOptions& options) {
    requireComparable(base, now);
    GateReport report;
    report.shot = now.shot;
    const bool times = options.tolerances.contains("time");
    noteDifferences(base, now, times, report.notes);
    std::vector<Held> held;
    std::set<std::string_view> there;
    for (const RunResults* run : {&base, &now})
        for (const Figure* f : figuresIn(*run)) there.insert(f->name);
    for (const Metric& metric : metrics())
        for (const Figure& f : metric.figures)
            if (there.contains(f.name) && (!repeatsPsnr(f) || options.tolerances.contains(f.name)))
                held.push_back(heldOf(f));
    held.insert(held.end(), heldOverTime().begin(), heldOverTime().end());
    if (times) held.push_back(heldTime());

    const Verdict missing = options.allowMissing ? Verdict::within : Verdict::missing;
    for (const MethodResult& before : base.methods) {
        const MethodResult* after = sameIn(now, before);
        if (!after) {
            if (options.allowMissing)
                report.notes.push_back("method " + before.text + " is missing");
            else
                report.rows.push_back({.method = before.text, .figure = "", .verdict = missing});
            continue;
        }
        if (before.parameters != after->parameters)
            report.notes.push_back("method " + before.text + ": its parameters were " +
                                   inLine(before.parameters, after->parameters) + " and are " +
                                   inLine(after->parameters, before.parameters));
        for (const Held& h : held) {
            GateRow row{.method = before.text, .figure = h.name};
            row.before = valueOf(before, h);
            row.now = valueOf(*after, h);
            if (!row.before && !row.now) continue;
            const auto own = options.tolerances.find(h.name);
            row.tolerance = own == options.tolerances.end() ? usualTolerance(h.form) : own->second;
            if (!row.now) {
                if (options.allowMissing) {
                    report.notes.push_back("method " + before.text + ": " + h.name + " is missing");
                    continue;
                }
                row.verdict = Verdict::missing;
            } else if (!row.before) {
                row.verdict = Verdict::added;
            } else {
                row.verdict = judged(row, before, *after, h, [&] { return intervalOf(before, *after, h); });
            }
            row.rerun = rerunLine(now, *after);
            report.rows.push_back(std::move(row));
        }
    }
    for (const MethodResult& m : now.methods)
        if (!sameIn(base, m)) report.rows.push_back({.method = m.text, .figure = "", .verdict = Verdict::added});
    // What holds nothing must not pass.
    if (!base.hasFigures() && report.rows.size() == report.count(Verdict::added))
        throw InputError(
            "gate: the base has no figures, since none of its frames has a ground truth; run a shot with truth");
    return report;
}

std::string toJsonText(const GateReport& report) {
    using json = nlohmann::ordered_json;
    json j = {{"format", "aaresolve-gate"}, {"version", 1}, {"shot", report.shot}, {"passed", report.passed()}};
    j["notes"] = report.notes;
    j["counts"] = json::object();
    for (const Verdict v : {Verdict::worse, Verdict::missing, Verdict::unresolved, Verdict::within, Verdict::same,
                            Verdict::better, Verdict::added})
        j["counts"][name(v)] = report.count(v);
    j["rows"] = json::array();
    for (const GateRow& r : report.rows) {
        json& row = j["rows"].emplace_back(json::object());
        row["method"] = r.method;
        if (!r.figure.empty()) row["figure"] = r.figure;
        row["verdict"] = name(r.verdict);
        if (r.before) row["before"] = jsonNumber(*r.before);
        if (r.now) row["now"] = jsonNumber(*r.now);
        if (r.before && r.now) {
            row["worsening"] = jsonNumber(r.worsening);
            row["tolerance"] = {{"value", r.tolerance.value}, {"share", r.tolerance.isShare}};
        }
        if (r.low)
            row["interval95"] = {{"low", jsonNumber(*r.low)}, {"high", jsonNumber(*r.high)}, {"unit", r.intervalUnit}};
        row["words"] = r.inWords();
        if (!r.rerun.empty()) row["rerun"] = r.rerun;
    }
    return jsonText(j) + "\n";
}

std::string toJunitText(const GateReport& report) {
    const auto fails = [](const GateRow& r) { return r.verdict == Verdict::worse || r.verdict == Verdict::missing; };
    const auto counts = [&](auto first, auto last) {
        return "tests=\"" + std::to_string(last - first) + "\" failures=\"" +
               std::to_string(std::count_if(first, last, fails)) + "\"";
    };
    std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"aaresolve gate\" " +
                      counts(report.rows.begin(), report.rows.end()) + ">\n";
    for (auto first = report.rows.begin(); first != report.rows.end();) {
        const auto last =
            std::find_if(first, report.rows.end(), [&](const GateRow& r) { return r.method != first->method; });
        xml += " <testsuite name=\"" + forMarkup(first->method) + "\" " + counts(first, last) + ">\n";
        for (; first != last; ++first) {
            xml += "  <testcase classname=\"" + forMarkup(report.shot + "." + first->method) + "\" name=\"" +
                   forMarkup(first->figure.empty() ? "method" : first->figure) + "\">";
            if (fails(*first))
                xml += "<failure type=\"" + std::string(name(first->verdict)) + "\" message=\"" +
                       forMarkup(first->inWords()) + "\">" + forMarkup(first->rerun) + "</failure>";
            else
                xml += "<system-out>" + forMarkup(first->inWords()) + "</system-out>";
            xml += "</testcase>\n";
        }
        xml += " </testsuite>\n";
    }
    return xml + "</testsuites>\n";
}

}  // namespace aa
