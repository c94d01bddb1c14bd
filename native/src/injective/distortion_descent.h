#pragma once

#include <vector>

#include "injective/distortion_energy.h"
#include "linear_algebra/factorization.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

struct DescentOptions {
  DistortionMeasure measure = DistortionMeasure::symmetric_dirichlet;
  /// Stop when a step with a fresh factor takes away less than this part of the energy above its least value.
  double tolerance = 1e-2;
  /// Bounds the time: each factorisation, with its steps, takes a few times as long as one of the conformal energy.
  int max_factorizations = 20;
  /// Whether triangles with next to no image area keep their barrier, too, which takes longer but leaves none behind.
  bool keep_all_barriers = false;
};

struct Descent {
  int iterations = 0;      ///< steps taken
  int factorizations = 0;  ///< those repeated because of rounding included
};

/// Minimises a distortion energy. The direction comes from a quadratic form that stands for the Hessian, reweighted
/// like the one of Rabinovich, Poranne, Panozzo and Sorkine-Hornung (Scalable Locally Injective Mappings, 2017), but
/// Hermitian in one complex unknown per vertex; L-BFGS steps (Liu and Nocedal 1989) reuse its factor. No step takes the
/// image area of a triangle that has one: the map moves continuously without a new flip, so that its turning number is
/// kept. Elements without image area are softened and pulled in first, then keep what they gained.
///
/// elements: their weights add up to about 1, their softening is 0 or infinite; triangles connected. z (V,) finite.
/// `fixed` (V,) or empty: vertices that stay. Throws Cancelled, and what Factorization throws.
Descent descend(std::vector<DistortionElement>& elements, const std::vector<char>& fixed, ComplexVector& z,
                FactorizationBackend backend, const DescentOptions& options, const Progress& progress = {});

}  // namespace spectral_conformal
