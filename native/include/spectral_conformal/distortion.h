#pragma once

#include <array>
#include <vector>

#include "spectral_conformal/polygon_mesh.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

struct TriangleShape;

/// Distortion of a map of triangles from 3D to the plane. A linear map f = a p + b conj(p) of a triangle's plane has
/// singular values |a| + |b| and ||a| - |b||. The numbers of the whole map count one split of each quad
/// (mapped_triangulation).
struct Distortion {
  Eigen::VectorXd qc;               ///< (F,) larger over smaller singular value; infinite where the image has no area
  Eigen::VectorXd log2_scale;       ///< (F,) log2 of sqrt(image area / area); -infinity without image area
  Eigen::VectorXd area;             ///< (F,) in 3D, units of the positions squared; 0 for degenerate triangles
  Eigen::VectorXd image_area;       ///< (F,) signed, units of the map squared; 0 for degenerate triangles
  std::vector<bool> flipped;        ///< (F,) the image is wound against the majority (by image area) of the triangles
  std::vector<int> triangulation;   ///< ascending: the triangles over which the following are taken
  double mean_qc = 1;               ///< weighted by the area in 3D (section 5)
  double max_qc = 1;                ///< maximum
  double log2_scale_deviation = 0;  ///< standard deviation of log2_scale, weighted by the area in 3D
  int turning_number = 0;           ///< of the outer loop of the largest chart; only from measure_mesh_distortion
  std::vector<bool> overlapping;    ///< (F,) covers another triangle; only from measure_mesh_distortion

  int n_flipped() const;  ///< triangles
  /// The qc that this fraction of the counted triangles does not exceed, linearly interpolated; 1 without triangles.
  double qc_percentile(double fraction) const;
};

/// positions: (V, 3); triangles: (F), consistently wound; triangle_weights: (F,) as in quad_splits, or empty for 1; z:
/// (V,), finite. Degenerate triangles, those that local_isometric_frame clamps, have no distortion: qc 1, log2_scale 0,
/// weight 0, not flipped.
Distortion measure_distortion(const Eigen::Ref<const Positions>& positions,
                              const std::vector<std::array<int, 3>>& triangles,
                              const std::vector<TriangleWeight>& triangle_weights, const ComplexVector& z);

/// The same, from the triangles in their local isometric frames: shapes (at least F).
Distortion measure_distortion(const std::vector<TriangleShape>& shapes,
                              const std::vector<std::array<int, 3>>& triangles,
                              const std::vector<TriangleWeight>& triangle_weights, const ComplexVector& z);

/// Only mean_qc, over the first n_triangles, at a third of the cost. The signed area of the map must not be negative.
double mean_quasi_conformal_distortion(const std::vector<TriangleShape>& shapes,
                                       const std::vector<std::array<int, 3>>& triangles,
                                       const std::vector<TriangleWeight>& triangle_weights, std::size_t n_triangles,
                                       const ComplexVector& z);

/// The same for any triangle mesh: orients every chart first, so that a triangle wound the wrong way in 3D does not
/// count as flipped, and finds flips chart by chart. z: (n_vertices,), finite. Throws InvalidMesh as build_charts does,
/// and for a face that is not a triangle.
Distortion measure_mesh_distortion(const PolygonMesh& triangle_mesh, const ComplexVector& z);

}  // namespace spectral_conformal
