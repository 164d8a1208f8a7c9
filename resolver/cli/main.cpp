#include <cstdio>
#include "methods/method.h"
int main() { for (auto& m : aa::registry()) std::printf("%s\n", std::string(m.id).c_str()); }
