#pragma once

#include <optional>

#include "mesh/charts.h"
#include "spectral_conformal/step.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Why a chart cannot be parameterized (closed, non-orientable, handles, a boundary of two vertices, non-finite
/// coordinate, no area), of StepKind::rejected; none where it can. Holes are allowed. positions (V, 3) of its vertices.
std::optional<Step> why_not_parameterizable(const Chart& chart, const Eigen::Ref<const Positions>& positions);

/// Whether the triangles of a chart have no area, up to rounding: its vertices lie on one line or coincide. False where
/// a coordinate is not finite or the extent's square is not. positions (V, 3) of its vertices.
bool has_no_area(const Chart& chart, const Eigen::Ref<const Positions>& positions);

/// The chart of a mesh that has to be connected and manifold. Throws InvalidMesh that says what it is instead: no
/// faces, degenerate faces, several components, edges with three or more faces, bow-tie vertices. Vertices that no face
/// uses are allowed; they are not in the chart.
Chart single_chart(const PolygonMesh& mesh);

}  // namespace spectral_conformal
