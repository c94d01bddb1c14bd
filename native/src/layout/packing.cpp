#include "layout/packing.h"

#include <algorithm>

namespace spectral_conformal {

std::size_t n_with_room(const Packing& packing) {
  return static_cast<std::size_t>(std::count(packing.has_room.begin(), packing.has_room.end(), true));
}

}  // namespace spectral_conformal
