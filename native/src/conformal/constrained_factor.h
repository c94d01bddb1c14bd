#pragma once

#include <memory>
#include <vector>

#include "conformal/boundary_form.h"
#include "conformal/conformal_energy.h"
#include "conformal/mixed_unknowns.h"
#include "conformal/shifted_factor.h"
#include "linear_algebra/factorization.h"
#include "spectral_conformal/linear_constraints.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Pulls toward positions, for maps that are held where they are: adds stiffness |z_k - t_k|^2 to z^H L z, t the
/// targets.
struct Springs {
  Pins targets;
  double stiffness = 0;
  /// Whether others have the same ends and stiffness, and so the same effect on L.
  bool match(const Springs& others) const;
};

/// The factor of K = P^T L P + s D for maps x = P w + c under linear constraints, where L is the real form on the 2V
/// coordinates. Unknowns are complex where the constraints allow it (mixed_unknowns.h).
class ConstrainedFactor {
 public:
  /// matrix: L. D = diag(P^T M P) for the mass M of `form`. positions: (V, 3), which help to order the factorization.
  /// Throws Cancelled, and as Factorization does.
  static ConstrainedFactor of(const HermitianMatrix& matrix, LinearConstraints constraints, const BoundaryForm& form,
                              const Positions& positions, double relative_shift, FactorizationBackend backend,
                              const Progress& progress);
  /// The same with the diagonal of P^T L P for D, and the least shift that makes K definite in double precision: for
  /// constraints that hold the map, which has no translation. With springs, L + their stiffness takes the place of L.
  static ConstrainedFactor of_held(const ConformalEnergy& energy, LinearConstraints constraints,
                                   const Positions& positions, FactorizationBackend backend, const Progress& progress,
                                   Springs springs = {});

  /// True also if everything is held.
  bool is_factored() const { return factor_.factorization != nullptr || constraints_.n_unknowns() == 0; }
  double shift() const { return factor_.shift; }
  const LinearConstraints& constraints() const { return constraints_; }
  /// Whether other constraints have the same P, hence the same K at this relative shift (0: the least shift).
  bool serves(const LinearConstraints& constraints, double relative_shift = 0) const;
  /// Adopts the offset of constraints that it serves, and the targets of springs that match its own.
  void adopt(LinearConstraints constraints, Springs springs = {}) {
    constraints_ = std::move(constraints);
    springs_ = std::move(springs);
  }
  const Springs& springs() const { return springs_; }
  /// The translations that the constraints allow, as w.
  const std::vector<Eigen::VectorXd>& translations() const { return translations_; }
  /// Removes from w the translations that the constraints allow: K hardly controls them.
  void remove_translations(Eigen::VectorXd& w) const;
  /// w = K^-1 P^T b without translations, for b (V,).
  Eigen::VectorXd solve(const ComplexVector& b) { return solve_unknowns(constraints_.gathered(b)); }
  /// w = K^-1 f without translations, for f (n_unknowns,).
  Eigen::VectorXd solve_unknowns(const Eigen::VectorXd& f);
  /// Chooses the unknowns S for the two solves below: distinct. Precondition: is_factored, with unknowns.
  void select(const std::vector<int>& unknowns);
  /// y = S^T K^-1 S f.
  void solve_selected(const Eigen::VectorXd& f, Eigen::VectorXd& y);
  /// w = K^-1 S f.
  Eigen::VectorXd solve_from_selected(const Eigen::VectorXd& f);

 private:
  void factorize(const HermitianMatrix& matrix, const BoundaryForm* form, const Positions& positions,
                 double relative_shift, FactorizationBackend backend, const Progress& progress);
  ComplexVector on_rows(const Eigen::VectorXd& f) const;
  Eigen::VectorXd unknowns_of(const ComplexVector& rows) const;

  LinearConstraints constraints_;
  Springs springs_ = {};
  double relative_shift_ = 0;
  std::vector<Eigen::VectorXd> translations_;
  MixedUnknowns unknowns_;
  ShiftedFactor factor_;
  std::vector<int> selected_;
  std::vector<int> row_of_selected_;  ///< of each selected unknown, its row among theirs
  Eigen::Index n_rows_ = 0;           ///< of the selected unknowns
};

}  // namespace spectral_conformal
