#pragma once

#include <vector>

#include "mesh/charts.h"
#include "spectral_conformal/metric.h"

namespace spectral_conformal {

/// The metric of each triangle of a chart from that of each mesh face, (n_faces,); empty where `metric` is null.
std::vector<TriangleMetric> chart_metric(const PolygonMesh& mesh, const Chart& chart, const SpaceMetric* metric);

}  // namespace spectral_conformal
