// One parameter table per method: it makes the command-line help, the JSON, the add-on's panel, the docs and the sweep.
#pragma once
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "methods/code_place.h"

namespace aa {

struct ParamSpec {
    enum class Type { real, integer, choice, flag };
    std::string_view name;
    Type type = Type::real;
    std::string_view defaultValue;  // as written on the command line
    double min = 0, max = 0;        // inclusive; real and integer
    std::vector<std::string_view> choices;
    std::string_view help;    // one line, with the unit
    std::string_view source;  // where the default comes from
    // "name=value|value": the parameter acts only then, and only while `name` acts itself; setting it otherwise is a
    // usage error. Empty: always.
    std::string_view onlyWhen = {};
};
// NaN where the text is no number.
double numberOf(std::string_view text);
ParamSpec realParam(std::string_view name, std::string_view def, double min, double max, std::string_view help,
                    std::string_view source, std::string_view onlyWhen = {});
ParamSpec intParam(std::string_view name, std::string_view def, int min, int max, std::string_view help,
                   std::string_view source, std::string_view onlyWhen = {});
ParamSpec choiceParam(std::string_view name, std::string_view def, std::vector<std::string_view> choices,
                      std::string_view help, std::string_view source, std::string_view onlyWhen = {});
ParamSpec flagParam(std::string_view name, bool def, std::string_view help, std::string_view source,
                    std::string_view onlyWhen = {});

// The texts of a choice and the values that they stand for, in one place: the parameter is declared from this table and
// read by it, so that neither can fall out of step with the other.
//     constexpr Choice<Box> kBoxes[] = {{"3x3", Box::square}, {"plus", Box::plus}};
//     choiceParam("box", "3x3", kBoxes, "window of the colour box", "[Karis 2014]")
//     const Box box = p.chosen("box", kBoxes);
template <class Value>
struct Choice {
    std::string_view text;
    Value value;
};
template <class Value, size_t n>
std::vector<std::string_view> texts(const Choice<Value> (&table)[n]) {
    std::vector<std::string_view> all;
    for (const auto& c : table) all.push_back(c.text);
    return all;
}
template <class Value, size_t n>
ParamSpec choiceParam(std::string_view name, std::string_view def, const Choice<Value> (&table)[n],
                      std::string_view help, std::string_view source, std::string_view onlyWhen = {}) {
    return choiceParam(name, def, texts(table), help, source, onlyWhen);
}

// Checked values of one method's parameters.
//
// Errors of programming, in every build: a table that contradicts itself, a name that the table does not hold, a name
// of another type. Each is a std::logic_error that names method, parameter and file.
class Params {
  public:
    // Defaults overridden by `given` (name -> text). Throws UsageError: unknown name (with a suggestion), not a number,
    // out of range, unknown choice, no effect in the chosen mode (its own condition fails, or that of the parameter
    // which its condition names).
    Params(std::string_view method, const std::vector<ParamSpec>& table,
           const std::vector<std::pair<std::string, std::string>>& given, CodePlace writtenAt = {});
    double real(std::string_view name, CodePlace at = {}) const;
    float realf(std::string_view name, CodePlace at = {}) const { return float(real(name, at)); }
    int integer(std::string_view name, CodePlace at = {}) const;
    bool flag(std::string_view name, CodePlace at = {}) const;
    const std::string& choice(std::string_view name, CodePlace at = {}) const;
    // What the chosen text stands for. The table may hold more texts than the parameter.
    template <class Value, size_t n>
    const Value& chosen(std::string_view name, const Choice<Value> (&table)[n], CodePlace at = {}) const {
        const std::string& text = choice(name, at);
        for (const auto& c : table)
            if (c.text == text) return c.value;
        noSuchChoice(name, text, at);
    }
    size_t choiceIndex(std::string_view name, CodePlace at = {}) const;  // position in the table's `choices`
    bool isGiven(std::string_view name, CodePlace at = {}) const;  // written by the user, be it the default's value
    const std::map<std::string, std::string, std::less<>>& all() const { return values_; }

  private:
    const ParamSpec& spec(std::string_view name, ParamSpec::Type type, CodePlace at) const;
    const ParamSpec& spec(std::string_view name, CodePlace at) const;
    void checkTable(CodePlace writtenAt) const;
    [[noreturn]] void noSuchChoice(std::string_view name, const std::string& text, CodePlace at) const;
    std::string method_;
    std::vector<ParamSpec> table_;
    std::map<std::string, std::string, std::less<>> values_;
    std::set<std::string, std::less<>> given_;
};

}  // namespace aa
