#pragma once

#include <string>

#include "mesh/charts.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Why a chart cannot be parameterised (closed, one-sided, handles, a border of two vertices, non-finite coordinate, no
/// area), naming the condition and what to do, or "" when it can. Holes are allowed. positions (V, 3) of its vertices.
std::string why_not_a_disk(const Chart& chart, const Eigen::Ref<const Positions>& positions);

/// The one chart of a mesh that has to be a single disk-like patch. Throws InvalidMesh that says what it is instead:
/// no faces, degenerate faces, several components, edges with three or more faces, bow-tie vertices. Vertices that no
/// face uses are allowed; they are not in the chart.
Chart single_patch(const PolygonMesh& mesh);

}  // namespace spectral_conformal
