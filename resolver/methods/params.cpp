#include "methods/params.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "image/error.h"

namespace aa {

ParamSpec realParam(std::string_view name, std::string_view def, double min, double max, std::string_view help,
                    std::string_view source, std::string_view onlyWhen) {
    return {name, ParamSpec::Type::real, def, min, max, {}, help, source, onlyWhen};
}
ParamSpec intParam(std::string_view name, std::string_view def, int min, int max, std::string_view help,
                   std::string_view source, std::string_view onlyWhen) {
    return {name, ParamSpec::Type::integer, def, double(min), double(max), {}, help, source, onlyWhen};
}
ParamSpec choiceParam(std::string_view name, std::string_view def, std::vector<std::string_view> choices,
                      std::string_view help, std::string_view source, std::string_view onlyWhen) {
    return {name, ParamSpec::Type::choice, def, 0, 0, std::move(choices), help, source, onlyWhen};
}
ParamSpec flagParam(std::string_view name, bool def, std::string_view help, std::string_view source,
                    std::string_view onlyWhen) {
    return {name, ParamSpec::Type::flag, def ? "on" : "off", 0, 0, {"on", "off"}, help, source, onlyWhen};
}

namespace {
std::string joined(const std::vector<std::string_view>& words) {
    std::string s;
    for (auto w : words) s += (s.empty() ? "" : ", ") + std::string(w);
    return s;
}
std::string shortest(double v) {
    std::ostringstream s;
    s << v;
    return s.str();
}
std::string didYouMean(std::string_view word, const std::vector<std::string_view>& candidates) {
    const std::string near = suggestion(word, candidates);
    return near.empty() ? "" : "; did you mean '" + near + "'?";
}
double parseNumber(const std::string& where, const ParamSpec& p, const std::string& text) {
    const double v = numberOf(text);
    if (!std::isfinite(v)) throw UsageError(where + ": expected a number, found '" + text + "'");
    if (p.type == ParamSpec::Type::integer && v != std::floor(v))
        throw UsageError(where + ": expected a whole number, found '" + text + "'");
    if (v < p.min || v > p.max)
        throw UsageError(where + ": out of range; expected " + shortest(p.min) + " to " + shortest(p.max) + ", found " +
                         text);
    return v;
}
}  // namespace

double numberOf(std::string_view text) {
    double v = 0;
    const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), v);
    return failed == std::errc{} && end == text.data() + text.size() ? v : NAN;
}

Params::Params(std::string_view method, const std::vector<ParamSpec>& table,
               const std::vector<std::pair<std::string, std::string>>& given, CodePlace writtenAt)
    : method_(method), table_(table) {
    checkTable(writtenAt);
    for (const auto& p : table_) values_[std::string(p.name)] = std::string(p.defaultValue);
    for (const auto& [name, text] : given) {
        const std::string& key = name;  // which a lambda may take
        const std::string where = std::string(method) + ": parameter '" + key + "'";
        const auto p = std::find_if(table_.begin(), table_.end(), [&](const auto& s) { return s.name == key; });
        if (p == table_.end()) {
            std::vector<std::string_view> known;
            for (const auto& s : table_) known.push_back(s.name);
            throw UsageError(where + " does not exist" + didYouMean(key, known) +
                             (known.empty() ? "; this method has no parameters" : " (known: " + joined(known) + ")"));
        }
        if (!given_.insert(key).second) throw UsageError(where + " is given twice; leave one of them out");
        std::string value = text;
        switch (p->type) {
            case ParamSpec::Type::real:
            case ParamSpec::Type::integer:
                parseNumber(where, *p, text);
                break;
            case ParamSpec::Type::flag:
                if (text == "1" || text == "true" || text == "yes") value = "on";
                if (text == "0" || text == "false" || text == "no") value = "off";
                [[fallthrough]];
            case ParamSpec::Type::choice:
                if (std::find(p->choices.begin(), p->choices.end(), value) == p->choices.end())
                    throw UsageError(where + ": expected one of " + joined(p->choices) + ", found '" + text + "'" +
                                     didYouMean(text, p->choices));
        }
        values_[key] = value;
    }
    for (const auto& [key, text] : given) {  // after all are set: does each one act?
        std::string_view name = key;
        for (;;) {  // a condition on a parameter without effect does not hold either
            const auto p = std::find_if(table_.begin(), table_.end(), [&](const auto& s) { return s.name == name; });
            if (p->onlyWhen.empty()) break;
            const size_t eq = p->onlyWhen.find('=');
            name = p->onlyWhen.substr(0, eq);
            const auto& actual = values_.find(name)->second;
            std::istringstream allowed{std::string(p->onlyWhen.substr(eq + 1))};
            bool acts = false;
            for (std::string a; std::getline(allowed, a, '|');) acts = acts || a == actual;
            if (!acts)
                throw UsageError(std::string(method) + ": parameter '" + key + "' has no effect unless " +
                                 std::string(p->onlyWhen) + " (it is '" + actual + "'); leave it out");
        }
    }
}

// ---- errors of programming ------------------------------------------------------------------------------------------
namespace {
std::string_view nameOfType(ParamSpec::Type type) {
    constexpr std::string_view names[] = {"real", "integer", "choice", "flag"};
    return names[size_t(type)];
}
[[noreturn]] void wrong(const std::string& method, std::string_view parameter, CodePlace at, const std::string& what) {
    throw std::logic_error(at.text() + ": method '" + method + "', parameter '" + std::string(parameter) +
                           "': " + what);
}
}  // namespace

void Params::checkTable(CodePlace writtenAt) const {
    const auto named = [&](std::string_view name) {
        return std::find_if(table_.begin(), table_.end(), [&](const auto& s) { return s.name == name; });
    };
    for (auto p = table_.begin(); p != table_.end(); ++p) {
        const auto refuse = [&](const std::string& what) { wrong(method_, p->name, writtenAt, what); };
        if (named(p->name) != p) refuse("declared twice");
        if (!p->choices.empty()) {
            if (std::find(p->choices.begin(), p->choices.end(), p->defaultValue) == p->choices.end())
                refuse("its default '" + std::string(p->defaultValue) + "' is none of its choices " +
                       joined(p->choices));
        } else {
            try {
                parseNumber("its default", *p, std::string(p->defaultValue));
            } catch (const UsageError& e) {
                refuse(e.what());
            }
        }
        if (p->onlyWhen.empty()) continue;
        const size_t eq = p->onlyWhen.find('=');
        const auto other = named(p->onlyWhen.substr(0, eq));
        if (eq == std::string_view::npos || other == table_.end() || other == p)
            refuse("onlyWhen '" + std::string(p->onlyWhen) + "' names no other parameter of the table");
        if (other->choices.empty()) continue;
        // One of them at least: a condition that methods share may name values that only some of them have.
        std::istringstream allowed{std::string(p->onlyWhen.substr(eq + 1))};
        bool possible = false;
        for (std::string value; std::getline(allowed, value, '|');)
            possible =
                possible || std::find(other->choices.begin(), other->choices.end(), value) != other->choices.end();
        if (!possible)
            refuse("onlyWhen '" + std::string(p->onlyWhen) + "' names no value that '" + std::string(other->name) +
                   "' has: " + joined(other->choices));
    }
}

const ParamSpec& Params::spec(std::string_view name, CodePlace at) const {
    std::vector<std::string_view> known;
    for (const auto& p : table_) {
        if (p.name == name) return p;
        known.push_back(p.name);
    }
    wrong(method_, name, at,
          "read here, but not in the table of the method's descriptor" + didYouMean(name, known) +
              (known.empty() ? "" : " (known: " + joined(known) + ")"));
}
const ParamSpec& Params::spec(std::string_view name, ParamSpec::Type type, CodePlace at) const {
    const ParamSpec& p = spec(name, at);
    if (p.type != type)
        wrong(method_, name, at,
              "read here as " + std::string(nameOfType(type)) + ", declared as " + std::string(nameOfType(p.type)));
    return p;
}
void Params::noSuchChoice(std::string_view name, const std::string& text, CodePlace at) const {
    wrong(method_, name, at, "the table of values used here lacks '" + text + "'; declare the parameter from it");
}

double Params::real(std::string_view name, CodePlace at) const {
    spec(name, ParamSpec::Type::real, at);
    return numberOf(values_.find(name)->second);
}
int Params::integer(std::string_view name, CodePlace at) const {
    spec(name, ParamSpec::Type::integer, at);
    return int(numberOf(values_.find(name)->second));
}
bool Params::flag(std::string_view name, CodePlace at) const {
    spec(name, ParamSpec::Type::flag, at);
    return values_.find(name)->second == "on";
}
const std::string& Params::choice(std::string_view name, CodePlace at) const {
    spec(name, ParamSpec::Type::choice, at);
    return values_.find(name)->second;
}
size_t Params::choiceIndex(std::string_view name, CodePlace at) const {
    const auto& choices = spec(name, ParamSpec::Type::choice, at).choices;
    return size_t(std::find(choices.begin(), choices.end(), choice(name, at)) - choices.begin());
}
bool Params::isGiven(std::string_view name, CodePlace at) const {
    spec(name, at);
    return given_.find(name) != given_.end();
}

}  // namespace aa
