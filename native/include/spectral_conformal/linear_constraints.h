#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <utility>
#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Homogeneous linear equations on the coordinates x = (u_0, v_0, u_1, v_1, ...) of a map, sum_k a_k x[c_k] = 0, and
/// given coordinates. Coordinate 2 i + axis belongs to vertex i (axis 0: u, 1: v).
struct LinearEquations {
  std::vector<int> start{0};        ///< (n + 1,) first term of each equation, and the end
  std::vector<int> coordinate;      ///< (terms,) c_k
  std::vector<double> coefficient;  ///< (terms,) a_k, finite
  /// Coordinates that are given, and their values, finite.
  std::vector<std::pair<int, double>> held;

  int size() const { return static_cast<int>(start.size()) - 1; }
  bool empty() const { return size() == 0 && held.empty(); }
  void add(const std::vector<std::pair<int, double>>& terms);
  /// The equations of each of several parts, on the `number` of each vertex in its part. part: per vertex, or -1 for
  /// none. Equations between parts are left out; likewise `held`.
  std::vector<LinearEquations> by_part(const std::vector<int>& part, const std::vector<int>& number, int n_parts) const;
  /// The equations whose vertices all have a `number` (not -1), with these numbers for the vertices; likewise `held`.
  LinearEquations renumbered(const std::vector<int>& number) const;
};

/// The solutions x = P w + c of linear equations. Maps of this form meet the equations to rounding, without weights.
/// Each row of P is a coordinate: one unknown with the factor 1 where no equation concerns it.
///
/// Without held coordinates c = 0. With some, the equations, which do not fix the position of the map, hold relative to
/// an origin, another unknown where it matters, as for a mirror axis. Held coordinates take precedence: an equation
/// that they contradict is dropped.
class LinearConstraints {
 public:
  using Expansion = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  /// By sparse Gaussian elimination: each equation expresses the coordinate with the largest coefficient, the last if
  /// several are equal, by the others. Equations between two coordinates thus cost as much as disjoint sets.
  static LinearConstraints of(const LinearEquations& equations, int n_vertices);

  int n_unknowns() const { return static_cast<int>(p_->cols()); }
  int n_vertices() const { return static_cast<int>(p_->rows() / 2); }
  /// P, (2V, n_unknowns).
  const Expansion& expansion() const { return *p_; }
  /// (n_unknowns,) the coordinate whose value each unknown is, ascending; 2V or 2V + 1 for the origin.
  const std::vector<int>& coordinates() const { return coordinates_; }
  /// The map P w as complex numbers, (V,). w: (n_unknowns,).
  ComplexVector expanded(const Eigen::VectorXd& w) const;
  /// c, (V,).
  const ComplexVector& offset() const { return offset_; }
  /// The number of equations that the held coordinates contradict by more than the precision of UVs.
  int n_unmet() const { return n_unmet_; }
  /// P^T x for the coordinates x of z (V,).
  Eigen::VectorXd gathered(const ComplexVector& z) const;
  /// The translation of all vertices along an axis (0: u, 1: v) as w; empty if there is none, as across a mirror axis.
  Eigen::VectorXd translation(int axis) const;

 private:
  /// Shared: Eigen 3.4 copies a sparse matrix instead of moving it, and leaks if memory runs out meanwhile.
  std::shared_ptr<const Expansion> p_ = std::make_shared<const Expansion>();
  std::vector<int> coordinates_;
  ComplexVector offset_;
  int n_unmet_ = 0;
};

}  // namespace spectral_conformal
