#include "image/own_module.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "image/program_folder.h"

namespace aa {
namespace fs = std::filesystem;

OwnModule::OwnModule(const char* file, const char* variable) {
    std::vector<fs::path> places;
    if (const fs::path folder = programFolder(); !folder.empty())
        places = {folder / file, folder.parent_path() / "lib" / "aaresolve" / file};
    if (const char* named = std::getenv(variable)) places.push_back(named);
    std::error_code ignored;
    const auto found =
        std::find_if(places.begin(), places.end(), [&](const auto& p) { return fs::exists(p, ignored); });
    if (found == places.end()) {
        why_ = "looked for";
        for (const auto& place : places) why_ += (place == places.front() ? " " : ", ") + place.string();
        return;
    }
    library_ = dlopen(found->c_str(), RTLD_NOW | RTLD_LOCAL);
    if (const char* why = library_ ? nullptr : dlerror()) why_ = why;
}

void* OwnModule::symbol(const char* name) {
    if (!library_) return nullptr;
    void* found = dlsym(library_, name);
    if (const char* why = found ? nullptr : dlerror()) why_ = why;
    return found;
}

}  // namespace aa
