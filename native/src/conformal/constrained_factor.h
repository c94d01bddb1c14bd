#pragma once

#include <memory>
#include <vector>

#include "conformal/boundary_form.h"
#include "conformal/conformal_energy.h"
#include "conformal/shifted_factor.h"
#include "linear_algebra/factorization.h"
#include "spectral_conformal/linear_constraints.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The factor of K = P^T L P + s D for maps x = P w + c under linear constraints. They single out directions, so the
/// complex form of the energy no longer represents the problem: its real form on the 2V coordinates does, in which an
/// entry a + i b of the complex form stands for the block [a, -b; b, a].
class ConstrainedFactor {
 public:
  /// matrix: L. D = diag(P^T M P) for the mass M of `form`. positions: (V, 3), which help to order the factorization.
  /// Throws Cancelled, and as Factorization does.
  ConstrainedFactor(const HermitianMatrix& matrix, LinearConstraints constraints, const BoundaryForm& form,
                    const Positions& positions, double relative_shift, FactorizationBackend backend,
                    const Progress& progress);
  /// The same with the diagonal of P^T L P for D, and the least shift that makes K definite in double precision: for
  /// constraints that hold the map, which has no translation.
  ConstrainedFactor(const ConformalEnergy& energy, LinearConstraints constraints, const Positions& positions,
                    FactorizationBackend backend, const Progress& progress);

  /// Trivially so where everything is held.
  bool is_factored() const { return factor_.factorization != nullptr || constraints_.n_unknowns() == 0; }
  double shift() const { return factor_.shift; }
  const LinearConstraints& constraints() const { return constraints_; }
  /// Whether other constraints have the same P, and so the same K with this shift; 0: with the least.
  bool serves(const LinearConstraints& constraints, double relative_shift = 0) const;
  /// Takes constraints that it serves, for their offset.
  void take(LinearConstraints constraints) { constraints_ = std::move(constraints); }
  /// Of K. Precondition: is_factored, with unknowns.
  Factorization& factorization() { return *factor_.factorization; }
  /// The translations that the constraints allow, as w.
  const std::vector<Eigen::VectorXd>& translations() const { return translations_; }
  /// Removes the translations that the constraints allow from w, which K hardly controls.
  void remove_translations(Eigen::VectorXd& w) const;
  /// w = K^-1 P^T b without translations, for b (V,).
  Eigen::VectorXd solve(const ComplexVector& b);

 private:
  void factorize(HermitianMatrix&& matrix, const BoundaryForm& diagonal, const Positions& positions,
                 double relative_shift, FactorizationBackend backend, const Progress& progress);

  LinearConstraints constraints_;
  double relative_shift_;
  std::vector<Eigen::VectorXd> translations_;
  ShiftedFactor factor_;
};

}  // namespace spectral_conformal
