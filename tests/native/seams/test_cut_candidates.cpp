#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "meshes.h"
#include "seams/cut_candidates.h"

namespace spectral_conformal::test {
namespace {

/// A mesh of one piece, opened and solved. Keeps what the candidates refer to.
struct SolvedPiece : MirroredPieces {
  Mesh mesh;
  SeamSuggestionOptions options;
  std::unique_ptr<CutPiece> piece;

  explicit SolvedPiece(Mesh given) : MirroredPieces(of(given.view())), mesh(std::move(given)) {
    REQUIRE(pieces.size() == 1);
    PieceSeams opened(pieces[0], 0, mirrors[0], symmetry);
    opened.open();
    piece = std::make_unique<CutPiece>(std::move(opened), options, 0);
    piece->solve({}, {});
  }
  std::vector<Chart> charts_with(const SeamEdges& more) const {
    PolygonMesh view = pieces[0].view();
    const auto edges = seams().changed(more, {});
    view.seam_edges = edges.data();
    view.n_seam_edges = static_cast<int>(edges.size());
    return build_charts(view).charts;
  }
  void replace(std::size_t chart, TrialMap&& mapped) {
    SeamTrial trial{{}, {}, charts(), piece->quality()};
    trial.charts[chart] = std::make_shared<const TrialMap>(std::move(mapped));
    piece->apply(std::move(trial));
  }
  const PieceSeams& seams() const { return piece->seams(); }
  const TrialMaps& charts() const { return piece->charts(); }
  CutCandidates candidates() const { return CutCandidates(*piece); }
};

}  // namespace

TEST_SUITE_BEGIN("cut_candidates");

TEST_CASE("regions come in falling order, of mirrored ones one, and are joined to the boundary") {
  const SolvedPiece spikes(spiky_grid(2, 8));
  const CutCandidates candidates = spikes.candidates();
  for (const auto kind : {CutCandidates::Kind::scale, CutCandidates::Kind::angle}) {
    const auto regions = candidates.regions(kind);
    REQUIRE_FALSE(regions.empty());
    CHECK(std::is_sorted(regions.begin(), regions.end(), [](auto& a, auto& b) { return a.volume > b.volume; }));
    for (const auto& region : regions) {
      const int image = spikes.symmetry.vertex[region.vertex];
      CHECK(std::count_if(regions.begin(), regions.end(),
                          [&](auto& other) { return other.vertex == region.vertex || other.vertex == image; }) == 1);
    }
    const SeamEdges cut = candidates.cut_to(regions.front(), spikes.seams());
    REQUIRE_FALSE(cut.empty());
    CHECK(spikes.charts_with(cut).size() == 1);
  }
}

TEST_CASE("few defective faces are cut out, many are not") {
  SolvedPiece grid(bumpy_grid(30, 30));
  auto broken = *grid.charts().front();
  const int face = static_cast<int>(broken.chart.faces.size()) / 2;
  broken.flipped = {face};
  grid.replace(0, std::move(broken));
  const CutCandidates candidates = grid.candidates();
  const std::vector<Chart> charts = grid.charts_with(candidates.cut_out(0, {face}));
  REQUIRE(charts.size() == 2);
  CHECK(std::min(charts[0].faces.size(), charts[1].faces.size()) == 1);
  std::vector<int> many;
  for (int f = 0; f < 100; ++f) many.push_back(f);
  CHECK(candidates.cut_out(0, many).empty());
}

TEST_CASE("the cut around a region makes an island, and halves are two charts") {
  const SolvedPiece spikes(spiky_grid(2, 8));
  const CutCandidates candidates = spikes.candidates();
  CHECK(spikes.charts_with(candidates.cut_around(candidates.regions(CutCandidates::Kind::scale).front())).size() > 1);
  const auto halves = candidates.halves(candidates.most_distorted());
  REQUIRE_FALSE(halves.empty());
  for (const SeamEdges& cut : halves) CHECK(spikes.charts_with(cut).size() > 1);
}

TEST_CASE("sheets that lie on each other are parted") {
  const SolvedPiece strip(quad_grid(12, 2));
  const auto cuts = strip.candidates().cuts_between(0, {0, 1, 10, 11});
  REQUIRE_FALSE(cuts.empty());
  CHECK(std::any_of(cuts.begin(), cuts.end(), [&](const SeamEdges& cut) {
    const auto charts = strip.charts_with(cut);
    return charts.size() > 1;
  }));
}

TEST_CASE("a chart without a map is halved") {
  SolvedPiece disk(quad_grid(8, 8));
  TrialMap unsolved = *disk.charts()[0];
  unsolved.solved = false;
  disk.replace(0, std::move(unsolved));
  CHECK(disk.charts_with(disk.candidates().halve_unsolved()).size() > 1);
}

TEST_CASE("where all charts have maps none is halved for want of one") {
  CHECK(SolvedPiece(quad_grid(4, 4)).candidates().halve_unsolved().empty());
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
