#include "report/format.h"

#include <cmath>
#include <cstdio>

#include "study/non_finite.h"

namespace aa {
namespace {
std::string printed(const char* format, double v) {
    if (const char* word = nonFinite(v)) return word;
    char text[64];
    std::snprintf(text, sizeof text, format, v);
    return text;
}
}  // namespace

std::string significant(double v, int digits) {
    char format[8];
    std::snprintf(format, sizeof format, "%%.%dg", digits);
    return printed(format, v);
}
std::string shortNumber(double v) {
    const double a = std::abs(v);
    return a >= 1000 && a < 1e7 ? printed("%.0f", v) : printed("%.3g", v);
}
std::string decibelNumber(double v) { return printed("%.2f", v); }
std::string signedDecibelNumber(double v) { return printed("%+.2f", v); }
std::string decibels(double v) { return decibelNumber(v) + " dB"; }
std::string similarity(double v) { return printed("%.6f", v); }

const char* name(FigureForm form) {
    constexpr const char* kNames[] = {"significant", "decibels", "similarity", "jod"};
    return kNames[size_t(form)];
}
std::string shown(const Figure& figure, double v) {
    switch (figure.form) {
        case FigureForm::decibels:
            return decibels(v);
        case FigureForm::similarity:
            return similarity(v);
        case FigureForm::jod:
            return printed("%.3f", v);
        case FigureForm::significant:
            break;
    }
    return significant(v);
}

std::string runLine(const RunResults& run) {
    const std::string incomplete = incompleteInWords(run);
    std::string line = (incomplete.empty() ? "" : incomplete + "; ") + std::to_string(run.width) + " x " +
                       std::to_string(run.height) + (run.isStatic ? ", static" : ", moving");
    if (run.jitterSequence == "none" || run.jitterPeriod <= 1)
        line += "; no jitter";
    else
        line += "; jitter " + run.jitterSequence + ", period " + std::to_string(run.jitterPeriod) +
                (run.jitterCentred() ? ", centred"
                                     : ", block mean (" + printed("%.4f", run.jitterMeanPx[0]) + ", " +
                                           printed("%.4f", run.jitterMeanPx[1]) + ") px");
    line += "; " + run.machine + ", " + run.isa + ", " + std::to_string(run.threads) +
            (run.threads == 1 ? " thread" : " threads");
    if (run.precision != "fast") line += ", precision " + run.precision;
    if (run.device)
        line += std::string("; ") + (run.device->judged ? "methods" : "times beside") + " on " + run.device->name +
                (run.device->isSoftware() ? " (software)" : "") + ", " + run.device->precision;
    return line;
}

std::string intervalInWords(double lowDb, double highDb) {
    const bool low = std::isfinite(lowDb), high = std::isfinite(highDb);
    if (low && high) return signedDecibelNumber(lowDb) + " to " + signedDecibelNumber(highDb);
    if (low) return "above " + signedDecibelNumber(lowDb);
    if (high) return "below " + signedDecibelNumber(highDb);
    return "no interval";
}
std::string intervalInBrackets(double lowDb, double highDb) {
    const bool known = std::isfinite(lowDb) || std::isfinite(highDb);
    return (known ? "(95 %: " : "(") + intervalInWords(lowDb, highDb) + ")";
}
std::string intervalInWords(const Comparison& c) { return intervalInWords(c.gainLow, c.gainHigh); }
std::string intervalInBrackets(const Comparison& c) { return intervalInBrackets(c.gainLow, c.gainHigh); }

std::string busyInWords(const RunResults& run) {
    if (!run.load || !run.load->busy()) return {};
    std::string s = "The machine was busy";
    if (run.load->before > 0.5 * run.load->processors)
        s += ": " + printed("%.1f", run.load->before) + " programs wanted its " + std::to_string(run.load->processors) +
             (run.load->processors == 1 ? " processor" : " processors") + " before the run";
    if (run.load->waited.value_or(0) > 0.1)
        s += (s.back() == 'y' ? ": " : ", and ") + std::string("the methods waited for one ") +
             printed("%.0f", 100 * *run.load->waited) + " % of the time";
    return s +
           ". Times are of the processor, yet caches and clock rates are shared: compare them within this run alone.";
}
std::string leftOutInWords(const RunResults& run) {
    if (run.leftOut.empty()) return {};
    std::string names;
    for (const auto& [name, seconds] : run.leftOut) names += (names.empty() ? "" : ",") + name;
    return "Left out, since measuring would have taken about " + printed("%.0f", run.leftOut.begin()->second) +
           " s: " + names + ". Ask for them by --metrics " + names + ".";
}

std::string enumerated(std::vector<std::string> parts, size_t most) {
    if (parts.size() > most) {
        const size_t more = parts.size() - most;
        parts.resize(most);
        parts.push_back(std::to_string(more) + " more");
    }
    std::string all;
    for (size_t i = 0; i < parts.size(); i++) all += (i == 0 ? "" : i + 1 == parts.size() ? " and " : ", ") + parts[i];
    return all;
}

}  // namespace aa
