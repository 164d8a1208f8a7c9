// bin/aaresolve of a bundle: starts libexec/aaresolve with the newer of two libraries, the bundle's and the system's.
//
// The program finds its libraries by its run path, ../lib. Those that a graphics driver loads into the same process as
// well, the C++ runtime and zlib, are not there: an older one of the bundle's would come before the system's, and a
// driver built for the newer one would not load. They lie in lib/unless-newer/NAME.VERSION/, and each such folder is
// added to the search only where the system has none or an older one. Versions are those of the files' names, as
// every Linux distribution keeps them: libstdc++.so.6 is a link to libstdc++.so.6.0.30.
//
// Needs the C library alone (it is built with its own copy of the C++ runtime, of which it uses nothing).
#include <dirent.h>
#include <dlfcn.h>
#include <limits.h>
#include <link.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

constexpr int kUnusable = 3;  // the exit code of bad input

// "libx.so.6.0.30", "libx.so.6.0.9": negative when the first is the older one, by the numbers after ".so.".
int compareVersions(const char* a, const char* b) {
    const auto numbers = [](const char* name) {
        const char* at = std::strstr(name, ".so.");
        return at ? at + 4 : "";
    };
    char *restA = const_cast<char*>(numbers(a)), *restB = const_cast<char*>(numbers(b));
    while (true) {
        const long x = std::strtol(restA, &restA, 10), y = std::strtol(restB, &restB, 10);
        if (x != y) return x < y ? -1 : 1;
        if (*restA != '.' && *restB != '.') return 0;
        restA += *restA == '.';
        restB += *restB == '.';
    }
}

// Whether the system's library of the same ABI is there and not older than `ours`, "libstdc++.so.6.0.30".
bool systemServes(const char* ours) {
    char soname[NAME_MAX + 1];
    std::snprintf(soname, sizeof soname, "%s", ours);
    char* version = std::strstr(soname, ".so.");
    if (!version) return true;
    version += 4;
    version[std::strspn(version, "0123456789")] = '\0';
    void* library = dlopen(soname, RTLD_LAZY | RTLD_LOCAL);
    link_map* map = nullptr;
    char file[PATH_MAX];
    return library && dlinfo(library, RTLD_DI_LINKMAP, &map) == 0 && realpath(map->l_name, file) &&
           compareVersions(std::strrchr(file, '/') + 1, ours) >= 0;
}

// Puts the folders of those libraries before what the environment names; false when that does not fit.
bool addOurs(const char* root) {
    char folder[PATH_MAX], path[4 * PATH_MAX];
    path[0] = '\0';
    std::snprintf(folder, sizeof folder, "%s/lib/unless-newer", root);
    DIR* opened = opendir(folder);
    if (!opened) return true;
    while (const dirent* entry = readdir(opened)) {
        if (entry->d_name[0] == '.' || systemServes(entry->d_name)) continue;
        const size_t used = std::strlen(path);
        std::snprintf(path + used, sizeof path - used, "%s/%s:", folder, entry->d_name);
    }
    closedir(opened);
    const size_t used = std::strlen(path);
    if (used == 0) return true;
    const char* before = std::getenv("LD_LIBRARY_PATH");
    if (before && *before)
        std::snprintf(path + used, sizeof path - used, "%s", before);
    else
        path[used - 1] = '\0';  // a colon at the end would name the current folder
    return std::strlen(path) + 1 < sizeof path && setenv("LD_LIBRARY_PATH", path, 1) == 0;
}

}  // namespace

int main(int, char** argv) {
    char root[PATH_MAX - 64];
    const ssize_t length = readlink("/proc/self/exe", root, sizeof root - 1);
    if (length < 0) {
        std::fprintf(stderr, "error: aaresolve: /proc/self/exe cannot be read; /proc must be mounted\n");
        return kUnusable;
    }
    root[length] = '\0';
    for (int i = 0; i < 2; i++)  // bin/aaresolve
        if (char* slash = std::strrchr(root, '/')) *slash = '\0';
    if (!addOurs(root)) {
        std::fprintf(stderr, "error: aaresolve: %s: the path is too long; put the bundle elsewhere\n", root);
        return kUnusable;
    }
    char program[PATH_MAX];
    std::snprintf(program, sizeof program, "%s/libexec/aaresolve", root);
    execv(program, argv);
    std::fprintf(stderr, "error: %s: cannot be started (%s); unpack the whole bundle again\n", program,
                 std::strerror(errno));
    return kUnusable;
}
