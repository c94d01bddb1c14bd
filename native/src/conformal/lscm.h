#pragma once

#include <memory>
#include <vector>

#include "conformal/conformal_energy.h"
#include "linear_algebra/factorization.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// L on the free vertices, those that are not pinned, factored: solves for any positions of the pinned vertices.
class PinnedFactor {
 public:
  /// pins: at least two; only their vertices matter. Throws Cancelled, and as Factorization does.
  static PinnedFactor of(const ConformalEnergy& energy, const Pins& pins, FactorizationBackend backend,
                         const Progress& progress);

  /// Whether the pinned vertices are those of `pins`.
  bool holds(const Pins& pins) const;
  /// Whether the free part of L, if necessary with a shift of the size of rounding, is positive definite in double
  /// precision.
  bool is_factorized() const { return is_factorized_; }
  /// Whether it is positive definite without a shift.
  bool is_definite() const { return is_definite_; }
  int n_free() const { return n_free_; }
  /// x = L_ff^-1 b on the free vertices, both (n_free,).
  void solve(const ComplexVector& b, ComplexVector& x) { factorization_->solve(b, x); }
  /// The same for vectors on all vertices, (V,): x is 0 at pinned vertices.
  void solve_on_all(const ComplexVector& b, ComplexVector& x);
  /// The entries (n_free,) of a vector (V,) at the free vertices.
  ComplexVector gathered(const ComplexVector& whole) const;
  /// The vector (V,) with these entries (n_free,), and 0 at pinned vertices.
  ComplexVector scattered(const ComplexVector& free) const;
  /// Largest diagonal entry of L at the free vertices.
  double max_diagonal() const { return max_diagonal_; }
  /// The error after a solve with the factor over the error before, as the first refinement measured it; infinite
  /// before.
  double contraction() const { return contraction_; }
  void set_contraction(double contraction) { contraction_ = contraction; }

 private:
  std::vector<int> free_index_;  ///< (V,) of each vertex among the free ones, -1 for pinned ones
  int n_free_ = 0;
  double max_diagonal_ = 0;
  bool is_factorized_ = true;
  bool is_definite_ = true;
  double contraction_ = infinity;
  std::unique_ptr<Factorization> factorization_;
};

struct PinnedSolution {
  ComplexVector vector;  ///< (V,), pinned entries exactly as given
  double change = 0;     ///< remaining error, relative to the extent of z
  double residual = 0;   ///< |L z| over the free vertices / (largest diagonal entry x extent of the map)
};

/// Pinned LSCM (Levy et al., Least Squares Conformal Maps, 2002), which is DCP (section 2.2): minimizes E_C with any
/// number of vertices held, L_ff z_f = -L_fp z_p, followed by iterative refinement, or, if that does not resolve z, as
/// on long strips, by conjugate gradients preconditioned by the factor. If the pins are the image of vertices in the
/// plane under a similarity, z is that similarity. With a tolerance coarser than single precision, the refinement ends
/// once that is reached, by the contraction that the factor had before: usually after one solve instead of three.
/// Precondition: a factor of the energy, factorized, that holds the pins. Throws Cancelled.
PinnedSolution solve_lscm(const ConformalEnergy& energy, const Pins& pins, PinnedFactor& factor,
                          const Progress& progress, double tolerance = 0);

/// The response to a force (V,) at the free vertices, by the same solver: L_ff x_f = force_f, 0 at pinned vertices.
/// Does not set `residual`.
PinnedSolution pinned_response(const ConformalEnergy& energy, const ComplexVector& force, PinnedFactor& factor,
                               const Progress& progress, double tolerance = 0);

}  // namespace spectral_conformal
