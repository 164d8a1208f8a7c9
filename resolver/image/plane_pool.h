// Memory of planes: what one plane gives back the next of its size takes. The system would hand out pages one by one
// and clear each of them, which was a seventh of a run's time.
//
// What lies unused is bounded; of it the oldest goes back to the system first.
#pragma once
#include <cstddef>

namespace aa {

inline constexpr size_t kMostUnusedPlaneBytes = size_t(256) << 20;

void* takePlaneMemory(size_t bytes);  // of a cache line's alignment, with any content
void givePlaneMemory(void* memory, size_t bytes);
size_t unusedPlaneBytes();

}  // namespace aa
