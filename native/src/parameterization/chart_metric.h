#pragma once

#include <vector>

#include "mesh/charts.h"
#include "spectral_conformal/metric.h"

namespace spectral_conformal {

/// The metric of each triangle of a chart, from the metric (n_faces,) of the mesh faces; empty if `metric` is null.
std::vector<TriangleMetric> chart_metric(const PolygonMesh& mesh, const Chart& chart, const SpaceMetric* metric);

}  // namespace spectral_conformal
