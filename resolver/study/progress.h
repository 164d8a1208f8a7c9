// How a long study tells its caller where it is and learns that it should stop. A caller that wants neither passes
// Progress{}.
#pragma once
#include <functional>
#include <string>

namespace aa {

struct Progress {
    std::function<void(const std::string& note)> step = [](const std::string&) {};  // one more step is done
    std::function<bool()> interrupted = [] { return false; };  // asked after every step: finished frames stay valid
};

}  // namespace aa
