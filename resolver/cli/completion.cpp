#include "cli/completion.h"

#include <algorithm>
#include <cstdio>

#include "cli/cli.h"
#include "image/error.h"
#include "methods/choosing.h"
#include "methods/stage.h"
#include "shot/synth/synth.h"

namespace aa {
namespace {

std::string firstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

const MethodDescriptor* methodCalled(std::string_view id) {
    for (const auto& m : registry())
        if (m.id == id) return &m;
    return nullptr;
}
void addMethods(std::vector<Candidate>& to, const std::string& before, bool withShot) {
    for (const auto& m : registry()) to.push_back({before + std::string(m.id), std::string(m.title)});
    for (const MethodSet& set : methodSets(withShot)) to.push_back({before + set.name, set.meaning});
}
void addParameters(std::vector<Candidate>& to, const std::string& before, std::string_view id) {
    const MethodDescriptor* m = methodCalled(id);
    if (!m) return;
    for (const auto& p : m->params)
        to.push_back(
            {before + std::string(p.name) + "=", std::string(p.help) + "; default " + std::string(p.defaultValue)});
}
void addValues(std::vector<Candidate>& to, const std::string& before, const ParamSpec& p) {
    for (const auto choice : p.choices) to.push_back({before + std::string(choice), std::string(p.help)});
}

// After "fxaa311,uncharted:kmin=0.9,cl": methods, and the parameters of the last one.
std::vector<Candidate> methodCandidates(const std::string& text, bool withShot) {
    std::vector<Candidate> all;
    const size_t last = text.find_last_of(",:+=");
    if (last == std::string::npos) {
        addMethods(all, "", withShot);
        return all;
    }
    const std::string before = text.substr(0, last + 1), head = text.substr(0, last);
    const std::string owner = head.empty() ? "" : splitMethods(head).back();
    const std::string id = owner.substr(0, owner.find_first_of(":+"));
    switch (text[last]) {
        case ',':
            addMethods(all, before, withShot);
            if (owner.find(':') != std::string::npos) addParameters(all, before, id);
            break;
        case ':':
            if (id == "runnable")
                for (const MethodSet& set : methodSets(true)) {
                    if (set.name.starts_with("runnable:")) all.push_back({head + set.name.substr(8), set.meaning});
                }
            else
                addParameters(all, before, owner.substr(owner.find_last_of("=+") + 1));
            break;
        case '+':
            for (const auto& s : stages())
                all.push_back({before + std::string(s.value.name) + "=", std::string(s.value.help)});
            break;
        default: {  // '='
            const size_t begin = owner.find_last_of(":,+");
            if (begin == std::string::npos) break;
            const std::string name = owner.substr(begin + 1);
            for (const auto& s : stages())
                if (owner[begin] == '+' && s.value.name == name) {
                    if (s.valueIsMethod)
                        for (const auto& m : registry())
                            all.push_back({before + std::string(m.id), std::string(m.title)});
                    else
                        addValues(all, before, s.value);
                }
            if (const MethodDescriptor* m = methodCalled(id); m && owner[begin] != '+')
                for (const auto& p : m->params)
                    if (p.name == name) addValues(all, before, p);
        }
    }
    return all;
}

std::vector<Candidate> valueCandidates(const OptionInfo& option, const std::string& text, bool withShot) {
    if (option.type == "METHOD") return methodCandidates(text, withShot);
    std::vector<Candidate> all;
    if (option.type == "SCENE")
        for (const auto& s : synthScenes()) all.push_back({std::string(s.name), std::string(s.meaning)});
    for (const auto& choice : option.choices) all.push_back({choice, firstLine(option.help)});
    return all;
}
const OptionInfo* optionCalled(const CommandInfo& command, const std::string& name) {
    for (const auto& o : command.options)
        if (!o.isArgument && std::find(o.names.begin(), o.names.end(), name) != o.names.end()) return &o;
    return nullptr;
}

std::vector<Candidate> allCandidates(const CommandInfo& program, const std::vector<std::string>& words) {
    const CommandInfo* at = &program;
    const OptionInfo* asking = nullptr;  // the option whose value comes next
    size_t arguments = 0;
    bool isHelp = false;
    for (size_t i = 0; i + 1 < words.size(); i++) {
        const std::string& word = words[i];
        if (asking) {
            asking = nullptr;
        } else if (word.size() > 1 && word[0] == '-') {
            const OptionInfo* o = optionCalled(*at, word);
            if (o && !o->type.empty()) asking = o;
        } else if (at == &program && word == "help") {
            isHelp = true;
        } else if (const CommandInfo* inner = arguments == 0 ? at->find(word) : nullptr) {
            at = inner;
        } else {
            arguments++;
        }
    }
    std::vector<Candidate> all;
    const std::string& text = words.back();
    const bool withShot = std::any_of(at->options.begin(), at->options.end(),
                                      [](const OptionInfo& o) { return o.names[0] == "SHOT" || o.type == "SHOT"; });
    if (asking) return valueCandidates(*asking, text, withShot);
    if (text.starts_with("-")) {
        if (const size_t equals = text.find('='); equals != std::string::npos) {
            const OptionInfo* o = optionCalled(*at, text.substr(0, equals));
            if (!o) return all;
            for (auto& c : valueCandidates(*o, text.substr(equals + 1), withShot))
                all.push_back({text.substr(0, equals + 1) + c.text, c.help});
            return all;
        }
        for (const auto& o : at->options)
            for (const auto& name : o.names)
                if (!o.isArgument) all.push_back({name, firstLine(o.help)});
        return all;
    }
    if (arguments == 0)
        for (const auto& c : at->commands)
            if (!isHelp || c.name != "help") all.push_back({c.name, firstLine(c.help)});
    if (isHelp || !all.empty()) return all;
    size_t place = 0;
    for (const auto& o : at->options)
        if (o.isArgument && (place++ == arguments || o.isRepeatable)) return valueCandidates(o, text, withShot);
    return all;
}

// ---- the shells' scripts: they hand over the words and show what comes back ----
constexpr const char* kBash = R"(# bash completion of aaresolve, printed by `aaresolve completion bash`
_aaresolve() {
    local line=${COMP_LINE:0:COMP_POINT} program=${COMP_WORDS[0]/#\~/$HOME} current cut IFS=$' \t\n'
    local -a typed
    read -ra typed <<<"$line"
    [[ $line == *[[:space:]] ]] && typed+=("")
    current=${typed[${#typed[@]} - 1]}
    IFS=$'\n'
    COMPREPLY=($("$program" completion words -- "${typed[@]:1}" 2>/dev/null | cut -f1))
    # The shell itself takes ':' and '=' for the ends of words and completes what follows them.
    cut=${current%"${current##*[:=]}"}
    [[ $COMP_WORDBREAKS == *:* && -n $cut ]] && COMPREPLY=("${COMPREPLY[@]#"$cut"}")
    [[ ${#COMPREPLY[@]} == 1 && ${COMPREPLY[0]} == *= ]] && compopt -o nospace
}
complete -o bashdefault -o default -F _aaresolve aaresolve
)";
constexpr const char* kZsh = R"(#compdef aaresolve
# zsh completion of aaresolve, printed by `aaresolve completion zsh`
_aaresolve() {
    local line
    local -a lines closed closedShown open openShown
    lines=("${(@f)$("${words[1]/#\~/$HOME}" completion words -- "${(@)words[2,CURRENT-1]}" "$PREFIX" 2>/dev/null)}")
    if [[ -z ${lines[1]} ]]; then
        _files
        return
    fi
    for line in "${lines[@]}"; do
        if [[ ${line%%$'\t'*} == *= ]]; then
            open+=("${line%%$'\t'*}")
            openShown+=("${line/$'\t'/  -- }")
        else
            closed+=("${line%%$'\t'*}")
            closedShown+=("${line/$'\t'/  -- }")
        fi
    done
    (( ${#closed} )) && compadd -l -d closedShown -- "${closed[@]}"
    (( ${#open} )) && compadd -S '' -l -d openShown -- "${open[@]}"
}
if [[ ${funcstack[1]} == _aaresolve ]]; then
    _aaresolve "$@"
else
    compdef _aaresolve aaresolve
fi
)";
constexpr const char* kFish = R"(# fish completion of aaresolve, printed by `aaresolve completion fish`
function __aaresolve_words
    set -l typed (commandline -opc)
    set -l current (commandline -ct)
    $typed[1] completion words -- $typed[2..-1] "$current" 2>/dev/null
end
function __aaresolve_knows
    count (__aaresolve_words) >/dev/null
end
complete -c aaresolve -n __aaresolve_knows -f -a '(__aaresolve_words)'
)";
struct Shell {
    const char *name, *script;
};
constexpr Shell kShells[] = {{"bash", kBash}, {"zsh", kZsh}, {"fish", kFish}};
}  // namespace

std::vector<Candidate> candidatesFor(const CommandInfo& program, const std::vector<std::string>& words) {
    std::vector<Candidate> fitting;
    if (words.empty()) return fitting;
    for (auto& c : allCandidates(program, words))
        if (c.text.starts_with(words.back())) fitting.push_back(std::move(c));
    return fitting;
}

bool answersShell(const CommandLine& line, int argc, char** argv) {
    const std::vector<std::string> words(argv + 1, argv + argc);
    if (words.size() < 3 || words[0] != "completion" || words[1] != "words" || words[2] != "--") return false;
    for (const auto& c : candidatesFor(line.describe(), {words.begin() + 3, words.end()}))
        std::printf("%s\t%s\n", c.text.c_str(), c.help.c_str());
    return true;
}

void addCompletion(CommandLine& line, Context&) {
    auto shell = std::make_shared<std::string>();
    Command c = line.command("completion", "A script with which a shell completes commands, options and methods");
    c.option("SHELL", *shell, "as in: source <(aaresolve completion bash)").required().oneOf({"bash", "zsh", "fish"});
    c.run([shell] {
        for (const Shell& s : kShells)
            if (*shell == s.name) std::fputs(s.script, stdout);
    });
}

}  // namespace aa
