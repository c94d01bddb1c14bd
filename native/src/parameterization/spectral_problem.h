#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "conformal/boundary_form.h"
#include "conformal/conformal_energy.h"
#include "conformal/extended_form.h"
#include "conformal/shifted_factor.h"
#include "conformal/smallest_eigenvector.h"
#include "parameterization/map_check.h"
#include "parameterization/normalized_patch.h"
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
  ShiftedFactor factor = {};          ///< of L + s M (Eq. 7), or empty
  double relative_shift = 0;          ///< that the factor was asked for with
  bool is_factor_of_fiedler = false;  ///< whether M of the factor is the identity
  EarlierMaps earlier = {};           ///< maps of solves with this factor

  bool is_factored() const { return factor.factorization != nullptr; }
  /// M of L + s M: the mass of the boundary, or for Method::fiedler the identity.
  BoundaryForm mass(Method method) const;
  /// Factors L + s M, unless it is factored already. The factor stays empty where L + s M is not positive definite in
  /// double precision.
  void factorize(Method method, double asked_shift, const Progress& progress);
  /// Gives the memory of the factor back, with the maps that belong to it.
  void drop_factor();
  /// Changes the metric of the energy (ConformalEnergy::stretch) and drops the factor. All or nothing: where memory
  /// runs out, the problem is as it was.
  void stretch(const std::vector<TriangleMetric>& metric);
  /// Gives thin triangles a minimal height in the energy and drops the factor. Returns how many.
  int clamp(double min_relative_height);
};

/// Whether B of Eq. 5 is not zero: by length it is on an outer loop that has none.
bool has_form(const NormalizedPatch& patch, BoundaryMeasure boundary);

/// B of Eq. 5, the mass of the outer loop. Throws InvalidMesh unless has_form.
BoundaryForm form_of(const NormalizedPatch& patch, BoundaryMeasure boundary);

/// The same patch and metric with another energy or form. Throws as form_of.
SpectralProblem other_problem(const SpectralProblem& like, Weights weights, BoundaryMeasure boundary);

/// B of Eq. 5 with the soft constraints of section 4.2: extenders, rigid holes and attractors (pin_attraction.h). Empty
/// where there are none.
std::optional<ExtendedForm> constrained_form(const SpectralProblem& problem, const SolveOptions& options,
                                             const Pins& attractors);

/// What a quotient z^H L z / z^H B z is multiplied by to be in the units of the input.
double eigenvalue_unit(const SpectralProblem& problem, Method method);

/// The numbers of any map.
struct MapNumbers {
  double eigenvalue = 0;  ///< its quotient of Eq. 5, in the units of the input
  double residual = 0;    ///< how far it is from an eigenvector, see SolveRecord
  int turning_number = 0;
};

/// z: with virtual vertices, in this function and the next.
MapNumbers map_numbers(const SpectralProblem& problem, const ComplexVector& z);

/// The area and the turning number of a map where it is finite; the other members are the caller's.
MapCheck measured_check(const SpectralProblem& problem, const ComplexVector& z);

/// Fixes what the energy leaves free (placement.h): centered, with the area in 3D, upright. z (V,). False, and z stays,
/// where its signed area is not positive.
bool place(const SpectralProblem& problem, ComplexVector& z);

}  // namespace spectral_conformal
