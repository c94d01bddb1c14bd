#include <doctest/doctest.h>

#include "parameterization/recipe.h"
#include "problems.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("recipe");

namespace {

/// A task to be changed, with everything asked for that a free map can have.
struct Request {
  PreparedPatch patch = prepared(problem_of(Patch(bumpy_grid(6, 5))));
  SolveTask task{patch, {}, {}, {}, {}};
  Request() {
    task.options.polish = Polish::angles;
    task.options.fold_free = true;
  }
  Recipe recipe() const { return recipe_of(task); }
};

const Pins two{{0, 0.0}, {3, 1.0}};

}  // namespace

TEST_CASE("a free map is spectral, tried again, polished, replaced and unfolded") {
  Request free;
  const Recipe recipe = free.recipe();
  CHECK((recipe.first == Recipe::First::spectral && recipe.retries && recipe.polishes && recipe.replaces));
  CHECK((recipe.unfolds && recipe.embeds && !recipe.nears_free && !recipe.fits_to_pins));
  free.task.options.polish = Polish::off;
  free.task.options.fold_free = free.task.options.fallbacks = false;
  const Recipe bare = free.recipe();
  CHECK_FALSE((bare.polishes || bare.replaces || bare.unfolds || bare.embeds));
}

TEST_CASE("holes ask for several forms, one map each") {
  Request rigid;
  rigid.task.options.hole_rigidity = 1;
  CHECK((rigid.recipe().first == Recipe::First::rigid_holes && !rigid.recipe().retries && !rigid.recipe().polishes));
  rigid.task.options.hole_rigidity.reset();
  CHECK((rigid.recipe().first == Recipe::First::rigid_holes && rigid.recipe().polishes));
}

TEST_CASE("a shape that was asked for is not polished away") {
  const auto polishes = [](auto change) {
    Request request;
    change(request);
    return request.recipe().polishes;
  };
  CHECK(polishes([](Request&) {}));
  CHECK_FALSE(polishes([](Request& r) { r.patch.has_metric = true; }));
  CHECK_FALSE(polishes([](Request& r) { r.patch.options.area_blend = 0.5; }));
  CHECK_FALSE(polishes([](Request& r) { r.task.options.extenders = {{{0}, {5}, 1}}; }));
  CHECK_FALSE(polishes([](Request& r) { r.task.attractors = two; }));
}

TEST_CASE("pins hold a map, or it is fitted to them; a map that is held is not embedded") {
  Request held;
  held.task.options.method = Method::lscm;
  held.task.options.hole_rigidity = 0;
  held.task.pins = {{0, 1.0}};
  CHECK((held.recipe().first == Recipe::First::held && held.recipe().fits_to_pins && !held.recipe().replaces));
  held.task.pins = held.task.held = two;
  const Recipe recipe = held.recipe();
  CHECK((recipe.polishes && recipe.unfolds && !recipe.embeds && !recipe.fits_to_pins && !recipe.retries));
}

TEST_CASE("an extender is not replaced; a constrained map nears the free one") {
  Request pulled;
  pulled.task.options.extenders = {{{0}, {5}, 1}};
  CHECK((!pulled.recipe().replaces && pulled.recipe().retries));
  Request constrained;
  constrained.task.options.constraints.add({{1, 1.0}, {3, -1.0}});
  const Recipe recipe = constrained.recipe();
  CHECK((recipe.nears_free && !recipe.replaces && !recipe.embeds && recipe.unfolds && recipe.polishes));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
