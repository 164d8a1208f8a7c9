#include <cstdio>
#include <iostream>

#include "cli/cli.h"
#include "cli/describe.h"

namespace aa {
namespace {

std::string_view name(Space s) { return s == Space::linear ? "linear" : "encoded"; }
std::string_view name(ParamSpec::Type t) {
    switch (t) {
        case ParamSpec::Type::real:
            return "real";
        case ParamSpec::Type::integer:
            return "integer";
        case ParamSpec::Type::choice:
            return "choice";
        case ParamSpec::Type::flag:
            return "flag";
    }
    return "?";
}
std::string range(const ParamSpec& p) {
    char text[64];
    std::string all;
    switch (p.type) {
        case ParamSpec::Type::real:
        case ParamSpec::Type::integer:
            std::snprintf(text, sizeof text, "%g..%g", p.min, p.max);
            return text;
        default:
            for (auto c : p.choices) all += (all.empty() ? "" : "|") + std::string(c);
            return all;
    }
}
std::string passList(PassSet passes) {
    std::string s;
    for (auto n : names(passes)) s += (s.empty() ? "" : " ") + std::string(n);
    return s;
}
void printMethod(const MethodDescriptor& m, bool detail) {
    std::printf("%-18s %-10s %-44s %s\n", std::string(m.id).c_str(), std::string(m.family).c_str(),
                std::string(m.title).c_str(), passList(m.passes).c_str());
    if (!detail) return;
    std::printf("  %s\n  source: %s; input %s, output %s%s\n", std::string(m.summary).c_str(),
                std::string(m.source).c_str(), std::string(name(m.input)).c_str(), std::string(name(m.output)).c_str(),
                m.temporal ? "; keeps history" : "");
    for (const auto& p : m.params)
        std::printf("  %-18s default %-12s %-28s %s [%s]%s%s\n", std::string(p.name).c_str(),
                    std::string(p.defaultValue).c_str(), range(p).c_str(), std::string(p.help).c_str(),
                    std::string(p.source).c_str(), p.onlyWhen.empty() ? "" : "; only when ",
                    std::string(p.onlyWhen).c_str());
}
}  // namespace

nlohmann::ordered_json describe(const MethodDescriptor& m) {
    nlohmann::ordered_json j = {{"id", m.id},
                                {"title", m.title},
                                {"family", m.family},
                                {"summary", m.summary},
                                {"source", m.source},
                                {"passes", names(m.passes)},
                                {"input", name(m.input)},
                                {"output", name(m.output)},
                                {"temporal", m.temporal}};
    j["parameters"] = nlohmann::ordered_json::array();
    for (const auto& p : m.params) {
        nlohmann::ordered_json q = {{"name", p.name}, {"type", name(p.type)}};
        if (p.type == ParamSpec::Type::real || p.type == ParamSpec::Type::integer) {
            q["default"] = std::stod(std::string(p.defaultValue));
            q["min"] = p.min;
            q["max"] = p.max;
        } else {
            q["default"] = p.defaultValue;
            q["choices"] = p.choices;
        }
        q["help"] = p.help;
        q["source"] = p.source;
        if (!p.onlyWhen.empty()) q["onlyWhen"] = p.onlyWhen;
        j["parameters"].push_back(q);
    }
    return j;
}

nlohmann::ordered_json describeRegistry() {
    nlohmann::ordered_json all = {{"version", AA_VERSION}, {"methods", nlohmann::ordered_json::array()}};
    for (const auto& m : registry()) all["methods"].push_back(describe(m));
    return all;
}

void addList(CLI::App& app, Context&) {
    struct Options {
        bool json = false;
        std::vector<std::string> ids;
    };
    auto o = std::make_shared<Options>();
    auto* c = app.add_subcommand("list", "Methods, their passes, parameters and sources");
    c->add_option("METHOD", o->ids, "only these, with their parameters");
    c->add_flag("--json", o->json, "as JSON");
    c->callback([o] {
        if (o->json) {
            nlohmann::ordered_json all = describeRegistry();
            if (!o->ids.empty()) {
                all["methods"] = nlohmann::ordered_json::array();
                for (const auto& id : o->ids) all["methods"].push_back(describe(findMethod(id)));
            }
            std::cout << all.dump(1) << "\n";
            return;
        }
        if (o->ids.empty())
            for (const auto& m : registry()) printMethod(m, false);
        else
            for (const auto& id : o->ids) printMethod(findMethod(id), true);
        if (o->ids.empty())
            std::puts("\n`aaresolve list METHOD` shows its parameters; write them as METHOD:name=value,name=value");
    });
}

void addPlan(CLI::App& app, Context&) {
    struct Options {
        bool json = false;
        std::vector<std::string> methods;
    };
    auto o = std::make_shared<Options>();
    auto* c = app.add_subcommand("plan", "The passes that these methods need");
    c->add_option("METHODS", o->methods, "methods, as for run")->required()->delimiter(' ');
    c->add_flag("--json", o->json, "as JSON");
    c->callback([o] {
        std::vector<MethodSpec> specs;
        for (const auto& m : o->methods) specs.push_back(parseMethod(m));
        const PassSet needed = passesOf(specs);
        if (o->json) {
            nlohmann::ordered_json j = {{"passes", names(needed)}};
            for (const auto& s : specs) j["methods"][s.text] = names(s.passes());
            std::cout << j.dump(1) << "\n";
            return;
        }
        for (const auto& s : specs) std::printf("%-28s %s\n", s.text.c_str(), passList(s.passes()).c_str());
        std::printf("%-28s %s\n", "together", passList(needed).c_str());
    });
}

}  // namespace aa
