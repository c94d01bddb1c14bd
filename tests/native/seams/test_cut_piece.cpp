#include <doctest/doctest.h>

#include <cmath>

#include "meshes.h"
#include "seams/cut_piece.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("cut_piece");

TEST_CASE("a trial changes nothing until it is applied, and known maps are not solved again") {
  const Mesh mesh = sphere(5);
  const MirroredPieces parts = MirroredPieces::of(mesh.view());
  PieceSeams seams(parts.pieces[0], 0, parts.mirrors[0], parts.symmetry);
  seams.open();
  const SeamSuggestionOptions options;
  CutPiece piece(seams, options, 0);
  piece.solve({}, {});
  const double before = piece.value();
  const double open_rings = seams.open_rings({}, {});
  CHECK(before == piece.functional()(seams.cost(seams.edges()), open_rings, piece.charts().size(), piece.quality()));
  // Of the only chart, nothing but the seams and the island would be left.
  const double undistorted =
      seams.cost(seams.edges()) / std::sqrt(piece.quality().area) + island_price * (1 + islands_per_ring * open_rings);
  CHECK(piece.least_value(0) == doctest::Approx(undistorted));
  const double excess = piece.quality().rms_excess / (options.energy_limit - 4);
  CHECK(piece.least_value({}, {}) == doctest::Approx(undistorted + excess));
  const SeamEdges last{seams.edges().back()};
  std::vector<SeamTrial> trials = piece.attempt_all({{SeamEdges{}, last}}, {}, {});
  CHECK(piece.value() == before);
  CHECK(piece.seams().edges() == seams.edges());
  // With the maps known, nothing is solved again.
  const std::int64_t solved = piece.solved_vertices();
  CHECK(piece.attempt({}, last, KnownMaps(trials[0].charts.begin(), trials[0].charts.end()), {}).value ==
        trials[0].value);
  CHECK(piece.solved_vertices() == solved);
  piece.apply(std::move(trials[0]));
  CHECK(piece.seams().edges().size() + 1 == seams.edges().size());
  CHECK(piece.value() != before);
  CHECK(piece.attempt(last, {}, {}, {}).value == doctest::Approx(before));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
