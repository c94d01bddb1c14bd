#include <doctest/doctest.h>

#include <limits>

#include "meshes.h"
#include "parameterization/solve_report.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("solve_report");

TEST_CASE("repairs are counted, a clean chart has none") {
  Chart chart;
  CHECK(describe_repairs(chart, 0).empty());
  chart.reversed_faces = 1;
  chart.duplicates = {4, 7};
  chart.self_intersecting_polygons = 3;
  CHECK(describe_repairs(chart, 5) ==
        "1 face wound the other way: turned. 2 duplicate faces: placed on the first of the same vertices. "
        "3 self-intersecting polygons: split as a fan. 5 degenerate triangles: given a minimal height. ");
}

TEST_CASE("relaxing tells what stays flipped") {
  IsometricMap map;
  CHECK(describe_relaxation(map).empty());
  map.flipped = 1;
  CHECK(describe_relaxation(map) == "1 triangle of the relaxed map could not be unfolded. ");
}

TEST_CASE("unfolding tells what it cost and what it left") {
  FoldFreeMap map;
  map.is_locally_injective = true;
  CHECK(describe_unfolding(map, "", 1, 1, 1, false).empty());
  map.folded_before = 3;
  CHECK(describe_unfolding(map, "", 1.021234, 1.05, 1, false) ==
        "3 folded triangles unfolded; mean QC 1.0212 -> 1.05. ");
  map.folded = 2;
  map.is_locally_injective = false;
  CHECK(describe_unfolding(map, "", 1.25, 1.5, 1, true) ==
        "1 folded triangle unfolded; mean QC 1.25 -> 1.5. 2 triangles could not be unfolded between the pins; move or "
        "remove pins. ");
  map.folded = 0;
  map.folded_before = 0;
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
        "2 triangles shrink below what double precision resolves; add seams that make the patch flatter. ");
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
