#pragma once

#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Linear constraints that hold exactly, because the coordinates that they tie are one unknown: with the map's real
/// coordinates x = (u_0, v_0, u_1, v_1, ...), x = P w, where each row of P has one entry, 1 or -1, or none.
struct LinearConstraints {
  std::vector<int> unknown;       ///< (2V,) index into w for each coordinate; -1 for a coordinate that is 0
  std::vector<signed char> sign;  ///< (2V,) 1 or -1
  int n_unknowns = 0;

  bool empty() const { return unknown.empty(); }
  /// The map P w as complex numbers, (V,). w: (n_unknowns,).
  ComplexVector expanded(const Eigen::VectorXd& w) const;
  /// P^T x for the coordinates x of z (V,).
  Eigen::VectorXd gathered(const ComplexVector& z) const;
  /// The translation of all vertices along an axis (0: u, 1: v) as w; empty if there is none, as across a mirror axis.
  Eigen::VectorXd translation(int axis) const;
  /// The constraints of these vertices of a mesh, in their order, and of `n_free` further ones without any.
  LinearConstraints restricted(const std::vector<int>& vertices, int n_free) const;
};

}  // namespace spectral_conformal
