#pragma once

#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "conformal/boundary_form.h"
#include "conformal/conformal_energy.h"
#include "conformal/extended_eigenproblem.h"
#include "conformal/lscm.h"
#include "linear_algebra/factorization.h"
#include "mesh/charts.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

enum class Method {
  spectral,  ///< smallest nonzero eigenvalue of L z = lambda B z (Eq. 5): the paper's method
  lscm,      ///< pinned LSCM / DCP (section 2.2)
  fiedler,   ///< B = identity: the Fiedler vector of L (Eq. 4)
  area       ///< B = A (section 3.3)
};

/// What was changed about a problem whose own attempts had failed (see SolveOptions::fallbacks).
enum class Fallback {
  none,
  clamped_triangles,  ///< thin triangles were given a minimal height in the energy
  other_boundary,     ///< the form B with the other BoundaryMeasure
  other_weights,      ///< the energy L with the other Weights
  tutte_embedding     ///< PatchOptions::fold_free replaced the map by a relaxed Tutte embedding
};

/// What an eigenvalue belongs to.
enum class EigenvalueOf {
  eigenvector,  ///< of the problem that was solved
  map           ///< the quotient of Eq. 5 of a map that is no eigenvector: pinned, unfolded or replaced
};

/// What is fixed when a Solver is made.
struct PatchOptions {
  Weights weights = Weights::uniform;
  BoundaryMeasure boundary = BoundaryMeasure::length;
  FactorizationBackend backend = FactorizationBackend::automatic;
  bool fill_holes = false;  ///< see hole_filling.h
  /// 0: keep angles. Up to 1, give them up for areas: the conformal map is relaxed towards an isometry
  /// (isometric_relaxation.h), and its metric, blended with the identity, is that of all solves (section 4.3).
  double area_blend = 0;
  /// All solves end with no flipped triangle and a turning number of 1 or -1, at some cost in distortion: see
  /// fold_free_map.h.
  bool fold_free = false;
};

/// What one solve of a Solver may vary.
struct SolveOptions {
  Method method = Method::spectral;
  double tolerance = 1e-8;               ///< see EigenproblemOptions
  double soft_pins = 0;                  ///< strength of pins as a soft force (see pin_attraction.h); 0: held exactly
  std::vector<Extender> extenders = {};  ///< of chart vertices; for Method::spectral
  double hole_rigidity = 0;  ///< beta of ExtendedForm::add_spread for every loop but the outer one; likewise
  /// Whether Method::spectral may solve another problem where its own fails. When false, that failure is the answer;
  /// the second attempt at the same problem, with a larger shift and another start, is made either way, and so is the
  /// embedding that PatchOptions::fold_free asks for.
  bool fallbacks = true;
  bool has_forces() const;  ///< whether extenders or hole rigidity change the form B
};

struct Parameterization {
  ComplexVector z;        ///< (V,) u + i v
  double eigenvalue = 0;  ///< z^H L z / z^H B z in the units of the input: lambda of Eq. 5 for an eigenvector
  /// |L z - lambda B z|_2 / (largest diagonal entry of L x |z|_2); lscm: see lscm.h; area, and with forces: the last
  /// relative change.
  double residual = 0;
  int iterations = 0;         ///< solves with the factor
  int turning_number = 0;     ///< of the outer boundary loop
  int unfolded = 0;           ///< folded triangles that PatchOptions::fold_free has unfolded
  bool is_embedding = false;  ///< whether it had to replace the map by an embedding
  /// Mean QC of the map that was unfolded or replaced; not a number where there was none.
  double mean_qc_before = std::numeric_limits<double>::quiet_NaN();
  // What was really solved.
  Method method = Method::spectral;    ///< Method::lscm for two or more hard pins, whichever was asked for
  Weights weights = Weights::uniform;  ///< of the energy L
  BoundaryMeasure boundary = BoundaryMeasure::length;  ///< of the form B
  Fallback fallback = Fallback::none;
  int clamped_triangles = 0;  ///< those that Fallback::clamped_triangles gave a minimal height
  EigenvalueOf eigenvalue_of = EigenvalueOf::eigenvector;
  int attempts = 1;     ///< eigenproblems (or pinned systems) solved until one passed, fallbacks included
  std::string message;  ///< fallbacks and repairs that were needed; empty when none was
  std::vector<std::pair<std::string, double>> timings;  ///< seconds per phase, in order
};

/// The method that solves with this many pins: hard pins, from two on, are held by pinned LSCM where Method::spectral
/// was asked for. Throws InvalidMesh for methods that hold none.
Method method_with_pins(const SolveOptions& options, std::size_t n_pins);

/// One patch with its energy and boundary form; keeps the factor of L + s M between solves.
class Solver {
 public:
  /// chart: one disk-like patch; positions (V, 3) of its vertices. With `fill_holes` every loop but the outer one is
  /// closed by virtual triangles. metric: one per triangle of the chart, in the frame of its first side, or empty for
  /// the metric of space. Throws InvalidMesh when why_not_parameterizable says so, or a metric is not positive
  /// definite.
  Solver(const Chart& chart, const Eigen::Ref<const Positions>& positions, const PatchOptions& options,
         const std::vector<TriangleMetric>& metric = {});

  /// Blends the metric where that was asked for, and factors L + s M, raising s a hundredfold while rounding breaks the
  /// factorisation (bounded). Throws SolveFailure. Called by solve where needed.
  void factorize(const Progress& progress = {});

  /// Without pins (for Method::lscm: two farthest boundary vertices) the map is placed (see placement.h), with its area
  /// equal to the area in 3D. One pin: the same map moved onto it. Several pins: held exactly by Method::lscm, or, with
  /// `soft_pins`, attracted by Method::spectral, whose map then comes with the similarity that fits it to the pins.
  /// Every eigenvector is checked: residual, corrections that converge, positive area, and for the spectral method a
  /// turning number of 1, or -1 where the longest loop in 3D is a hole of the map. One that fails is solved again with
  /// a larger shift and another start, then (spectral) with thin triangles raised, with the other boundary form and
  /// with the other weights; `message` says so, and the eigenvalue is then theirs. A pinned map must satisfy its
  /// equations; where its boundary winds round more than once, `message` says so. Throws SolveFailure when nothing
  /// passes. Extenders and hole rigidity change the form B of Method::spectral and leave the factor; a solve with them
  /// starts from the maps of earlier solves, and fails where they are so strong that the map winds round more than
  /// once, or hard pins hold it. With `fold_free` flipped triangles are unfolded, and a map that winds round more than
  /// once, or none, is replaced by an embedding; `message` says what was done, what that cost, and where it could not
  /// be done. The eigenvalue is then the quotient of Eq. 5 for that map, and the residual that of no eigenvector.
  Parameterization solve(const SolveOptions& options, const Pins& pins, const Progress& progress = {});

  const ConformalEnergy& energy() const { return *energy_; }
  /// Input units per unit of the energy's positions.
  double scale() const { return scale_; }
  const BoundaryLoop& outer_boundary() const { return outer_; }

 private:
  /// The same patch with another energy or boundary form.
  Solver(const Solver& like, Weights weights, BoundaryMeasure boundary);

  struct ShiftedFactor {
    std::unique_ptr<Factorization> factorization;
    double shift = 0;
  };
  struct Attempt;
  /// The eigenvector of one attempt before it is placed, virtual vertices included.
  struct Eigenvector {
    ComplexVector z;
    double lambda = 0;
    double residual = 0;
    int solves = 0;
    const char* why_not = nullptr;  ///< set where it failed
  };
  void blend_area(const Progress& progress);
  ShiftedFactor factor_shifted(const BoundaryForm& form, double relative_shift, const Progress& progress);
  ExtendedForm extended_form(const BoundaryForm& form, const SolveOptions& options, const Pins& attractors) const;
  Eigenvector attempt(const SolveOptions& options, const Pins& attractors, const BoundaryForm& form,
                      ShiftedFactor& factor, const Attempt& attempt, const Progress& progress);
  void correct(const BoundaryForm& form, Factorization& factorization, Eigenvector& eigenvector) const;
  Parameterization solve_with_remedies(const SolveOptions& options, const Pins& attractors, const Progress& progress,
                                       int& attempts);
  /// `with_virtual` gets the map of all vertices, virtual ones included, at no particular place and scale.
  Parameterization solve_eigenvector(const SolveOptions& options, const Pins& attractors, const Progress& progress,
                                     int& attempts, ComplexVector* with_virtual = nullptr);
  Parameterization solve_pinned(const Pins& pins, const Progress& progress);
  Parameterization solve_with_folds(const SolveOptions& options, const Pins& pins, const Progress& progress,
                                    int& attempts);
  Parameterization solve_fold_free(const SolveOptions& options, const Pins& pins, const Progress& progress);
  void unfold(const SolveOptions& options, const Pins& pins, const std::string& failure, const Progress& progress,
              Parameterization& result);
  double mean_distortion(const ComplexVector& z) const;
  /// z (chart vertices,) with the middles of filled holes.
  ComplexVector with_virtual_vertices(const ComplexVector& z) const;
  double lambda_unit(Method method) const;

  Positions positions_;  ///< centred, largest extent 1; added vertices of filled holes at the end
  int n_vertices_ = 0;   ///< of the chart
  double scale_ = 1;     ///< input units per unit of positions_
  std::unique_ptr<ConformalEnergy> energy_;
  BoundaryLoop outer_;
  std::vector<BoundaryLoop> inner_;
  PatchOptions options_;
  BoundaryForm form_;
  ShiftedFactor factor_;
  bool is_blended_ = false;
  RitzBasis ritz_basis_;    ///< of the last solve with forces and factor_
  ComplexVector previous_;  ///< the map of the last solve with factor_; empty before
  std::string repairs_;     ///< sentences, each with a space behind
  std::vector<std::pair<std::string, double>> set_up_timings_;
};

}  // namespace spectral_conformal
