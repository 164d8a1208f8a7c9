// What an import keeps beside the shot, so that it can go on after an interruption and never touches a foreign folder.
//
//   OUT/.aa/import.json           settings of the import
//   OUT/.aa/KIND/000001.json      record of a finished file OUT/KIND/000001.exr: its inputs, its size, what was found
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace aa {

class ImportStore {
  public:
    // Makes OUT and its folders, or checks that what lies there was imported with the same settings. Throws UsageError
    // (not empty and no import; other settings, the first difference named) and InputError (not writable).
    ImportStore(std::filesystem::path out, const nlohmann::json& settings, const std::vector<std::string>& kinds);

    // "KIND/000001.exr", relative to OUT.
    static std::string picture(const std::string& kind, int frame);
    // What was found when the picture was made; nullopt unless it was made from the same inputs and is whole.
    std::optional<nlohmann::json> finished(const std::string& kind, int frame, const nlohmann::json& inputs) const;
    // Notes a picture as finished.
    void finish(const std::string& kind, int frame, const nlohmann::json& inputs, const nlohmann::json& facts) const;

  private:
    std::filesystem::path recordOf(const std::string& kind, int frame) const;
    std::filesystem::path out_;
};

// What identifies a source file: another size or time means rendered again.
nlohmann::json fileIdentity(const std::filesystem::path& file);

}  // namespace aa
