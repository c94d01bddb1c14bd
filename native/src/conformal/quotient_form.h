#pragma once

#include <vector>

#include "conformal/boundary_form.h"
#include "conformal/conformal_energy.h"
#include "conformal/pin_attraction.h"
#include "spectral_conformal/options.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The mean of x over some of its entries, at least one.
Complex barycenter(const std::vector<int>& indices, const ComplexVector& x);
/// Its transpose: adds to each of these entries an equal part of the force.
void spread_evenly(const std::vector<int>& indices, Complex force, ComplexVector& result);

/// B of L z = lambda B z: the form of Eq. 5 with the soft constraints of section 4.2,
///   B^ + sum_k alpha_k (e_i - e_j)(e_i - e_j)^T + beta sum_l B^_l - weight Q,
/// indefinite if an extender has alpha < 0 or pins attract; or A of section 3.3. It acts only on its support, in
/// general few vertices, and vanishes on constants. B^_l is the spread of a boundary loop about its own barycenter: the
/// paper's rigid hole after elimination of the fake vertex, which has no conformal energy.
class QuotientForm {
 public:
  /// B^.
  explicit QuotientForm(const BoundaryForm& boundary);
  /// A of E_C = E_D - A, indefinite: z^H A z is twice the signed area of the map.
  static QuotientForm area(const ConformalEnergy& energy);

  /// Extenders that join a group with itself or have strength 0 have no effect, but belong to the support.
  void add_extender(const Extender& extender);
  /// Adds beta times the spread of `loop` about its own barycenter.
  void add_spread(const BoundaryForm& loop, double beta);
  void add_attraction(const PinAttraction& attraction);

  /// Whether the form is that of every turned map.
  bool may_turn() const;
  /// Whether it is B^ alone.
  bool is_boundary_form() const {
    return spreads_.size() == 1 && differences_.empty() && attractions_.empty() && couplings_.empty();
  }
  /// Whether it has no negative term, so that it is positive semidefinite.
  bool is_definite() const;
  /// Distinct vertices in the order of their first appearance, those of `boundary` first.
  const std::vector<int>& support() const { return support_; }
  /// x on the support, from z (V,).
  ComplexVector restrict(const ComplexVector& z) const;
  /// B x, both on the support.
  void apply(const ComplexVector& x, ComplexVector& result) const;
  /// x^H B x, x on the support.
  double value(const ComplexVector& x) const;
  /// result += factor B z; both (V,).
  void add_applied(const ComplexVector& z, double factor, ComplexVector& result) const;
  /// z^H B z, z (V,).
  double value_of_map(const ComplexVector& z) const { return value(restrict(z)); }

 private:
  QuotientForm() = default;
  struct Spread {
    BoundaryForm form;
    double factor;
  };
  struct Difference {
    std::vector<int> from;
    std::vector<int> to;
    double factor;
    Complex value(const ComplexVector& x) const;
  };
  /// The entries i factor at (row, column) and -i factor at (column, row).
  struct Coupling {
    int row;
    int column;
    double factor;
  };
  /// Their indices in the support; adds vertices that are not in it yet.
  std::vector<int> local(const std::vector<int>& vertices);

  std::vector<int> support_;
  std::vector<int> index_;  ///< of each vertex up to the largest so far, or -1
  double total_ = 0;
  // All in indices of the support, not vertices.
  std::vector<Spread> spreads_;
  std::vector<Difference> differences_;
  std::vector<PinAttraction> attractions_;
  std::vector<Coupling> couplings_;
};

/// lambda = z^H L z / z^H B z (Eq. 5) and r = L z - lambda B z. Returns lambda.
double eigen_residual(const ConformalEnergy& energy, const QuotientForm& form, const ComplexVector& z,
                      ComplexVector& r);

}  // namespace spectral_conformal
