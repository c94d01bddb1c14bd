#pragma once

#include <memory>
#include <utility>

#include "meshes.h"
#include "parameterization/attempts.h"
#include "parameterization/patch_map.h"

namespace spectral_conformal::test {

// Problems of patches by length, with uniform weights, for the tests of parameterization/.

inline SpectralProblem problem_of(const NormalizedPatch& patch, BoundaryMeasure boundary = BoundaryMeasure::length,
                                  FactorizationBackend backend = FactorizationBackend::automatic) {
  return spectral_problem(std::make_shared<const NormalizedPatch>(patch), Weights::uniform, boundary, backend);
}

inline SpectralProblem problem_of(const Patch& patch, FactorizationBackend backend = FactorizationBackend::automatic) {
  return problem_of(normalized_patch(patch.chart, patch.positions, false), BoundaryMeasure::length, backend);
}

/// The same, ready for the stages of a solve.
inline PreparedPatch prepared(SpectralProblem&& problem) { return {{}, std::move(problem)}; }

}  // namespace spectral_conformal::test
