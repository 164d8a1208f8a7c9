#include "image/plane.h"

template class std::vector<float, aa::PlaneAllocator<float>>;
template class std::vector<uint32_t, aa::PlaneAllocator<uint32_t>>;
template class aa::Plane<float>;
template class aa::Plane<float, 4>;
template class aa::Plane<uint32_t>;
