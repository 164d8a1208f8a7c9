// One parameter table per method: it makes the command-line help, the JSON, the add-on's panel, the docs and the sweep.
#pragma once
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

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
ParamSpec realParam(std::string_view name, std::string_view def, double min, double max, std::string_view help,
                    std::string_view source, std::string_view onlyWhen = {});
ParamSpec intParam(std::string_view name, std::string_view def, int min, int max, std::string_view help,
                   std::string_view source, std::string_view onlyWhen = {});
ParamSpec choiceParam(std::string_view name, std::string_view def, std::vector<std::string_view> choices,
                      std::string_view help, std::string_view source, std::string_view onlyWhen = {});
ParamSpec flagParam(std::string_view name, bool def, std::string_view help, std::string_view source,
                    std::string_view onlyWhen = {});

// Checked values of one method's parameters.
class Params {
  public:
    // Defaults overridden by `given` (name -> text). Throws UsageError: unknown name (with a suggestion), not a number,
    // out of range, unknown choice, no effect in the chosen mode (its own condition fails, or that of the parameter
    // which its condition names).
    Params(std::string_view method, const std::vector<ParamSpec>& table,
           const std::vector<std::pair<std::string, std::string>>& given);
    double real(std::string_view name) const;
    float realf(std::string_view name) const { return float(real(name)); }
    int integer(std::string_view name) const;
    bool flag(std::string_view name) const;
    const std::string& choice(std::string_view name) const;
    size_t choiceIndex(std::string_view name) const;  // position in the table's `choices`
    bool isGiven(std::string_view name) const;        // written by the user, be it with the default's value
    const std::map<std::string, std::string, std::less<>>& all() const { return values_; }

  private:
    const ParamSpec& spec(std::string_view name, ParamSpec::Type type) const;
    std::vector<ParamSpec> table_;
    std::map<std::string, std::string, std::less<>> values_;
    std::set<std::string, std::less<>> given_;
};

}  // namespace aa
