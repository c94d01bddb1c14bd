#pragma once

#include <vector>

#include "conformal/boundary_form.h"
#include "conformal/conformal_energy.h"
#include "conformal/quotient_form.h"
#include "conformal/reduced_factor.h"
#include "geometry/tolerances.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

struct EigenproblemOptions {
  double tolerance = 1e-8;  ///< bound of the error of z, relative to z, as far as rounding allows
  int max_solves = 1200;    ///< with the factor; bounds the time without convergence
  unsigned start = 0;       ///< 0: a circle along the boundary; otherwise the seed of a pseudo-random start
  /// Whether a factor with a smaller shift may follow: see Eigenvector::is_shift_too_large.
  bool may_lower_shift = false;
};

/// An eigenvector of Eq. 5, up to position and scale.
struct Eigenvector {
  ComplexVector z;    ///< (V,)
  double lambda = 0;  ///< z^H L z / z^H B z
  /// |P^* (L z - lambda B z)|, relative to |z| and the largest diagonal entry of L; `change` for forms other than B^,
  /// whose entries may be many times as large.
  double residual = 0;
  double change = infinity;  ///< the estimated error of z, relative to z
  double change_limit = single_epsilon;
  int solves = 0;  ///< with the factor
  bool converged = false;
  /// Whether the solve ended because the shift is larger than an eigenvalue that the factor should separate from
  /// lambda.
  bool is_shift_too_large = false;
};

/// Approximate eigenvectors of an earlier solve with the same factor: y and K y on the unknowns S (see below), over the
/// numbers over which the problem was linear.
template <class Scalar>
struct RitzBasis {
  Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic> vectors;
  Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic> images;
  std::vector<int> support;
};
struct EarlierBasis {
  RitzBasis<Complex> complex;
  RitzBasis<double> real;
};

/// Starts for solves with soft constraints: solutions of earlier solves with the same factors, or empty.
struct EarlierMaps {
  EarlierBasis free;         ///< of the last one with soft constraints
  EarlierBasis constrained;  ///< of the last one with linear constraints
  ComplexVector z;           ///< the last accepted map without these
};

/// The eigenvector of the smallest positive eigenvalue of Eq. 5, other than translations, on the maps z = P w,
///   P^* L P w = lambda P^* B P w,
/// for any form B, definite or not, with the factor of K = P^* L P + s D, where D is the mass of `mass` (Eq. 7, shifted
/// by the form itself instead of epsilon I, since that keeps the eigenvectors of B = M). Free maps have P = 1. In two
/// steps of one method (ritz_space.h), which grows a space by K^-1 times the residual of its best vector:
///  1. B acts only on the unknowns S that its support depends on, so B z = mu K z, mu > 0 the largest, is solved on
///     these alone, in the inner product of K, by reduced solves: the Lanczos method in a small space that is
///     restarted. It ends early where the shift is larger than eigenvalues that it should separate, as on long strips:
///     every smooth function along them is nearly conformal.
///  2. On whole vectors, with L summed triangle by triangle, which resolves what the factor does not: generalized
///     Davidson method (Morgan and Scott 1986) for B z = mu L z from that vector. It removes the shift and the rounding
///     of the factor, usually by one solve.
/// The numbers are complex or, where equations or the form single out directions, real. Starts from `basis` if that has
/// the same S, otherwise from a circle along the boundary (start_vector.h) and from `earlier`, a map, if it is not
/// empty. `basis` is replaced. Precondition: the factor is factored, and holds no coordinate. Throws Cancelled.
Eigenvector smallest_eigenvector(ReducedFactor& factor, const ConformalEnergy& energy, const QuotientForm& form,
                                 const BoundaryForm& mass, const EigenproblemOptions& options, EarlierBasis& basis,
                                 const ComplexVector& earlier, const Progress& progress);

}  // namespace spectral_conformal
