#include "parameterization/recipe.h"

namespace spectral_conformal {

Recipe recipe_of(const SolveTask& task) {
  const SolveOptions& options = task.options;
  const PatchOptions& patch = task.patch.options;
  const bool is_held = task.is_held();
  const bool is_constrained = task.is_constrained();
  // Polishing would undo a shape that was asked for.
  const bool is_shaped =
      patch.area_blend > 0 || task.patch.has_metric || options.has_extenders_or_rigidity() || !task.attractors.empty();
  Recipe recipe;
  recipe.first = task.is_pinned()         ? Recipe::First::held
                 : task.has_rigid_holes() ? Recipe::First::rigid_holes
                                          : Recipe::First::spectral;
  recipe.retries = recipe.first == Recipe::First::spectral;
  recipe.nears_free = is_constrained && !is_held && task.is_free() && options.fallbacks;
  recipe.polishes = options.polish != Polish::off && !is_shaped && (task.is_free() || is_held);
  // Extenders may be the reason for a rejection: the user should change these.
  recipe.replaces = !task.is_pinned() && !is_constrained && !options.has_extenders() && options.fallbacks;
  recipe.unfolds = options.fold_free;
  recipe.embeds = options.fold_free && !is_held && !is_constrained;
  recipe.fits_to_pins = !task.pins.empty() && !is_held;
  return recipe;
}

}  // namespace spectral_conformal
