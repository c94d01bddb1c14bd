#pragma once

#include <complex>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// A similarity of the plane: z -> factor z + offset, or factor conj(z) + offset if it mirrors.
struct PlaneMotion {
  Complex factor = 1;
  bool mirrors = false;
  Complex offset = 0;

  Complex operator()(Complex z) const { return factor * (mirrors ? std::conj(z) : z) + offset; }
};

/// First `inner`, then `outer`.
PlaneMotion composed(const PlaneMotion& outer, const PlaneMotion& inner);

}  // namespace spectral_conformal
