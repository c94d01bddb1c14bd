#include "parameterization/normalized_patch.h"

#include <algorithm>
#include <cstddef>
#include <optional>

#include "geometry/quad_splits.h"
#include "geometry/signed_area.h"
#include "mesh/boundary_loops.h"
#include "mesh/chart_checks.h"
#include "mesh/hole_filling.h"
#include "quality/map_degree.h"
#include "quality/overlap.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal {
namespace {

template <class T>
std::vector<T> joined(const std::vector<T>& first, const std::vector<T>& second) {
  std::vector<T> result;
  result.reserve(first.size() + second.size());
  result.insert(result.end(), first.begin(), first.end());
  result.insert(result.end(), second.begin(), second.end());
  return result;
}

/// Whether no triangle is flipped. Usually so, and much faster than to count.
bool are_all_positive(const NormalizedPatch& patch, const ComplexVector& z) {
  const auto end = patch.triangles.end() - static_cast<std::ptrdiff_t>(patch.n_virtual);
  return std::all_of(patch.triangles.begin(), end,
                     [&](const std::array<int, 3>& t) { return signed_area(z[t[0]], z[t[1]], z[t[2]]) > 0; });
}

}  // namespace

NormalizedPatch normalized_patch(const Chart& chart, const Eigen::Ref<const Positions>& positions, bool fill_holes) {
  if (const std::optional<Step> problem = why_not_parameterizable(chart, positions)) throw InvalidMesh(*problem);
  NormalizedPatch patch;
  patch.n_vertices = chart.n_vertices();
  const Eigen::RowVector3d low = positions.colwise().minCoeff();
  const Eigen::RowVector3d high = positions.colwise().maxCoeff();
  patch.scale = (high - low).maxCoeff();
  patch.positions = (positions.rowwise() - (low + 0.5 * (high - low))) / patch.scale;
  const int outer = outer_loop(chart.boundary_loops, patch.positions);
  for (std::size_t i = 0; i < chart.boundary_loops.size(); ++i) {
    if (static_cast<int>(i) == outer) {
      patch.outer = chart.boundary_loops[i];
    } else {
      patch.inner.push_back(chart.boundary_loops[i]);
    }
  }
  patch.triangles = chart.triangles;
  patch.triangle_weights = chart.triangle_weights;
  if (fill_holes && !patch.inner.empty()) {
    const HoleFilling filling = spectral_conformal::fill_holes(chart.boundary_loops, outer, patch.positions);
    patch.triangles = joined(chart.triangles.vector(), filling.triangles);
    patch.triangle_weights = joined(chart.triangle_weights.vector(), filling.triangle_weights);
    patch.positions.conservativeResize(patch.n_vertices + filling.centers.rows(), 3);
    patch.positions.bottomRows(filling.centers.rows()) = filling.centers;
    patch.n_virtual = filling.triangles.size();
  }
  return patch;
}

ComplexVector with_virtual_vertices(const NormalizedPatch& patch, const ComplexVector& z) {
  ComplexVector all = ComplexVector::Zero(patch.positions.rows());
  all.head(patch.n_vertices) = z;
  Eigen::VectorXd neighbors = Eigen::VectorXd::Zero(all.size());
  for (std::size_t t = patch.triangles.size() - patch.n_virtual; t < patch.triangles.size(); ++t) {
    const auto& triangle = patch.triangles[t];
    for (int k = 0; k < 3; ++k) {
      const int center = triangle[k];
      const int corner = triangle[(k + 1) % 3];
      if (center < patch.n_vertices || corner >= patch.n_vertices) continue;
      all[center] += z[corner];
      neighbors[center] += 1;
    }
  }
  for (Eigen::Index v = patch.n_vertices; v < all.size(); ++v) all[v] /= std::max(neighbors[v], 1.0);
  return all;
}

Distortion chart_distortion(const NormalizedPatch& patch, const ComplexVector& z) {
  if (patch.n_virtual == 0) return measure_distortion(patch.surface(), patch.triangles, patch.triangle_weights, z);
  const auto n = static_cast<std::ptrdiff_t>(patch.triangles.size() - patch.n_virtual);
  const auto triangles = patch.triangles.begin();
  const auto weights = patch.triangle_weights.begin();
  return measure_distortion(patch.surface(), {triangles, triangles + n}, {weights, weights + n}, z);
}

int n_flipped(const NormalizedPatch& patch, const ComplexVector& z) {
  return are_all_positive(patch, z) ? 0 : chart_distortion(patch, z).n_flipped();
}

int n_flipped_of_triangulation(const NormalizedPatch& patch, const ComplexVector& z) {
  if (are_all_positive(patch, z)) return 0;
  const Distortion distortion = chart_distortion(patch, z);
  return static_cast<int>(std::count_if(distortion.triangulation.begin(), distortion.triangulation.end(),
                                        [&](int t) { return distortion.flipped[static_cast<std::size_t>(t)]; }));
}

bool may_cover_itself(const NormalizedPatch& patch, const ComplexVector& z) {
  std::vector<BoundaryLoop> loops = patch.inner;
  loops.push_back(patch.outer);
  return !has_degree_at_most_one(loops, z);
}

int n_covering_triangles(const NormalizedPatch& patch, const ComplexVector& z) {
  if (!may_cover_itself(patch, z)) return 0;
  const auto n = static_cast<std::ptrdiff_t>(patch.triangles.size() - patch.n_virtual);
  const std::vector<std::array<int, 3>> all(patch.triangles.begin(), patch.triangles.begin() + n);
  const std::vector<TriangleWeight> weights(patch.triangle_weights.begin(), patch.triangle_weights.begin() + n);
  std::vector<std::array<int, 3>> triangles;
  for (const int t : mapped_triangulation(all, weights, z)) triangles.push_back(all[static_cast<std::size_t>(t)]);
  const std::vector<bool> overlapping = overlapping_triangles(triangles, z);
  return static_cast<int>(std::count(overlapping.begin(), overlapping.end(), true));
}

}  // namespace spectral_conformal
