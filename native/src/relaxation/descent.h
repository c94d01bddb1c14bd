#pragma once

#include <functional>
#include <vector>

#include "linear_algebra/factorization.h"
#include "relaxation/boundary_barrier.h"
#include "relaxation/distortion_energy.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

struct DescentOptions {
  DistortionMeasure measure = DistortionMeasure::symmetric_dirichlet;
  /// Stop when a step with a fresh factor takes away less than this fraction of the energy above its infimum.
  double tolerance = 1e-2;
  /// Bounds the time: each factorization, with its steps, takes a few times as long as one of the conformal energy.
  int max_factorizations = 20;
  /// Whether triangles with next to no image area keep their barrier, too, which takes longer but leaves none behind.
  bool keep_all_barriers = false;
  /// Asked after every step whether the map is what is sought, which ends the descent. Empty: never.
  std::function<bool(const ComplexVector&)> is_enough = {};
  /// Added to the energy; the boundary does not touch itself then, if it did not before. May be null.
  const BoundaryBarrier* boundary = nullptr;
};

/// Why a descent ended.
enum class DescentStatus {
  enough,               ///< DescentOptions::is_enough
  converged,            ///< a step with a fresh factor took away less than DescentOptions::tolerance
  factorization_limit,  ///< DescentOptions::max_factorizations came first
  stalled,              ///< the gradient promises more, but barriers or rounding leave (almost) no step along it
  indefinite_form       ///< the quadratic form of the direction is not positive definite in double precision
};

struct Descent {
  DescentStatus status = DescentStatus::factorization_limit;  ///< of the round that led to the returned map
  /// Of the given and of the returned map, each with the determinant regularization that its elements had then.
  double energy_before = 0;
  double energy = 0;
  int iterations = 0;      ///< steps taken, those of rejected rounds included
  int factorizations = 0;  ///< those of rejected rounds and those repeated because of rounding included
};

/// Minimizes a distortion energy. The direction comes from a quadratic form that stands for the Hessian, reweighted
/// like the one of Rabinovich, Poranne, Panozzo and Sorkine-Hornung (Scalable Locally Injective Mappings, 2017), but
/// Hermitian in one complex unknown per vertex; L-BFGS steps (Liu and Nocedal 1989) reuse its factor. No step takes the
/// image area of a triangle that has one: the map moves continuously without a new flip, so that its turning number is
/// kept. The determinants of elements without image area are regularized, in up to three rounds of falling
/// regularization; an element that has gained area gets its barrier. A round that leaves no fewer flipped triangles
/// than the one before is rejected: map and regularization return to what they were.
///
/// elements: their weights add up to about 1, their regularization is 0 or infinite; triangles connected. Returned with
/// the regularization of the returned map, whose energy is finite. z (V,) finite. `fixed` (V,) or empty: vertices that
/// stay. Throws Cancelled, and what Factorization throws.
Descent descend(std::vector<DistortionElement>& elements, const std::vector<char>& fixed, ComplexVector& z,
                FactorizationBackend backend, const DescentOptions& options, const Progress& progress = {});

}  // namespace spectral_conformal
