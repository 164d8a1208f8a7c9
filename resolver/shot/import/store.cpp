#include "shot/import/store.h"

#include <cstdio>

#include "image/error.h"
#include "image/folder_claim.h"
#include "image/inputs.h"
#include "image/io.h"
#include "image/json_text.h"

namespace aa {
namespace fs = std::filesystem;
using nlohmann::json;

namespace {
json readJson(const fs::path& file) {
    const auto text = textOf(file);
    try {
        return text ? parseJson(*text, file.string(), "") : json();
    } catch (const InputError&) {
        return json();  // as if it were not there
    }
}
std::string shown(const json& value) { return value.dump(-1, ' ', true, json::error_handler_t::replace); }
// Nothing is there but what an import leaves that ended before its settings were written: a folder .aa, perhaps with
// their temporary file.
bool mayBegin(const fs::path& out) {
    const auto isOurs = [](const std::string& name) { return name == kClaimFile || name == ".aa"; };
    const auto isSettings = [](const std::string& name) { return name.starts_with(".import."); };
    const fs::path own = out / ".aa";
    std::error_code ignored;
    return holdsOnly(out, isOurs) && (!fs::exists(own, ignored) || holdsOnly(own, isSettings));
}
std::string numbered(const std::string& kind, int frame, const char* extension) {
    char text[32];
    std::snprintf(text, sizeof text, "/%06d%s", frame, extension);
    return kind + text;
}
}  // namespace

ImportStore::ImportStore(fs::path out, const json& settings, const std::vector<std::string>& kinds)
    : out_(std::move(out)) {
    std::error_code ignored;
    const fs::path file = out_ / ".aa" / "import.json";
    const bool ours = fs::exists(file, ignored);
    if (!ours && fs::exists(out_, ignored) && (!fs::is_directory(out_, ignored) || !mayBegin(out_)))
        throw UsageError(out_.string() + ": is not empty and holds no import; choose a new folder");
    if (ours) {
        const json then = readJson(file);
        if (!then.is_object())
            throw InputError(file.string() + ": cannot be read; delete the shot's folder and import again");
        for (const auto& [key, value] : settings.items())
            if (then.value(key, json()) != value)
                throw UsageError(out_.string() + ": holds an import with another setting '" + key + "' (" +
                                 shown(then.value(key, json())) + ", now " + shown(value) + "); choose a new folder");
    }
    // The settings first: with them the folder is known for an import, wherever that ends.
    makeWritableFolder(out_);
    makeWritableFolder(file.parent_path());
    if (!ours) writeText(file, jsonText(settings) + "\n");
    for (const auto& kind : kinds) {
        makeWritableFolder(out_ / kind);
        makeWritableFolder(out_ / ".aa" / kind);
    }
}

std::string ImportStore::picture(const std::string& kind, int frame) { return numbered(kind, frame, ".exr"); }
fs::path ImportStore::recordOf(const std::string& kind, int frame) const {
    return out_ / ".aa" / numbered(kind, frame, ".json");
}

std::optional<json> ImportStore::finished(const std::string& kind, int frame, const json& inputs) const {
    const json done = readJson(recordOf(kind, frame));
    std::error_code missing;
    const auto bytes = fs::file_size(out_ / picture(kind, frame), missing);
    if (missing || !done.is_object() || !done.contains("facts") || done.value("inputs", json()) != inputs ||
        done.value("bytes", json()) != bytes)
        return std::nullopt;
    return std::make_optional<json>(done["facts"]);  // json converts to anything, optional<json> too
}

void ImportStore::finish(const std::string& kind, int frame, const json& inputs, const json& facts) const {
    const json record = {{"inputs", inputs}, {"bytes", fs::file_size(out_ / picture(kind, frame))}, {"facts", facts}};
    mayBeReplaced(recordOf(kind, frame));
    writeText(recordOf(kind, frame), jsonText(record, -1) + "\n");
}

json fileIdentity(const fs::path& file) {
    std::error_code ignored;
    return {{"file", file.filename().string()},
            {"bytes", fs::file_size(file, ignored)},
            {"time", fs::last_write_time(file, ignored).time_since_epoch().count()}};
}

}  // namespace aa
