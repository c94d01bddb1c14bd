#include "mesh/chart_checks.h"

#include <utility>

#include "concurrency/cancellation_scope.h"
#include "geometry/tolerances.h"
#include "geometry/triangle_shape.h"
#include "mesh/boundary_loops.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal {
namespace {

/// Up to this extent, and from its inverse on, areas and eigenvalues in input units are normal numbers: the latter go
/// with up to the third power of a length.
constexpr double max_extent = 1e100;
constexpr bool is_tiny(double extent) { return !(extent > 1 / max_extent); }

double extent_of(const Eigen::Ref<const Positions>& positions) {
  return (positions.colwise().maxCoeff() - positions.colwise().minCoeff()).maxCoeff();
}

}  // namespace

bool has_no_area(const Chart& chart, const Eigen::Ref<const Positions>& positions) {
  if (!positions.allFinite()) return false;
  const double extent = extent_of(positions);
  if (is_tiny(extent)) return true;
  if (!(extent < max_extent)) return false;
  const Eigen::RowVector3d low = positions.colwise().minCoeff();
  double area = 0;
  for_each_polled(chart.triangles.size(), [&](std::size_t t) {
    const auto& [a, b, c] = chart.triangles[t];
    const auto corner = [&](int v) -> Eigen::Vector3d { return (positions.row(v) - low).transpose() / extent; };
    area += triangle_area(corner(a), corner(b), corner(c));
  });
  return !(area > sum_rounding);  // rounding alone gives collinear points some area
}

std::optional<Step> why_not_parameterizable(const Chart& chart, const Eigen::Ref<const Positions>& positions) {
  for (Eigen::Index v = 0; v < positions.rows(); ++v) {
    if (!positions.row(v).allFinite()) return rejected(Rejection::vertex_not_finite, chart.vertices[v]);
  }
  if (!chart.orientable) return rejected(Rejection::not_orientable);
  if (chart.boundary_loops.empty()) return rejected(Rejection::closed, chart.genus());
  if (chart.genus() > 0) return rejected(Rejection::handles, chart.genus());
  const double extent = extent_of(positions);
  if (is_tiny(extent) || !(extent < max_extent)) return rejected(Rejection::no_extent);
  if (chart.boundary_loops[static_cast<std::size_t>(outer_loop(chart.boundary_loops, positions))].size() < 3) {
    return rejected(Rejection::border_of_two);
  }
  if (has_no_area(chart, positions)) return rejected(Rejection::no_surface);
  return std::nullopt;
}

Chart single_chart(const PolygonMesh& mesh) {
  ChartDecomposition decomposition = build_charts(mesh);
  if (!decomposition.degenerate_faces.empty()) {
    throw InvalidMesh(Rejection::degenerate_face, decomposition.degenerate_faces.front());
  }
  if (decomposition.charts.empty()) throw InvalidMesh(Rejection::no_faces);
  if (decomposition.non_manifold_edges > 0) {
    throw InvalidMesh(Rejection::non_manifold_edges, decomposition.non_manifold_edges);
  }
  if (decomposition.charts.size() > 1) {
    throw InvalidMesh(Rejection::several_components, static_cast<int>(decomposition.charts.size()));
  }
  if (decomposition.split_vertices > 0) throw InvalidMesh(Rejection::bow_ties, decomposition.split_vertices);
  return std::move(decomposition.charts.front());
}

}  // namespace spectral_conformal
