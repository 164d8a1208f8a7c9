// Memory of planes: what one plane gives back the next of its size takes. The system would hand out pages one by one
// and clear each of them, which was a seventh of a run's time.
//
// What lies unused is bounded: as much as is in use, or a small share of any machine, whichever is more. What one frame
// of a run gives back, the next will take. With what is in use it is no more than was in use at one time or that share:
// where a plane finds none of its size, others give it their pages and make room, the oldest first.
#pragma once
#include <cstddef>

namespace aa {

inline constexpr size_t kUnusedPlaneBytes = size_t(256) << 20;  // that may lie unused whatever is in use

void* takePlaneMemory(size_t bytes);  // of a cache line's alignment, with any content
void givePlaneMemory(void* memory, size_t bytes);
struct PlaneBytes {
    size_t used = 0, unused = 0;
    size_t most = 0;  // in use at one time
};
PlaneBytes planeBytes();

}  // namespace aa
