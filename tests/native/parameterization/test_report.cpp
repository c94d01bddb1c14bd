#include <doctest/doctest.h>

#include <limits>

#include "meshes.h"
#include "parameterization/report.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("report");

TEST_CASE("repairs are counted, a clean chart has none") {
  Chart chart;
  CHECK(describe_repairs(chart, 0).empty());
  chart.reversed_faces = 1;
  chart.duplicates = {4, 7};
  chart.self_intersecting_polygons = 3;
  CHECK(describe_repairs(chart, 5) ==
        "1 face wound the other way: reoriented. 2 duplicate faces: placed on the first of the same vertices. "
        "3 self-intersecting polygons: split as a fan. 5 degenerate triangles: given a minimal height. ");
}

TEST_CASE("relaxing tells what stays flipped") {
  IsometricMap map;
  CHECK(describe_relaxation(map).empty());
  map.flipped = 1;
  CHECK(describe_relaxation(map) == "1 triangle of the relaxed map could not be unfolded. ");
}

TEST_CASE("failures name their reason and what to do, with soft constraints these") {
  SpectralMap map;
  map.rejection = Rejection::unresolved;
  map.attempts = 2;
  CHECK(failure_of(map, {}).what() ==
        std::string("The triangles differ so much in size or shape that double precision does not resolve the map, in "
                    "2 attempts with different shifts and starts: add seams that make the island flatter, or clean up "
                    "degenerate faces."));
  map.rejection = Rejection::winding;
  map.turning_number = 2;
  map.attempts = 1;
  SolveOptions forced;
  forced.hole_rigidity = 1;
  CHECK(failure_of(map, forced).what() ==
        std::string("The boundary of the map winds round 2 times instead of once: lower the hole rigidity."));
  forced.extenders = {{{0}, {1}, 1.0}};
  CHECK(failure_of(map, forced).what() ==
        std::string("The boundary of the map winds round 2 times instead of once: weaken or remove extenders, or lower "
                    "the hole rigidity."));
  forced.hole_rigidity.reset();
  CHECK(failure_of(map, forced).what() ==
        std::string("The boundary of the map winds round 2 times instead of once: weaken or remove extenders."));
  for (const auto rejection : {Rejection::not_factorized, Rejection::not_converged, Rejection::not_finite,
                               Rejection::collapsed, Rejection::unresolved, Rejection::no_area}) {
    map.rejection = rejection;
    for (const auto method : {Method::spectral, Method::lscm}) {
      const SolveFailure failure = failure_of(map, {method});
      CHECK_FALSE(failure.reason().empty());
      CHECK(std::string(failure.what()).back() == '.');
    }
  }
}

TEST_CASE("fallbacks and retries are named") {
  FallbackMap other;
  const SolveFailure failure("No map", "add seams.");
  other.fallback = Fallback::clamped_triangles;
  CHECK(describe_fallback(other, failure) ==
        "No map: solved with triangles thinner than 1e-5 of their length clamped to that instead. ");
  other.fallback = Fallback::other_boundary;
  other.boundary = BoundaryMeasure::vertex;
  CHECK(describe_fallback(other, failure) == "No map: solved with the boundary form 'vertex' instead. ");
  other.fallback = Fallback::other_weights;
  other.weights = Weights::inverse_area;
  CHECK(describe_fallback(other, failure) == "No map: solved with the weights 'inverse_area' instead. ");
  SpectralMap map;
  map.turning_number = 1;
  map.attempts = 1;
  CHECK(describe_attempts(map, {}).empty());
  map.attempts = 2;
  CHECK(describe_attempts(map, {}) ==
        "The first solve failed its checks and was repeated with a larger shift and another start. ");
  map.attempts = 1;
  map.turning_number = 2;
  CHECK(describe_attempts(map, {Method::lscm}) == "The boundary of the map winds round 2 times instead of once. ");
}

TEST_CASE("a rigidity that was lowered is told") {
  CHECK(describe_rigidity(10, 10).empty());
  CHECK(describe_rigidity(std::nullopt, 3).empty());
  CHECK(describe_rigidity(10, 2.5) == "Hole rigidity lowered from 10 to 2.5, which is what the island bears. ");
}

TEST_CASE("an area blend that did little says so, and why") {
  CHECK(describe_blend(1, RelaxationStatus::converged, 0.5, 0.1).empty());
  CHECK(describe_blend(0.1, RelaxationStatus::converged, 0.5, 0.48).empty());
  CHECK(describe_blend(1, RelaxationStatus::stalled, 0.01, 0.01).empty());
  CHECK(describe_blend(1, RelaxationStatus::converged, 0.5, 0.45) ==
        "The area blend lowered the spread of scale by little, from 0.5 to 0.45 (log2); add seams, or clean up "
        "degenerate faces. ");
  CHECK(describe_blend(1, RelaxationStatus::factorization_limit, 0.5, 0.45) ==
        "The area blend lowered the spread of scale by little, from 0.5 to 0.45 (log2): its relaxation stopped at its "
        "bound of factorisations; add seams, or clean up degenerate faces. ");
  CHECK(describe_blend(1, RelaxationStatus::stalled, 0.5, 0.6) ==
        "The area blend did not lower the spread of scale, 0.5 to 0.6 (log2): its relaxation was held up by flipped or "
        "degenerate triangles; add seams, or clean up degenerate faces. ");
  CHECK(describe_blend(1, RelaxationStatus::stalled, std::numeric_limits<double>::infinity(), 0.6).empty());
}

TEST_CASE("unfolding tells what it cost and what it left") {
  FoldFreeMap map;
  map.is_locally_injective = true;
  CHECK(describe_unfolding(map, "", 1, 1, 1, false).empty());
  map.flipped_before = 3;
  CHECK(describe_unfolding(map, "", 1.021234, 1.05, 1, false) ==
        "3 flipped triangles unfolded; mean QC 1.0212 -> 1.05. ");
  map.flipped = 2;
  map.is_locally_injective = false;
  CHECK(describe_unfolding(map, "", 1.25, 1.5, 1, true) ==
        "1 flipped triangle unfolded; mean QC 1.25 -> 1.5. 2 triangles could not be unfolded between the pins; move or "
        "remove pins. ");
  map.flipped = 0;
  map.flipped_before = 0;
  CHECK(describe_unfolding(map, "", 1, 1, 2, false) ==
        "The boundary of the map winds round 2 times instead of once; add seams. ");
  CHECK(describe_unfolding(map, "", 1, 1, 1, true) ==
        "The map goes round an inner vertex more than once; move or remove pins. ");
  map.is_embedding = map.is_locally_injective = true;
  const double none = std::numeric_limits<double>::quiet_NaN();
  CHECK(describe_unfolding(map, "No map", none, 1.5, 1, false) ==
        "No map: replaced by an embedding, relaxed without folding it; mean QC 1.5. ");
  CHECK(describe_unfolding(map, "", 2, 1.5, 1, false) ==
        "The folds left no room to unfold them: replaced by an embedding, relaxed without folding it; mean QC 2 -> "
        "1.5. ");
}

TEST_CASE("triangles below the digits of the coordinates are counted, wherever the map lies") {
  const Patch patch(flat_grid(4, 4));
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  ComplexVector z = flat_map(patch.positions);
  CHECK(describe_unresolved(energy, z).empty());
  z[6] = z[0] + 1e-14;
  z[1] = z[0] + Complex(0, 1e-14);
  z[5] = z[0] - 1e-14;
  CHECK(describe_unresolved(energy, z) ==
        "2 triangles shrink below what double precision resolves; add seams that make the island flatter. ");
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
