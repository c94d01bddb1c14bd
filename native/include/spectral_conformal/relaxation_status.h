#pragma once

namespace spectral_conformal {

/// How a descent (descent.h) or a relaxation toward an isometry (isometric_relaxation.h) ended.
enum class RelaxationStatus {
  converged,            ///< a step with a fresh factor reduced the energy by less than DescentOptions::tolerance, or
                        ///< the map was enough
  factorization_limit,  ///< DescentOptions::max_factorizations reached: more would lower the energy further
  stalled,              ///< barriers or rounding leave (almost) no step along the gradient
  indefinite_form,      ///< the quadratic form of the direction is not positive definite in double precision
  no_image_area,        ///< no triangle of the given map has image area: the map is returned unchanged
  rejected              ///< the descent added flipped triangles or overflowed: the given map is returned
};

}  // namespace spectral_conformal
