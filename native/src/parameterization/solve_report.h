#pragma once

#include <string>

#include "conformal/conformal_energy.h"
#include "injective/fold_free_map.h"
#include "injective/isometric_relaxation.h"
#include "mesh/charts.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

// What a solve tells of itself: sentences, each with a space behind; "" for nothing to tell.

/// What was done to the chart's faces before it could be solved.
std::string describe_repairs(const Chart& chart, int clamped_triangles);

/// What relaxing a map towards an isometry could not unfold.
std::string describe_relaxation(const IsometricMap& map);

/// What was done to keep a map free of folds, what it cost, and where it was not possible. failure: why there was no
/// map before, or ""; before and after: mean QC; held: whether pins hold vertices.
std::string describe_unfolding(const FoldFreeMap& map, const std::string& failure, double before, double after,
                               int turning_number, bool held);

/// How many triangles shrink so far that the digits of the coordinates z (V,) do not tell their corners apart.
std::string describe_unresolved(const ConformalEnergy& energy, const ComplexVector& z);

}  // namespace spectral_conformal
