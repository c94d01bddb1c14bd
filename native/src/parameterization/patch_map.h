#pragma once

#include <optional>
#include <vector>

#include "parameterization/spectral_map.h"
#include "parameterization/spectral_problem.h"
#include "parameterization/stopwatch.h"
#include "spectral_conformal/parameterize.h"
#include "spectral_conformal/step.h"

namespace spectral_conformal {

/// One patch, with the data that its solves share.
struct PreparedPatch {
  PatchOptions options;
  SpectralProblem problem;
  bool has_metric = false;
  std::vector<Step> repairs = {};  ///< of its faces
  /// PatchOptions::area_blend, once the patch has the blended metric.
  struct Blend {
    RelaxationStatus status;
    double scale_deviation_before;
    int flipped;  ///< triangles of the relaxed map
  };
  std::optional<Blend> blend = {};
  Timings timings = {};  ///< of the work done once
};

/// The request to a patch.
struct SolveTask {
  PreparedPatch& patch;
  SolveOptions options = {};  ///< with the method that actually solves
  Pins pins = {};
  Pins attractors = {};  ///< soft pins
  Pins held = {};        ///< hard pins: two or more, or any number where constraints hold coordinates

  /// Whether pinned LSCM solves (section 2.2).
  bool is_pinned() const { return options.method == Method::lscm; }
  /// Whether something holds the map where it is.
  bool is_held() const { return !held.empty() || !options.constraints.held.empty(); }
  /// Whether a hole rigidity is given, or is to be chosen for the patch (hole_rigidity.h).
  bool has_rigid_holes() const { return is_free() && options.hole_rigidity != 0.0; }
  /// Whether nothing soft but holes shapes the map: Method::spectral without extenders and soft pins.
  bool is_free() const { return options.method == Method::spectral && !options.has_extenders() && attractors.empty(); }
  /// Whether linear equations constrain the map.
  bool is_constrained() const { return !options.constraints.empty(); }
};

/// What the stages of a solve (parameterize.cpp) pass on: a map, or why there is none yet, and its history.
struct PatchMap {
  Parameterization result;        ///< z is empty if there is no map, or it is not yet placed
  std::optional<Step> rejection;  ///< why there is none
  SpectralMap found;              ///< as its solve left it, except z
  SpectralMap with_free_holes;    ///< see hole_rigidity.h; `whole` is empty if there is none

  void add(const Step& step) { result.steps.push_back(step); }
  /// Sets the map of a solve, or the reason for its rejection. options: those of the solve.
  void set(SpectralMap&& map, const SolveOptions& options);
  /// Copies the numbers of `found`, and moves its z.
  void take_found();
};

/// What may have caused a defect of a map made with these options.
Constraint constraint_of(const SolveOptions& options);

/// Why a map was rejected. Precondition: it was rejected.
Step rejected(const SpectralMap& map, const SolveOptions& options);

}  // namespace spectral_conformal
