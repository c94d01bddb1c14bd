#pragma once

#include <optional>
#include <string>

#include "conformal/conformal_energy.h"
#include "injective/fold_free_map.h"
#include "mesh/charts.h"
#include "parameterization/fallbacks.h"
#include "parameterization/spectral_solver.h"
#include "relaxation/isometric_relaxation.h"
#include "spectral_conformal/errors.h"
#include "spectral_conformal/parameterize.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

// The sentences about a solve, made from its typed outcomes.

/// Why a map was not accepted, and what to do about it. Precondition: it was rejected.
SolveFailure failure_of(const SpectralMap& map, const SolveOptions& options);

// Below: sentences with a space behind each; "" for nothing to report.

/// That the retry at the same problem was needed, or that a map of a method that may wind does.
std::string describe_attempts(const SpectralMap& map, const SolveOptions& options);

/// That a rigidity that was asked for was too much for the patch. asked: empty where it was left to the program.
std::string describe_rigidity(const std::optional<double>& asked, double used);

/// What was solved instead, and why. Precondition: a fallback was taken.
std::string describe_fallback(const FallbackMap& fallback, const SolveFailure& failure);

/// What was done to the chart's faces before it could be solved.
std::string describe_repairs(const Chart& chart, int clamped_triangles);

/// What relaxing a map towards an isometry could not unfold.
std::string describe_relaxation(const IsometricMap& map);

/// That an area blend lowered the spread of scale, `before` to `after` (log2), by less than a fifth of what it asks
/// for, and what ended the relaxation. Spreads below 0.05 (a factor of 1.035 in length) are not worth a word.
std::string describe_blend(double amount, RelaxationStatus relaxation, double before, double after);

/// What was done to keep a map free of folds, what it cost, and where it was not possible. failure: why there was no
/// map before, or ""; before and after: mean QC; held: whether pins hold vertices.
std::string describe_unfolding(const FoldFreeMap& map, const std::string& failure, double before, double after,
                               int turning_number, bool held);

/// How many triangles shrink so far that the digits of the coordinates z (V,) do not tell their corners apart.
std::string describe_unresolved(const ConformalEnergy& energy, const ComplexVector& z);

}  // namespace spectral_conformal
