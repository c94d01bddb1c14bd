#pragma once

#include <memory>
#include <vector>

#include "conformal/boundary_form.h"
#include "conformal/conformal_energy.h"
#include "conformal/eigenproblem.h"
#include "conformal/quotient_form.h"
#include "conformal/reduced_factor.h"
#include "parameterization/map_check.h"
#include "parameterization/normalized_patch.h"
#include "spectral_conformal/linear_constraints.h"
#include "spectral_conformal/metric.h"
#include "spectral_conformal/parameterize.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// L z = lambda B z (Eq. 5) of a patch, and the factor of L + s M that its solves share.
struct SpectralProblem {
  std::shared_ptr<const NormalizedPatch> patch;
  BoundaryMeasure boundary;
  FactorizationBackend backend;
  ConformalEnergy energy;             ///< L (Eq. 2 and 3)
  BoundaryForm form;                  ///< B (Eq. 5), without the constants
  ReducedFactor factor = {};          ///< of L + s M (Eq. 7) for free maps, or empty
  double relative_shift = 0;          ///< as requested for the factor
  bool needs_least_shift = false;     ///< whether the shift of an attempt was found too large (eigenproblem.h)
  bool is_factor_of_fiedler = false;  ///< whether M of the factor is the identity
  EarlierMaps earlier = {};           ///< maps of solves with this factor
  /// Of the last solve whose maps x = P w + c were not free (pins, held vertices, equations), for the next one with the
  /// same P; or empty.
  std::unique_ptr<ReducedFactor> restricted_factor = {};
  /// The energy of that factor if its constraints mirror triangles, and their mirror_images; or empty.
  std::unique_ptr<ConformalEnergy> mirrored_energy = {};
  std::vector<int> mirror_images = {};

  bool is_factored() const { return factor.is_factored(); }
  /// M of L + s M: the mass of the boundary, or for Method::fiedler the identity.
  BoundaryForm mass(Method method) const;
  /// Factors L + s M, unless already factored. The factor is not factored if L + s M is not positive definite in double
  /// precision.
  void factorize(Method method, double requested_shift, const Progress& progress);
  /// The factor of P^* L P + s D for the maps of linear equations that hold no coordinate, or of L + s M without any.
  ReducedFactor& factorized(const SolveOptions& options, double requested_shift, const Progress& progress);
  /// Frees the factors and the maps that belong to them.
  void drop_factor();
  void drop_restricted_factor();
  /// The energy of maps under the equations (mirrored_energy.h). Keeps the factor only if it belongs to that.
  const ConformalEnergy& energy_under(const LinearEquations& equations);
  /// Changes the metric of the energy (ConformalEnergy::stretch) and drops the factor. All or nothing: if memory runs
  /// out, the problem is unchanged.
  void stretch(const std::vector<TriangleMetric>& metric);
  /// Gives thin triangles a minimal height in the energy and drops the factor. Returns their number.
  int clamp(double min_relative_height);
};

/// Whether B of Eq. 5 is nonzero: measured by length, it vanishes on an outer loop of length 0.
bool has_form(const NormalizedPatch& patch, BoundaryMeasure boundary);

/// B of Eq. 5, the mass of the outer loop. Throws InvalidMesh unless has_form.
BoundaryForm form_of(const NormalizedPatch& patch, BoundaryMeasure boundary);

/// The same patch and metric with another energy or form. Throws as form_of does.
SpectralProblem other_problem(const SpectralProblem& like, Weights weights, BoundaryMeasure boundary);

/// B: that of Eq. 5 with the soft constraints of section 4.2, extenders, rigid holes and attractors (pin_attraction.h);
/// or A (section 3.3); or the identity, which makes z the Fiedler vector of L (Eq. 4).
QuotientForm quotient_form(const SpectralProblem& problem, const SolveOptions& options, const Pins& attractors);

/// The factor that converts a quotient z^H L z / z^H B z to the units of the input.
double eigenvalue_unit(const SpectralProblem& problem, Method method);

/// The numbers of any map.
struct MapNumbers {
  double eigenvalue = 0;  ///< quotient of Eq. 5, in the units of the input
  double residual = 0;    ///< distance from an eigenvector, see SolveRecord
  int turning_number = 0;
};

/// z: with virtual vertices, in this function and the next.
MapNumbers map_numbers(const SpectralProblem& problem, const ComplexVector& z);

/// The area and turning number of a map if it is finite; the caller sets the other members.
MapCheck measured_check(const SpectralProblem& problem, const ComplexVector& z);

/// Fixes the freedom that the energy leaves (placement.h): centers z (V,), scales it to the area in 3D and turns it
/// upright. Returns false, z unchanged, if its signed area is not positive.
bool place(const SpectralProblem& problem, ComplexVector& z);

}  // namespace spectral_conformal
