#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

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

/// What stands in for the map of a problem whose own attempts had failed (see SolveOptions::fallbacks).
enum class Fallback {
  none,
  unfolded,           ///< that map, its boundary winding round once after flipped triangles were unfolded
  clamped_triangles,  ///< thin triangles were given a minimal height in the energy
  other_boundary,     ///< the form B with the other BoundaryMeasure
  other_weights,      ///< the energy L with the other Weights
  tutte_embedding     ///< a relaxed Tutte embedding
};

/// What an eigenvalue belongs to.
enum class EigenvalueOf {
  eigenvector,  ///< of the problem that was solved
  map           ///< the quotient of Eq. 5 of a map that is no eigenvector: pinned, polished, unfolded or replaced
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
};

/// What one solve of a Solver may vary.
struct SolveOptions {
  Method method = Method::spectral;
  double tolerance = 1e-8;               ///< see EigenproblemOptions
  double soft_pins = 0;                  ///< strength of pins as a soft force (see pin_attraction.h); 0: held exactly
  std::vector<Extender> extenders = {};  ///< of chart vertices; for Method::spectral
  /// For Method::spectral: beta of ExtendedForm::add_spread for every loop but the outer one. Lowered as far as the
  /// patch asks for, where there are no extenders and no soft pins; none: chosen per patch (hole_rigidity.h), 0 with
  /// these.
  std::optional<double> hole_rigidity = 0.0;
  /// Whether Method::spectral may take another map where its own fails: unfolded, an embedding, or that of another
  /// problem (fallbacks.h). When false, that failure is the answer; the embedding that `fold_free` asks for is made
  /// either way.
  bool fallbacks = true;
  /// Whether flipped triangles are unfolded and parts moved apart that cover each other, or the map is replaced by an
  /// embedding, at some cost in distortion; what stays flipped or covered is reported. See fold_free_map.h.
  bool fold_free = false;
  /// Whether maps of Method::spectral without pins, soft constraints or a metric go on from the eigenvector to a lower
  /// mean QC (polish.h), where they find one.
  bool polish = false;
  /// Whether a problem whose map fails the checks is solved once more, with another start and a larger shift unless
  /// that was raised already.
  bool second_attempt = true;
  bool has_extenders() const;              ///< whether extenders change the form B
  bool has_extenders_or_rigidity() const;  ///< whether these or a given hole rigidity do
};

/// The numbers of a map, and what was really solved for it.
struct SolveRecord {
  double eigenvalue = 0;  ///< z^H L z / z^H B z in the units of the input: lambda of Eq. 5 for an eigenvector
  EigenvalueOf eigenvalue_of = EigenvalueOf::eigenvector;
  /// |L z - lambda B z|_2 / (largest diagonal entry of L x |z|_2); lscm: see lscm.h; area, and with soft constraints:
  /// the last relative change.
  double residual = 0;
  int iterations = 0;         ///< solves with the factor
  int attempts = 1;           ///< eigenproblems (or pinned systems) solved until one passed, fallbacks included
  int turning_number = 0;     ///< of the outer boundary loop
  int polish_steps = 0;       ///< steps of PatchOptions::polish from the eigenvector to this map
  double hole_rigidity = 0;   ///< of the form B, see SolveOptions::hole_rigidity
  int unfolded = 0;           ///< flipped triangles that PatchOptions::fold_free has unfolded
  bool is_embedding = false;  ///< whether it had to replace the map by an embedding
  /// Mean QC of the map that was unfolded or replaced; not a number where there was none.
  double mean_qc_before = std::numeric_limits<double>::quiet_NaN();
  Method method = Method::spectral;    ///< Method::lscm for three or more hard pins, whichever was asked for
  Weights weights = Weights::uniform;  ///< of the energy L
  BoundaryMeasure boundary = BoundaryMeasure::length;  ///< of the form B
  Fallback fallback = Fallback::none;
  int clamped_triangles = 0;                   ///< those that Fallback::clamped_triangles gave a minimal height
  std::optional<RelaxationStatus> relaxation;  ///< of PatchOptions::area_blend, where there was one
  /// Standard deviation of log2 of the scale, weighted by area in 3D (Distortion::log2_scale_deviation): of the
  /// conformal map, and of this one. Not a number without an area blend.
  double scale_deviation_before = std::numeric_limits<double>::quiet_NaN();
  double scale_deviation = std::numeric_limits<double>::quiet_NaN();
  std::vector<Step> steps;  ///< what was done besides, and what there is to say of the map
};

struct Parameterization : SolveRecord {
  ComplexVector z;                                      ///< (V,) u + i v
  std::vector<std::pair<std::string, double>> timings;  ///< seconds per phase, in order
};

/// The method that solves with this many pins. One hard pin moves the map, two turn and scale it; from three on they
/// bend it, and are held by pinned LSCM where Method::spectral was asked for. Throws InvalidMesh for methods that hold
/// none.
Method method_with_pins(const SolveOptions& options, std::size_t n_pins);

/// The solver of one patch; keeps the factor of L + s M between solves.
///
/// Thread-safety: different objects may be used in different threads at once. One object is for one thread at a time:
/// every call, factorize() included, changes the factor's work space and the starts of later solves. A progress
/// function is called in the thread of the solve and must not call the same object.
class Solver {
 public:
  /// chart: one disk-like patch; positions (V, 3) of its vertices. With `fill_holes` every loop but the outer one is
  /// closed by virtual triangles. metric: one per triangle of the chart, in the frame of its first side, or empty for
  /// the metric of space. Throws InvalidMesh when why_not_parameterizable says so, or a metric is not positive
  /// definite.
  Solver(const Chart& chart, const Eigen::Ref<const Positions>& positions, const PatchOptions& options,
         const std::vector<TriangleMetric>& metric = {});
  /// A mesh that is one disk-like patch; pins, extenders and maps are then those of mesh vertices (0 in the map where
  /// no face uses one). metric: one per face, or null. Throws InvalidMesh that says what the mesh is instead of one
  /// patch, and for a pin or an extender of a vertex that no face uses.
  Solver(const PolygonMesh& mesh, const PatchOptions& options, const SpaceMetric* metric = nullptr);
  ~Solver();
  Solver(Solver&& other) noexcept;
  Solver& operator=(Solver&& other) noexcept;

  /// Blends the metric where that was asked for, and factors L + s M, raising s a hundredfold while rounding breaks the
  /// factorization (bounded). Throws SolveFailure. Called by solve where needed.
  void factorize(const Progress& progress = {});

  /// pins: of chart vertices. Without pins (for Method::lscm: two farthest boundary vertices) the map is placed (see
  /// placement.h), with its area equal to the area in 3D. One pin: the same map moved onto it. Several hard pins: held
  /// exactly by pinned LSCM, where the method is spectral or lscm. With `soft_pins` they attract the map of
  /// Method::spectral, which then comes with the similarity that fits it to them.
  ///
  /// Every map is checked by one rule (map_check.h): finite, equations satisfied, positive area, and for the spectral
  /// method a turning number of 1, or -1 where the longest loop in 3D is a hole of the map. An eigenvector that fails
  /// is solved again with another start and, unless it was raised already, a larger shift, then, where
  /// SolveOptions::fallbacks allows it (spectral only), gives way to the best of some other maps (fallbacks.h); the
  /// fields of the result and its steps say which. Extenders and hole rigidity change the form
  /// B of Method::spectral and leave the factor; a solve with them has no fallbacks, and fails where they are so strong
  /// that the map winds round more than once. What was solved before changes nothing, except that with a tolerance
  /// above 1e-7, less than single precision stores, a solve with them starts from the earlier maps. With `fold_free`
  /// flipped triangles are unfolded, and a map that winds round more than once, or none, is replaced by an embedding;
  /// steps say what was done, what that cost, and where it could not be done.
  ///
  /// Throws SolveFailure when nothing passes, InvalidMesh for pins or forces that the method does not take or that all
  /// have one position, and Cancelled.
  Parameterization solve(const SolveOptions& options, const Pins& pins, const Progress& progress = {});

  /// Of the chart in 3D, for measures of its maps.
  const ConformalEnergy& energy() const;
  /// Input units per unit of the energy's positions.
  double scale() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace spectral_conformal
