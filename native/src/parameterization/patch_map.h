#pragma once

#include <optional>
#include <vector>

#include "parameterization/spectral_map.h"
#include "parameterization/spectral_problem.h"
#include "parameterization/stopwatch.h"
#include "spectral_conformal/parameterize.h"
#include "spectral_conformal/step.h"

namespace spectral_conformal {

/// One patch, and what its solves share.
struct PreparedPatch {
  PatchOptions options;
  SpectralProblem problem;
  bool has_metric = false;
  std::vector<Step> repairs = {};  ///< of its faces
  /// Of PatchOptions::area_blend, once the metric is that of the blend.
  struct Blend {
    RelaxationStatus status;
    double scale_deviation_before;
    int flipped;  ///< triangles of the relaxed map
  };
  std::optional<Blend> blend = {};
  Timings timings = {};  ///< of what is done once
};

/// What is asked of a patch.
struct SolveTask {
  PreparedPatch& patch;
  SolveOptions options;  ///< with the method that solves
  Pins pins;
  Pins attractors;  ///< soft pins
  Pins held;        ///< hard pins, two or more

  /// Whether pinned LSCM solves (section 2.2).
  bool is_pinned() const { return options.method == Method::lscm; }
  /// Whether a hole rigidity is given or to be chosen for the patch (hole_rigidity.h).
  bool has_rigid_holes() const { return is_free() && options.hole_rigidity != 0.0; }
  /// Whether nothing but the patch shapes the map: Method::spectral without extenders and soft pins.
  bool is_free() const { return options.method == Method::spectral && !options.has_extenders() && attractors.empty(); }
};

/// What the stages of a solve (parameterize.cpp) hand on: a map, or why there is none yet, and how it came about.
struct PatchMap {
  Parameterization result;        ///< z is empty where there is no map
  std::optional<Step> rejection;  ///< why there is none
  SpectralMap found;              ///< as its solve left it, but for z
  SpectralMap with_free_holes;    ///< see hole_rigidity.h; its z is empty where there is none

  void add(const Step& step) { result.steps.push_back(step); }
  /// The map of a solve, or why it was rejected: options are those of the solve.
  void take(SpectralMap&& map, const SolveOptions& options);
  /// The numbers of `found`, and its z.
  void take_found();
};

/// Why a map was rejected. Precondition: it was.
Step rejected(const SpectralMap& map, const SolveOptions& options);

}  // namespace spectral_conformal
