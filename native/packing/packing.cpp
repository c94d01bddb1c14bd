#include "packing/packing.h"

#include <algorithm>

#include "geometry/tolerances.h"

namespace spectral_conformal {

std::size_t n_with_room(const Packing& packing) {
  return static_cast<std::size_t>(std::count(packing.has_room.begin(), packing.has_room.end(), true));
}

bool are_points(double scale) { return scale > 1 / insignificant; }

}  // namespace spectral_conformal
