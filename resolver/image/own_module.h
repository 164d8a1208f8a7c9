// Shared libraries of the program's own, loaded when what they bring is asked for: they draw in others that would cost
// every start its time and memory.
#pragma once
#include <string>

namespace aa {

// Looked for beside the program, in ../lib/aaresolve from there, and at the path that the environment variable names.
class OwnModule {
  public:
    OwnModule(const char* file, const char* variable);
    // Null when there is no module or it lacks the function; whyNot() then says why.
    template <class Function>
    Function function(const char* name) {
        return reinterpret_cast<Function>(symbol(name));
    }
    const std::string& whyNot() const { return why_; }

  private:
    void* symbol(const char* name);
    void* library_ = nullptr;  // stays loaded: its threads may run
    std::string why_;
};

}  // namespace aa
