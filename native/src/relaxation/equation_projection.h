#pragma once

#include <memory>

#include "linear_algebra/factorization.h"
#include "spectral_conformal/linear_constraints.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The orthogonal projection P (P^T P)^-1 P^T onto the maps x = P w that solve homogeneous linear equations. A descent
/// from a map that meets equations, with gradients and directions so projected, meets them all the way.
class EquationProjection {
 public:
  /// equations: what they hold stays, whatever its value. Throws as Factorization does.
  static EquationProjection of(LinearEquations equations, int n_vertices, FactorizationBackend backend);

  /// z: (V,), a gradient or displacement.
  void apply(ComplexVector& z) const;

 private:
  LinearConstraints constraints_;
  std::unique_ptr<Factorization> factorization_;
};

}  // namespace spectral_conformal
