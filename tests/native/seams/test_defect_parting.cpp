#include <doctest/doctest.h>

#include "meshes.h"
#include "seams/defect_parting.h"

namespace spectral_conformal::test {
namespace {

constexpr DefectParting::Limits no_limits{1e9, 1000000, false};

CutPiece& solved(CutPiece& piece) {
  piece.solve({}, {});
  return piece;
}

PieceSeams opened_seams(const MirroredPieces& parts) {
  PieceSeams seams(parts.pieces[0], 0, parts.mirrors[0], parts.symmetry);
  seams.open();
  return seams;
}

}  // namespace

TEST_SUITE_BEGIN("defect_parting");

TEST_CASE("a sound map is left alone") {
  const Mesh mesh = bumpy_grid(6, 6);
  const MirroredPieces parts = MirroredPieces::of(mesh.view());
  const SeamSuggestionOptions options;
  CutPiece piece(opened_seams(parts), options, 0);
  DefectParting parting = DefectParting::of(solved(piece), options, no_limits, {});
  CHECK(parting.is_sound());
  CHECK(parting.part({}).added.empty());
}

TEST_CASE("arms that lie on each other are parted, as far as that is not too long") {
  const Mesh mesh = cell_surface(9, [](int i, int j, int k) {
    return k < 1 && (j == 0 || i == 8 || j == 8 || (i == 0 && j > 1) || (j == 2 && i < 7) || (i == 6 && j < 7));
  });
  const MirroredPieces parts = MirroredPieces::of(mesh.view());
  const SeamSuggestionOptions options;
  CutPiece piece(opened_seams(parts), options, 0);
  DefectParting parting = DefectParting::of(solved(piece), options, no_limits, {});
  REQUIRE_FALSE(parting.is_sound());
  const SeamTrial trial = parting.part({});
  CHECK_FALSE(trial.added.empty());
  CHECK(DefectParting::of(piece, options, {0, 1000000, false}, {}).part({}).added.empty());
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
