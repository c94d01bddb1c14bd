#pragma once

#include <array>

#include "mesh/charts.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Distortion of a map of triangles from 3D to the plane. A linear map f = a p + b conj(p) of a triangle's plane has
/// singular values |a| + |b| and ||a| - |b||.
struct Distortion {
  Eigen::VectorXd qc;          ///< (F,) larger over smaller singular value; infinite where the image has no area
  Eigen::VectorXd log2_scale;  ///< (F,) log2 of the root of (image area / area); -infinite without image area
  std::vector<bool> flipped;   ///< (F,) image wound against the majority (by area) of the triangles
  double mean_qc = 1;          ///< weighted by the area in 3D (section 5)
  double p95_qc = 1;           ///< 95th percentile over the triangles, linear interpolation
  double p99_qc = 1;
  double max_qc = 1;
  double log2_scale_deviation = 0;  ///< standard deviation of log2_scale, weighted by the area in 3D
  int turning_number = 0;           ///< of the outer loop of the largest chart; only from measure_mesh_distortion
  std::vector<bool> overlapping;    ///< (F,) covers another triangle; only from measure_mesh_distortion
};

/// positions (V, 3), triangles consistently wound, triangle_weights (F,) or empty for 1, z (V,).
/// Triangles that local_isometric_frame would clamp have no distortion: qc 1, log2_scale 0, no weight, not flipped.
Distortion measure_distortion(const Eigen::Ref<const Positions>& positions,
                              const std::vector<std::array<int, 3>>& triangles,
                              const std::vector<double>& triangle_weights, const ComplexVector& z);

/// The same for a mesh of triangles as it comes: orients every chart first, so that a triangle that is wound the wrong
/// way in 3D is not taken for flipped, and looks for flips chart by chart. z (n_vertices,) must be finite.
/// Throws InvalidMesh as build_charts does.
Distortion measure_mesh_distortion(const PolygonMesh& triangle_mesh, const ComplexVector& z);

}  // namespace spectral_conformal
