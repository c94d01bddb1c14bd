#pragma once

#include <memory>

#include "conformal/eigenproblem.h"
#include "parameterization/spectral_problem.h"
#include "parameterization/stopwatch.h"
#include "spectral_conformal/parameterize.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/step.h"

namespace spectral_conformal {

/// A map of a patch, or why there is none.
struct SpectralMap {
  Rejection rejection = Rejection::none;
  ComplexVector whole;    ///< with virtual vertices, up to a similarity; also for Rejection::winding
  ComplexVector z;        ///< (V,) the same map placed (placement.h); empty before placed_map, or if rejected
  double eigenvalue = 0;  ///< in the units of the input
  double residual = 0;    ///< see SolveRecord
  double shift = 0;       ///< s of L + s M
  int solves = 0;         ///< with the factor
  int turning_number = 0;
  int flipped = 0;       ///< triangles, for Rejection::folded
  int attempts = 1;      ///< at the same problem
  int polish_steps = 0;  ///< from the eigenvector to this map

  /// Whether it solves its problem, but was rejected for its shape.
  bool is_misshapen() const { return rejection == Rejection::winding || rejection == Rejection::folded; }
};

/// The parameters of one attempt at an eigenproblem.
struct Attempt {
  double relative_shift;        ///< see ReducedFactor::of
  double least_shift;           ///< where that is larger than eigenvalues to be separated
  EigenproblemOptions options;  ///< the tolerance relative to the requested one
};

/// The problem of a patch: L (Eq. 2 and 3) and B (Eq. 5). Throws InvalidMesh unless has_form.
SpectralProblem spectral_problem(std::shared_ptr<const NormalizedPatch> patch, Weights weights,
                                 BoundaryMeasure boundary, FactorizationBackend backend);

/// Spectral conformal parameterization (Mullen et al. 2008) of a patch, by Method::spectral, fiedler or area, or under
/// linear equations that hold no coordinate. attractors: soft pins. The problem keeps the factor for the next solve,
/// and the map: solves with soft constraints start from it.
SpectralMap spectral_map(SpectralProblem& problem, const SolveOptions& options, const Pins& attractors,
                         const Attempt& attempt, const Progress& progress, Timings& timings);

/// Fixes the similarity that the energy leaves free (placement.h), as the last step, after all that changes the map.
/// Does nothing to a map that is placed or was rejected.
SpectralMap placed_map(const SpectralProblem& problem, SpectralMap map, Timings& timings);

}  // namespace spectral_conformal
