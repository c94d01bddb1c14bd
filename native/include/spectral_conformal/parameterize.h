#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "spectral_conformal/linear_constraints.h"
#include "spectral_conformal/metric.h"
#include "spectral_conformal/options.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/relaxation_status.h"
#include "spectral_conformal/step.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

class ConformalEnergy;
struct Chart;
struct PolygonMesh;

/// The substitute for the map of a problem whose own attempts failed (see SolveOptions::fallbacks).
enum class Fallback {
  none,
  unfolded,           ///< the failed map, which winds around once after its flipped triangles were unfolded
  clamped_triangles,  ///< the energy with a minimal height for thin triangles
  other_boundary,     ///< the form B with the other BoundaryMeasure
  other_weights,      ///< the energy L with the other Weights
  tutte_embedding     ///< a relaxed Tutte embedding
};

/// How far a map goes on from the minimum of the conformal energy (polish.h).
enum class Polish {
  off,
  angles,   ///< toward the least mean QC
  balanced  ///< then toward even sizes, until half of the mean QC gained is spent
};

/// What an eigenvalue refers to.
enum class EigenvalueOf {
  eigenvector,  ///< of the problem that was solved
  map           ///< quotient of Eq. 5 of a map that is not an eigenvector: pinned, polished, unfolded or replaced
};

/// Options that a Solver fixes at construction.
struct PatchOptions {
  Weights weights = Weights::uniform;
  BoundaryMeasure boundary = BoundaryMeasure::length;
  FactorizationBackend backend = FactorizationBackend::automatic;
  bool fill_holes = false;  ///< see hole_filling.h
  /// 0: preserve angles. Up to 1: trade angles for areas. The conformal map is relaxed toward an isometry
  /// (isometric_relaxation.h), and all solves use its metric, blended with the identity (section 4.3).
  double area_blend = 0;
};

/// Options of one solve of a Solver.
struct SolveOptions {
  Method method = Method::spectral;
  double tolerance = 1e-8;  ///< see EigenproblemOptions
  double soft_pins = 0;     ///< strength of pins as a soft force (see pin_attraction.h); 0: pins hold exactly
  /// Between chart vertices. For Method::spectral, also if three or more hard pins or held coordinates turn it into
  /// lscm (held_extenders.h).
  std::vector<Extender> extenders = {};
  /// For Method::spectral: equations that the map meets exactly, polished or not. A single pin moves it; with more hard
  /// ones, or with held coordinates, it is the LSCM map under the equations, without hole_rigidity. fold_free does not
  /// move their vertices, and there is no fallback.
  LinearEquations constraints = {};
  /// For Method::spectral: beta of ExtendedForm::add_spread for every loop but the outer one. Without extenders and
  /// soft pins it is lowered as far as the patch requires. Empty: chosen per patch (hole_rigidity.h), or 0 with
  /// extenders or soft pins.
  std::optional<double> hole_rigidity = 0.0;
  /// Whether Method::spectral may replace a failed map: by its unfolding, an embedding, or the map of another problem
  /// (fallbacks.h). If false, the solve fails; the embedding that `fold_free` requests is made in either case.
  bool fallbacks = true;
  /// Whether to unfold flipped triangles and separate overlapping parts, or replace the map by an embedding, at some
  /// cost in distortion; remaining flips and overlaps are reported. See fold_free_map.h.
  bool fold_free = false;
  /// How maps of Method::spectral without soft constraints or a metric continue from the eigenvector, or with three or
  /// more hard pins from the pinned map, to a lower mean QC, if there is one. Pins stay held.
  Polish polish = Polish::off;
  /// Whether a problem whose map fails the checks is solved once more, from another start and with a larger shift
  /// unless it was raised already.
  bool second_attempt = true;
  bool has_extenders() const;              ///< whether extenders change the map
  bool has_extenders_or_rigidity() const;  ///< whether extenders or a given hole rigidity do
};

/// The numbers of a map, and the problem that was actually solved for it.
struct SolveRecord {
  double eigenvalue = 0;  ///< z^H L z / z^H B z in the units of the input: lambda of Eq. 5 for an eigenvector
  EigenvalueOf eigenvalue_of = EigenvalueOf::eigenvector;
  /// |P^* (L z - lambda B z)|_2 / (largest diagonal entry of L x |z|_2); lscm: see lscm.h; area, and with soft
  /// constraints, which may be many times as large as L: the last relative change.
  double residual = 0;
  int iterations = 0;         ///< solves with the factor
  int attempts = 1;           ///< eigenproblems (or pinned systems) solved until one passed, including fallbacks
  int turning_number = 0;     ///< of the outer boundary loop
  int polish_steps = 0;       ///< steps of SolveOptions::polish from the eigenvector to this map
  double hole_rigidity = 0;   ///< of the form B, see SolveOptions::hole_rigidity
  int unfolded = 0;           ///< flipped triangles that SolveOptions::fold_free unfolded
  bool is_embedding = false;  ///< whether fold_free replaced the map by an embedding
  /// Mean QC of the map that was unfolded or replaced; NaN if there was none.
  double mean_qc_before = unmeasured;
  Method method = Method::spectral;    ///< Method::lscm for three or more hard pins, whatever was requested
  Weights weights = Weights::uniform;  ///< of the energy L
  BoundaryMeasure boundary = BoundaryMeasure::length;  ///< of the form B
  Fallback fallback = Fallback::none;
  int clamped_triangles = 0;                   ///< triangles clamped by Fallback::clamped_triangles
  std::optional<RelaxationStatus> relaxation;  ///< of PatchOptions::area_blend, if any
  /// Standard deviation of log2 of the scale, weighted by area in 3D (Distortion::log2_scale_deviation), of the
  /// conformal map and of this map. NaN without an area blend; unwrap sets the latter whenever it measures.
  double scale_deviation_before = unmeasured;
  double scale_deviation = unmeasured;
  std::vector<Step> steps;  ///< what else was done, and remarks on the map
};

struct Parameterization : SolveRecord {
  ComplexVector z;                                      ///< (V,) u + i v
  std::vector<std::pair<std::string, double>> timings;  ///< seconds per phase, in order
};

/// The method that solves with this many pins. One hard pin translates the map, two also rotate and scale it; three or
/// more deform it, and pinned LSCM replaces Method::spectral. Throws InvalidMesh for methods that cannot hold pins.
Method method_with_pins(const SolveOptions& options, std::size_t n_pins);

/// The solver of one patch; keeps the factor of L + s M between solves.
///
/// Thread safety: different objects may be used in different threads at once. One object serves one thread at a time:
/// every call, including factorize(), changes the factor's work space and the starts of later solves. The progress
/// function is called in the thread of the solve and must not call the same object.
class Solver {
 public:
  /// chart: one disk-like patch; positions: (V, 3), of its vertices. With `fill_holes`, virtual triangles close every
  /// loop but the outer one. metric: one per triangle of the chart, in the frame of its first side, or empty for the
  /// metric of 3D. Throws InvalidMesh if why_not_parameterizable gives a reason or a metric is not positive definite.
  static Solver of(const Chart& chart, const Eigen::Ref<const Positions>& positions, const PatchOptions& options,
                   const std::vector<TriangleMetric>& metric = {});
  /// mesh: one disk-like patch. Pins, extenders and maps are then indexed by mesh vertex (the map is 0 at vertices of
  /// no face). metric: one per face, or null. Throws InvalidMesh if the mesh is not one patch, saying why, and for a
  /// pin or an extender at a vertex of no face.
  static Solver of(const PolygonMesh& mesh, const PatchOptions& options, const SpaceMetric* metric = nullptr);
  ~Solver();
  Solver(Solver&& other) noexcept;

  /// Blends the metric if requested and factors L + s M, raising s a hundredfold (a bounded number of times) while
  /// rounding breaks the factorization. Throws SolveFailure. Called by solve where needed.
  void factorize(const Progress& progress = {});

  /// pins: of chart vertices. Without pins the map is placed (see placement.h), with its area equal to the area in 3D;
  /// Method::lscm then pins the two farthest boundary vertices. One pin: the same map, moved onto it. Several hard
  /// pins: held exactly by pinned LSCM, for methods spectral and lscm. With `soft_pins` they attract the map of
  /// Method::spectral, and a similarity then fits the map to them.
  ///
  /// One rule checks every map (map_check.h): finite, equations satisfied, positive area, and for the spectral method a
  /// turning number of 1, or -1 where the longest loop in 3D is a hole of the map. If an eigenvector fails, it is
  /// solved again from another start and, unless it was raised already, with a larger shift. If that fails too and
  /// SolveOptions::fallbacks allows it (spectral only), the best of some other maps replaces it (fallbacks.h); the
  /// fields of the result and its steps say which. Extenders and hole rigidity change the form B of Method::spectral
  /// and leave the factor; a solve with them has no fallbacks, and fails if they make the map wind around more
  /// than once. Earlier solves do not affect the result, with one exception: at a tolerance above 1e-7, coarser than
  /// single precision, a solve with extenders or hole rigidity starts from the earlier maps, and one with hard pins is
  /// refined only as far as the kept factor needed before. With `fold_free`, flipped
  /// triangles are unfolded, and an embedding replaces a map that winds around more than once, or a missing one;
  /// steps say what was done, its cost, and where it failed.
  ///
  /// Throws SolveFailure if no map passes, InvalidMesh for pins or forces that the method does not support or that all
  /// share one position, and Cancelled.
  Parameterization solve(const SolveOptions& options, const Pins& pins, const Progress& progress = {});

  /// The energy of the chart in 3D, for measuring its maps.
  const ConformalEnergy& energy() const;
  /// Input units per unit of the energy's positions.
  double scale() const;

 private:
  struct State;
  explicit Solver(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace spectral_conformal
