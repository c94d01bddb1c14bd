#pragma once

namespace spectral_conformal {

/// How a relaxation towards an isometry ended (isometric_relaxation.h).
enum class RelaxationStatus {
  converged,            ///< a step with a fresh factor took away less than IsometryOptions::tolerance
  factorization_limit,  ///< IsometryOptions::max_factorizations came first: more of them would lower the energy further
  stalled,              ///< the gradient promises more, but flips or rounding leave (almost) no step along it
  indefinite_form,      ///< the quadratic form of the direction is not positive definite in double precision
  no_image_area,        ///< no triangle of the given map has image area to measure: it is returned as it is
  rejected              ///< the descent left more flipped triangles, or overflowed: the given map is returned
};

}  // namespace spectral_conformal
