#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "conformal/affine_space.h"
#include "conformal/boundary_form.h"
#include "conformal/conformal_energy.h"
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

/// The factor of K = P^* L P + s D for the maps x = P w + c (affine_space.h).
class ReducedFactor {
 public:
  /// D = diag(P^* M P) for the mass M of `form`: for free maps, whose P is the identity, K = L + s M (Eq. 7). L is
  /// singular (L 1 = 0), so a form without mass has no factor. A shift by the form itself preserves the eigenvectors of
  /// Eq. 5. s is relative_shift times the median of (P^* L P)_ii / D_i where D is positive, raised from 0 to the
  /// rounding of these, and a hundredfold, while rounding breaks the factorization and s D is less than half of L.
  ///
  /// matrix: L, consumed. constraints: none for free maps. positions: (V, 3), which help to order the factorization.
  /// analyzed: a factorization of a matrix with the structure of P^* L P, whose order and memory are reused; or null.
  /// Throws Cancelled, and as Factorization does.
  static ReducedFactor of(HermitianMatrix&& matrix, std::optional<LinearConstraints> constraints,
                          const BoundaryForm& form, const Positions& positions, double relative_shift,
                          FactorizationBackend backend, const Progress& progress,
                          std::unique_ptr<Factorization> analyzed = nullptr);
  /// The same with the diagonal of P^* L P for D, and the least shift that makes K definite in double precision: for
  /// constraints that hold the map, which has no translation. With springs, L + their stiffness takes the place of L.
  static ReducedFactor of_held(const ConformalEnergy& energy, LinearConstraints constraints, const Positions& positions,
                               FactorizationBackend backend, const Progress& progress, Springs springs = {});

  /// True also if everything is held.
  bool is_factored() const { return factorization_ != nullptr || (space_.size() == 0 && space_.n_vertices() > 0); }
  /// s, the last one tried.
  double shift() const { return shift_; }
  /// Largest diagonal entry of P^* L P.
  double max_diagonal() const { return max_diagonal_; }
  const AffineSpace& space() const { return space_; }
  /// Whether other constraints have the same P, hence the same K at this relative shift (0: the least shift).
  bool serves(const LinearConstraints& constraints, double relative_shift = 0) const {
    return relative_shift == relative_shift_ && space_.serves(constraints);
  }
  /// Adopts the offset of constraints that it serves, and the targets of springs that match its own.
  void adopt(LinearConstraints constraints, Springs springs = {}) {
    space_.adopt(std::move(constraints));
    springs_ = std::move(springs);
  }
  const Springs& springs() const { return springs_; }
  /// w = K^-1 f without translations, which K hardly controls. Precondition: is_factored.
  ComplexVector solve(const ComplexVector& f);
  /// P K^-1 P^* b, for b (V,).
  ComplexVector inverse(const ComplexVector& b) { return space_.expanded(solve(space_.gathered(b))); }
  /// For solves on some unknowns. Precondition: is_factored, with unknowns.
  Factorization& factorization() { return *factorization_; }
  /// Gives it away.
  std::unique_ptr<Factorization> release() { return std::move(factorization_); }
  /// The error after a solve with the factor over the error before, as the first refinement measured it; infinite
  /// before.
  double contraction() const { return contraction_; }
  void set_contraction(double contraction) { contraction_ = contraction; }

 private:
  /// form: null for the diagonal of P^* L P.
  void factorize(HermitianMatrix&& matrix, std::optional<LinearConstraints> constraints, const BoundaryForm* form,
                 const Positions& positions, FactorizationBackend backend, const Progress& progress,
                 std::unique_ptr<Factorization> factorization);

  AffineSpace space_;
  Springs springs_ = {};
  double relative_shift_ = 0;
  double contraction_ = infinity;
  double shift_ = 0;
  double max_diagonal_ = 0;
  std::unique_ptr<Factorization> factorization_;  ///< null if K is not positive definite in double precision
};

}  // namespace spectral_conformal
