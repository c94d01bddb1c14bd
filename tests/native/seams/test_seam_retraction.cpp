#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "meshes.h"
#include "seams/seam_retraction.h"

namespace spectral_conformal::test {
namespace {

constexpr std::int64_t all_vertices_of_slits = std::numeric_limits<std::int64_t>::max();

/// A sheet with a hill, and a slit from the middle of the border to the top.
struct SlitHill {
  Mesh mesh = hill();
  MirroredPieces parts = MirroredPieces::of(mesh.view());
  SeamSuggestionOptions options;

  static Mesh hill() {
    Mesh grid = quad_grid(12, 12);
    const Eigen::Vector3d top = grid.points[13 * 6 + 6];
    for (Eigen::Vector3d& p : grid.points) p.z() = 6 * std::exp(-0.1 * (p - top).squaredNorm()) + 0.01 * p.x() * p.y();
    return grid;
  }
  PieceSeams seams() const {
    PieceSeams result(parts.pieces[0], 0, parts.mirrors[0], parts.symmetry);
    result.forget_symmetry();
    return result;
  }
  /// The first edges of the slit, from the border.
  SeamEdges slit(int n) const {
    const PieceSeams uncut = seams();
    const std::vector<int>& vertices = parts.pieces[0].vertices;
    const auto vertex = [&](int x) {
      return static_cast<int>(std::find(vertices.begin(), vertices.end(), 13 * 6 + x) - vertices.begin());
    };
    SeamEdges edges;
    for (int x = 0; x < n; ++x) edges.push_back(uncut.graph().find_edge(vertex(x), vertex(x + 1)));
    return edges;
  }
  std::unique_ptr<CutPiece> cut(int n) const {
    PieceSeams some = seams();
    some.add(slit(n));
    auto piece = std::make_unique<CutPiece>(std::move(some), options, 0);
    piece->solve({}, {});
    return piece;
  }
};

}  // namespace

TEST_SUITE_BEGIN("seam_retraction");

TEST_CASE("a slit is taken back from its tip to the edge that a limit needs, whichever limit it is") {
  SlitHill hill;
  hill.options.energy_limit = hill.options.qc_limit = hill.options.scale_limit = 1e6;
  std::vector<MapQuality> with_edges;
  for (int n = 0; n <= 6; ++n) with_edges.push_back(hill.cut(n)->quality());
  for (int n = 1; n <= 6; ++n) {
    CAPTURE(n);
    REQUIRE(with_edges[n].energy < with_edges[n - 1].energy);
    REQUIRE(with_edges[n].mean_qc < with_edges[n - 1].mean_qc);
    for (const bool by_energy : {true, false}) {
      SlitHill limited = hill;
      if (by_energy) limited.options.energy_limit = 0.5 * (with_edges[n].energy + with_edges[n - 1].energy);
      if (!by_energy) limited.options.qc_limit = 0.5 * (with_edges[n].mean_qc + with_edges[n - 1].mean_qc);
      const auto piece = limited.cut(6);
      CHECK(retract_seams(*piece, all_vertices_of_slits, {}) == (n < 6));
      CHECK(piece->seams().edges() == limited.slit(n));
    }
  }
}

TEST_CASE("a slit that no limit needs goes, and none where no vertex may be solved for") {
  SlitHill hill;
  hill.options.energy_limit = hill.options.qc_limit = hill.options.scale_limit = 1e6;
  const auto piece = hill.cut(6);
  CHECK_FALSE(retract_seams(*piece, 0, {}));
  CHECK(piece->seams().edges().size() == 6);
  CHECK(retract_seams(*piece, all_vertices_of_slits, {}));
  CHECK(piece->seams().edges().empty());
}

TEST_CASE("seams that exceed a limit already are taken back where that exceeds it no further") {
  SlitHill hill;
  hill.options.energy_limit = 4 + 1e-9;
  hill.options.qc_limit = hill.options.scale_limit = 1e6;
  const auto piece = hill.cut(6);
  const double energy = piece->quality().energy;
  retract_seams(*piece, all_vertices_of_slits, {});
  CHECK(piece->quality().energy <= energy);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
