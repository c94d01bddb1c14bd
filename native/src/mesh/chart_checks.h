#pragma once

#include <optional>

#include "mesh/charts.h"
#include "spectral_conformal/step.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Why a chart cannot be parameterized (closed, non-orientable, handles, a boundary of two vertices, non-finite
/// coordinate, no area), of StepKind::rejected; empty if it can. Holes are allowed. positions: (V, 3), of its vertices.
std::optional<Step> why_not_parameterizable(const Chart& chart, const Eigen::Ref<const Positions>& positions);

/// Whether the triangles of a chart have no area, up to rounding: its vertices are collinear or coincide. False if a
/// coordinate or the square of the extent is not finite. positions: (V, 3), of its vertices.
bool has_no_area(const Chart& chart, const Eigen::Ref<const Positions>& positions);

/// The chart of a connected manifold mesh. Throws InvalidMesh naming the violation: no faces, degenerate faces, several
/// components, edges with three or more faces, bow-tie vertices. Vertices of no face are allowed; they are not in the
/// chart.
Chart single_chart(const PolygonMesh& mesh);

}  // namespace spectral_conformal
