#pragma once

#include <string>
#include <vector>

#include "mesh/charts.h"
#include "spectral_conformal/metric.h"
#include "spectral_conformal/parameterize.h"

namespace spectral_conformal {

/// A digest of 128 bits of all that the map of a chart is made of: charts with the same map and report have the same
/// one. Of a million different charts, two have the same one with a probability of 1e-27. positions (V, 3), metric and
/// pins as Solver takes them.
std::string describe_chart(const Chart& chart, const Positions& positions, const std::vector<TriangleMetric>& metric,
                           const PatchOptions& patch, const SolveOptions& solve, const Pins& pins);

}  // namespace spectral_conformal
