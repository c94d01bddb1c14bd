#pragma once

#include <string>
#include <vector>

#include "mesh/charts.h"
#include "spectral_conformal/metric.h"
#include "spectral_conformal/parameterize.h"

namespace spectral_conformal {

/// A digest of 128 bits of everything that determines the map and report of a chart: equal inputs have equal digests.
/// The probability of a collision among a million different charts is 1e-27. positions: (V, 3); metric and pins as for
/// Solver.
std::string describe_chart(const Chart& chart, const Positions& positions, const std::vector<TriangleMetric>& metric,
                           const PatchOptions& patch, const SolveOptions& solve, const Pins& pins);

}  // namespace spectral_conformal
