#pragma once

#include "spectral_conformal/options.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The diagonal form B of Eq. 5 with the constants projected out (Eq. 7):
///   B^ = M - (M 1)(M 1)^T / (1^T M 1),
/// with M = diag(mass) on `vertices` and 0 elsewhere. Only the diagonal is stored.
struct BoundaryForm {
  std::vector<int> vertices;                         ///< distinct
  Eigen::VectorXd mass;                              ///< (vertices.size(),), positive
  double total() const { return mass.sum(); }        ///< 1^T M 1
  Complex barycenter(const ComplexVector& z) const;  ///< 1^T M z / 1^T M 1
  /// result += factor B^ z; both (V,).
  void add_applied(const ComplexVector& z, double factor, ComplexVector& result) const;
  /// z^H B^ z, summed about the barycenter so that a constant adds no rounding.
  double value(const ComplexVector& z) const;
};

/// The form of a boundary loop. Vertices whose two boundary edges have length 0 get no mass.
BoundaryForm boundary_form(const BoundaryLoop& loop, const Eigen::Ref<const Positions>& positions,
                           BoundaryMeasure measure);

/// The identity on all vertices, which makes the eigenvector the Fiedler vector of L (Eq. 4).
BoundaryForm identity_form(int n_vertices);

}  // namespace spectral_conformal
