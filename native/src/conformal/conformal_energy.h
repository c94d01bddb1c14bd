#pragma once

#include <array>

#include "geometry/triangle_shape.h"
#include "spectral_conformal/metric.h"
#include "spectral_conformal/options.h"
#include "spectral_conformal/shared_vector.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The discrete conformal energy of a patch, E_C = E_D - A (section 2.2), with z = u + i v and one complex unknown per
/// vertex: z^H L z / 2 = E_C(z). L is Hermitian positive semidefinite with L 1 = 0. For a triangle of weight w and each
/// of its half-edges i->j with opposite angle t
///   L_ii += w cot t / 2,  L_jj += w cot t / 2,  L_ij -= w cot t / 2,  L_ji -= w cot t / 2    (Dirichlet, Eq. 3)
///   L_ij += i w / 2,      L_ji -= i w / 2                                                    (minus the area form)
/// The inverse-area weights are relative to the mean area (w = mean / |T|), so that L keeps the same magnitude. With a
/// metric (section 4.3) it is the quasi-conformal energy: cotangents of the stretched triangles, the same area form.
class ConformalEnergy {
 public:
  friend ConformalEnergy conformal_energy(const Eigen::Ref<const Positions>& positions,
                                          SharedVector<std::array<int, 3>> triangles,
                                          SharedVector<TriangleWeight> triangle_weights, Weights weights,
                                          std::size_t n_virtual);
  /// The energy of the same patch and metric with other weights.
  ConformalEnergy with(Weights weights) const;

  /// Stretches each triangle by a metric, on top of its present one, in the frame of energy_shapes. All or nothing: if
  /// memory runs out, this object is unchanged. Clamped triangles are skipped. Precondition: positive definite.
  void stretch(const std::vector<TriangleMetric>& metric);

  /// Raises the relative_height of thin triangles to this minimum, in the energy only. Returns their number. All or
  /// nothing.
  int clamp(double min_height);

  /// L, assembled anew by each call: it is large, and only factorizations need it.
  HermitianMatrix matrix() const;
  double max_diagonal() const;  ///< largest diagonal entry of L, computed anew by each call
  int n_vertices() const { return n_vertices_; }
  Weights weights() const { return weights_; }
  int clamped_triangles() const { return clamped_triangles_; }
  /// Area of the surface, weighted by the triangle weights, in squared units of the positions.
  double area() const { return area_; }
  /// The factor in the inverse-area weights (the mean triangle area); 1 for uniform weights.
  double weight_unit() const { return weight_unit_; }

  /// z^H L z = 2 E_C, as a sum of one square per triangle: relatively accurate even where it nearly vanishes.
  double value(const ComplexVector& z) const;
  /// z^H A z = 2 A(z), twice the weighted signed area of the map.
  double area_form(const ComplexVector& z) const;
  /// L z, accumulated from the differences along the edges of each triangle, so that constants vanish exactly. Returns
  /// value(z), at no extra cost.
  double apply(const ComplexVector& z, ComplexVector& result) const;

  /// All triangles, virtual ones at the end.
  const std::vector<std::array<int, 3>>& triangles() const { return triangles_; }
  std::size_t n_virtual() const { return n_virtual_; }
  /// Shapes in 3D, without the metric.
  const std::vector<TriangleShape>& shapes() const { return shapes_; }
  /// Shapes stretched by the metric, and clamped.
  const std::vector<TriangleShape>& energy_shapes() const { return stretched_.empty() ? shapes_ : stretched_; }
  const std::vector<TriangleWeight>& triangle_weights() const { return triangle_weights_; }

 private:
  ConformalEnergy() = default;
  void weigh(Weights weights);
  double weight(std::size_t triangle) const;
  template <class Visit>
  void for_each_half_edge(const Visit& visit) const;

  SharedVector<std::array<int, 3>> triangles_;
  SharedVector<TriangleWeight> triangle_weights_;
  std::vector<TriangleShape> shapes_;
  std::vector<TriangleShape> stretched_;  ///< empty without metric and clamped triangles
  Weights weights_ = Weights::uniform;
  std::size_t n_virtual_ = 0;
  double weight_unit_ = 1;
  double area_ = 0;
  double weight_sum_ = 0;  ///< sum of the triangle weights, without virtual triangles
  int clamped_triangles_ = 0;
  int n_vertices_ = 0;
};

/// The energy of a patch. positions (V, 3) near unit scale; triangles counterclockwise; triangle_weights per triangle.
/// The last `n_virtual` triangles (filled holes) enter the energy but no measure of the surface. Nearly degenerate
/// triangles are clamped as by local_isometric_frame and counted in clamped_triangles().
ConformalEnergy conformal_energy(const Eigen::Ref<const Positions>& positions,
                                 SharedVector<std::array<int, 3>> triangles,
                                 SharedVector<TriangleWeight> triangle_weights, Weights weights,
                                 std::size_t n_virtual = 0);

}  // namespace spectral_conformal
