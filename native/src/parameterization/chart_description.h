#pragma once

#include <string>
#include <vector>

#include "mesh/charts.h"
#include "spectral_conformal/metric.h"
#include "spectral_conformal/parameterize.h"

namespace spectral_conformal {

/// All that the map of a chart is made of, byte by byte: two charts of the same description have the same map and the
/// same report. positions (V, 3), metric and pins as Solver takes them.
std::string describe_chart(const Chart& chart, const Positions& positions, const std::vector<TriangleMetric>& metric,
                           const PatchOptions& patch, const SolveOptions& solve, const Pins& pins);

}  // namespace spectral_conformal
