#pragma once

#include "parameterization/patch_map.h"

namespace spectral_conformal {

/// Which stages of a solve act, in their order. Only this decides it: a stage itself asks no more than whether there is
/// something to improve.
struct Recipe {
  enum class First {
    held,         ///< LSCM, which pins hold (held_map.h)
    rigid_holes,  ///< the paper's map with several B (hole_rigidity.h)
    spectral      ///< the paper's map (attempts.h)
  };
  First first = First::spectral;
  bool retries = false;       ///< a rejected first map (attempts.h); rigid holes retry by themselves
  bool nears_free = false;    ///< a constrained map that folds, toward the free one (constrained_map.h)
  bool polishes = false;      ///< a map (polishing.h)
  bool replaces = false;      ///< a rejected map, unless rigid holes may be the reason (fallbacks.h)
  bool unfolds = false;       ///< a map (unfolding.h)
  bool embeds = false;        ///< a patch without a map (unfolding.h)
  bool fits_to_pins = false;  ///< a map that its pins do not hold (held_map.h)
};

Recipe recipe_of(const SolveTask& task);

}  // namespace spectral_conformal
