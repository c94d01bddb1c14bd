#pragma once

#include <memory>
#include <vector>

#include "conformal/boundary_form.h"
#include "conformal/conformal_energy.h"
#include "conformal/extended_eigenproblem.h"
#include "conformal/shifted_factor.h"
#include "parameterization/map_check.h"
#include "parameterization/normalized_patch.h"
#include "parameterization/stopwatch.h"
#include "spectral_conformal/parameterize.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// A map found by SpectralSolver, or why there is none.
struct SpectralMap {
  Rejection rejection = Rejection::none;
  ComplexVector z;        ///< (V,) where it was accepted; SpectralSolver::place places it
  ComplexVector whole;    ///< with virtual vertices, at no particular place and scale; for Rejection::winding, too
  double eigenvalue = 0;  ///< in the units of the input
  double residual = 0;    ///< see SolveRecord
  double shift = 0;       ///< s of the last attempt
  int solves = 0;         ///< with the factor, in the last attempt
  int turning_number = 0;
  int attempts = 0;
};

/// Spectral conformal parameterization of a patch (Mullen et al. 2008):
///   Eq. 2, 3  L = L_D - A, the conformal energy
///   Eq. 5     L z = lambda B z, B the form of the boundary, smallest nonzero lambda
///   Eq. 7     B^ z = mu (L + s M) z, largest mu; B^ is B without the constants
/// then the checks, the polish, and the similarity that the energy leaves free. Keeps one factor of L + s M between
/// solves, that of the last attempt, and the maps that solves with soft constraints may start from.
class SpectralSolver {
 public:
  /// The patch must outlive this object. Throws InvalidMesh unless has_form.
  SpectralSolver(const NormalizedPatch& patch, Weights weights, BoundaryMeasure boundary, FactorizationBackend backend);
  /// The same patch and metric with another energy or form. Throws as the above.
  SpectralSolver(const SpectralSolver& like, Weights weights, BoundaryMeasure boundary);

  /// Whether B of Eq. 5 is not zero: by length it is on an outer loop that has none.
  static bool has_form(const NormalizedPatch& patch, BoundaryMeasure boundary);

  /// Changes the metric of the energy (ConformalEnergy::stretch) and drops the factor. All or nothing: where memory
  /// runs out, this object is as it was.
  void stretch(const std::vector<TriangleMetric>& metric);
  /// Gives thin triangles a minimal height in the energy and drops the factor. Returns how many.
  int clamp(double min_relative_height);

  /// Factors L + s M and keeps the factor. The outcome has no map; it is rejected where L + s M is not positive
  /// definite in double precision.
  SpectralMap factorize(const Progress& progress);
  bool is_factored() const { return factor_.factorization != nullptr; }
  /// Gives the memory of the factor back, with the maps that belong to it. The next solve factors again.
  void drop_factor();
  /// From here on solves do not start from the maps of earlier ones, on which their rounding would depend.
  void forget_maps();

  /// The map of Method::spectral, fiedler or area, not yet placed; `attractors` are soft pins. Tried again, with a
  /// larger shift and another start, where it fails its checks. Solves with soft constraints start from the maps of
  /// earlier solves since forget_maps.
  SpectralMap solve(const SolveOptions& options, const Pins& attractors, const Progress& progress, Timings& timings);

  /// Lowers the mean QC of a map of this solver (polish.h) and returns the number of steps; not the whole way, or none
  /// of it, where more of it would lie on itself than before. 0, and the map stays, where no step lowers it.
  int polish(SpectralMap& map, const Progress& progress, Timings& timings);

  /// Fixes what the energy leaves free (placement.h): centred, with the area in 3D, upright. z (V,). False, and z
  /// stays, where its signed area is not positive.
  bool place(ComplexVector& z) const;

  /// The numbers of any map: its quotient of Eq. 5 and how far it is from an eigenvector. whole: with virtual vertices.
  struct Numbers {
    double eigenvalue = 0;  ///< in the units of the input
    double residual = 0;    ///< see SolveRecord
    int turning_number = 0;
  };
  Numbers numbers(const ComplexVector& whole) const;

  const NormalizedPatch& patch() const { return *patch_; }
  const ConformalEnergy& energy() const { return *energy_; }
  const BoundaryForm& form() const { return form_; }
  BoundaryMeasure boundary() const { return boundary_; }
  FactorizationBackend backend() const { return backend_; }
  /// What a quotient z^H L z / z^H B z is multiplied by to be in the units of the input.
  double eigenvalue_unit(Method method) const;

 private:
  struct Attempt;
  struct Eigenvector;
  SpectralMap attempt(const SolveOptions& options, const Pins& attractors, const Attempt& attempt,
                      const Progress& progress, Timings& timings);
  Eigenvector eigenvector(const SolveOptions& options, const Pins& attractors, const BoundaryForm& form,
                          ShiftedFactor& factor, const Attempt& attempt, const Progress& progress);
  /// Factors L + s M, as factor_shifted does.
  ShiftedFactor factored(const BoundaryForm& form, double relative_shift, const Progress& progress,
                         std::unique_ptr<Factorization> analyzed = nullptr);
  /// Keeps the factor of this shift, in place of another.
  void keep_factor(double relative_shift, const Progress& progress);
  double max_diagonal() const;  ///< the unit of residuals
  ExtendedForm extended_form(const BoundaryForm& form, const SolveOptions& options, const Pins& attractors) const;

  const NormalizedPatch* patch_;
  FactorizationBackend backend_;
  BoundaryMeasure boundary_;
  std::unique_ptr<ConformalEnergy> energy_;  ///< L
  double max_diagonal_ = 0;                  ///< largest diagonal entry of L as it is now, once it was factored, else 0
  BoundaryForm form_;                        ///< M, and B^ with the constants taken out
  ShiftedFactor factor_;                     ///< of L + s M
  double relative_shift_ = 0;                ///< that factor_ was asked for with
  // What the next solve with soft constraints starts from; of solves with factor_, or empty.
  RitzBasis ritz_basis_;    ///< of the last one with soft constraints
  ComplexVector previous_;  ///< the last accepted map, virtual vertices included
};

}  // namespace spectral_conformal
