#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>

#include "meshes.h"
#include "seams/cutter.h"

namespace spectral_conformal::test {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

PieceSeams opened(const Mesh& mesh, std::vector<Piece>& pieces) {
  MirroredPieces parts = MirroredPieces::of(mesh.view());
  pieces = std::move(parts.pieces);
  PieceSeams seams(pieces[0], 0, parts.mirrors[0], parts.symmetry);
  seams.open();
  return seams;
}

/// Long arms around a corner lie on each other in the map of what is cut open only.
Mesh long_arms() {
  return cell_surface(9, [](int i, int j, int k) {
    return k < 1 && (j == 0 || i == 8 || j == 8 || (i == 0 && j > 1) || (j == 2 && i < 7) || (i == 6 && j < 7));
  });
}

/// Ramps of one and a half turns, flat but for a slight rise, side by side on a strip: each covers itself and the
/// strip.
Mesh ramps(int n) {
  Mesh mesh;
  constexpr int per_turn = 32;
  const int columns = 14 * n;
  const auto on_strip = [&](int i, int j) { return j * (columns + 1) + i; };
  for (int j = 0; j <= 2; ++j) {
    for (int i = 0; i <= columns; ++i) mesh.points.emplace_back(0.5 * i, 0.5 * j - 1, 0);
  }
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < columns; ++i) {
      mesh.add({on_strip(i, j), on_strip(i + 1, j), on_strip(i + 1, j + 1), on_strip(i, j + 1)});
    }
  }
  for (int ramp = 0; ramp < n; ++ramp) {
    const double center = 7 * ramp + 3;
    std::array<int, 3> before{};
    for (int r = 0; r < 3; ++r) before[r] = on_strip(2 * (7 * ramp + 4) + r, 2);
    for (int step = 1; step <= 3 * per_turn / 2; ++step) {
      const double angle = 2 * pi * step / per_turn;
      std::array<int, 3> after{};
      for (int r = 0; r < 3; ++r) {
        after[r] = static_cast<int>(mesh.points.size());
        mesh.points.emplace_back(center + (1 + 0.5 * r) * std::cos(angle), (1 + 0.5 * r) * std::sin(angle),
                                 0.01 * step);
      }
      for (int r = 0; r < 2; ++r) mesh.add({before[r], before[r + 1], after[r + 1], after[r]});
      before = after;
    }
  }
  return mesh;
}

TrialMaps maps_of(const Piece& piece, const std::vector<std::array<int, 2>>& seams) {
  PolygonMesh view = piece.view();
  view.seam_edges = seams.data();
  view.n_seam_edges = static_cast<int>(seams.size());
  TrialMaps charts;
  for (Chart& chart : build_charts(view).charts) {
    charts.push_back(std::make_shared<const TrialMap>(solve_trial_map(view, std::move(chart), {}, false, {})));
  }
  return charts;
}

bool is_sound(const TrialMaps& charts) {
  return map_quality(charts, 2).solved &&
         std::all_of(charts.begin(), charts.end(), [](const auto& mapped) { return defective_faces(*mapped).empty(); });
}

/// The next cuts; once there are none, what follows them.
SeamEdges step(Cutter& cutter, double longest) {
  SeamEdges cut = cutter.cut(longest, {});
  if (cut.empty()) cutter.conclude(longest, {});
  return cut;
}

}  // namespace

TEST_SUITE_BEGIN("cutter");

TEST_CASE("where only the mean QC is beyond its limit cuts have to pay for their length") {
  const Mesh mesh = sphere(10);
  const auto searched = [&](double qc_gain, double mesh_area) {
    std::vector<Piece> pieces;
    SeamSuggestionOptions options;
    options.qc_limit = 1;
    options.qc_gain = qc_gain;
    options.energy_limit = options.scale_limit = 1e6;
    Cutter cutter(opened(mesh, pieces), options, {static_cast<int>(mesh.points.size()), false, false, mesh_area});
    cutter.solve({});
    const double before = cutter.quality().mean_qc;
    const double uncut = cutter.seams().length(cutter.seams().edges());
    while (!step(cutter, unlimited).empty()) {
    }
    const double length = cutter.seams().length(cutter.seams().edges()) - uncut;
    return std::array<double, 3>{length, before - cutter.quality().mean_qc, cutter.quality().area};
  };
  const auto [none, nothing, area] = searched(1, 0);
  CHECK(none <= 0);
  CHECK(nothing == doctest::Approx(0));
  const auto [length, gained, same] = searched(0.002, 0);
  CHECK(length > 0);
  CHECK(gained >= 0.002 * length / std::sqrt(area));
  CHECK(searched(0.001, 4 * area) == std::array<double, 3>{length, gained, same});
}

TEST_CASE("strips longer than the sheet are halved, in the end") {
  const Mesh strip = quad_grid(32, 2);
  const auto sides = [&](double sheet_side, double longest) {
    std::vector<Piece> pieces;
    const SeamSuggestionOptions options;
    Cutter::Stage stage{static_cast<int>(strip.points.size())};
    stage.sheet_side = sheet_side;
    Cutter cutter(opened(strip, pieces), options, stage);
    cutter.solve({});
    while (!cutter.finished()) step(cutter, longest);
    std::vector<double> result;
    for (const auto& mapped : cutter.charts()) result.push_back(longer_side(*mapped));
    return result;
  };
  CHECK(sides(unlimited, unlimited).size() == 1);
  CHECK(sides(31, unlimited).size() == 1);  // a cut costs more
  // A strip that mirrors itself gets two cuts, or one in the middle.
  for (const double sheet : {16.0, 9.0}) {
    const std::vector<double> parts = sides(sheet, unlimited);
    CHECK(parts.size() > 1);
    CHECK(parts.size() < 2 * 32 / sheet);
    // What is left costs less than a cut of length 2 at the price 2, and an island twice: 4.8 as the root of the area
    // is 8.
    CHECK(*std::max_element(parts.begin(), parts.end()) < sheet + 4.8);
  }
  CHECK(sides(9, 1).size() == 1);  // less than a cut
}

TEST_CASE("every step lowers the functional, until the limits are met") {
  // A limit that is exceeded by less than a cut costs stays so, as on a torus of 30 times 14 faces.
  for (const Mesh& mesh : {spiky_grid(2, 8), sphere(6), torus(28, 11)}) {
    std::vector<Piece> pieces;
    SeamSuggestionOptions options;
    options.energy_limit = 4.3;
    options.scale_limit = 2;
    Cutter cutter(opened(mesh, pieces), options, {});
    cutter.solve({});
    const std::int64_t of_the_start = cutter.solved_vertices();
    CHECK(of_the_start >= static_cast<int>(mesh.points.size()));
    int steps = 0;
    double before = cutter.value();
    bool was_sound = cutter.is_sound();
    while (!step(cutter, unlimited).empty()) {
      ++steps;
      REQUIRE(steps < 100);
      // Charts that cover themselves are parted at any price.
      CHECK((cutter.value() < before || !was_sound));
      before = cutter.value();
      was_sound = cutter.is_sound();
    }
    CHECK(cutter.value() <= before);
    CHECK(steps > 0);
    CHECK(cutter.solved_vertices() > of_the_start);
    CHECK(cutter.finished());
    CHECK(cutter.quality().within_limit >= 0.95);
    CHECK(cutter.quality().mean_qc <= options.qc_limit);
    CHECK(cutter.quality().energy <= options.energy_limit);
  }
}

TEST_CASE("of a large piece whose copy was cut already, less is solved for, and no defect is left either") {
  std::int64_t solved[2] = {0, 0};
  for (const Mesh& mesh : {long_arms(), spiky_grid(6, 8)}) {
    for (const bool is_large : {false, true}) {
      std::vector<Piece> pieces;
      const SeamSuggestionOptions options;
      Cutter cutter(opened(mesh, pieces), options, {is_large ? 100000 : 5000, true, is_large});
      cutter.solve({});
      while (!step(cutter, unlimited).empty()) {
      }
      CHECK(is_sound(maps_of(pieces[0], cutter.seams().changed({}, {}))));
      solved[is_large ? 1 : 0] += cutter.solved_vertices();
    }
  }
  CHECK(solved[1] < solved[0]);
}

TEST_CASE("a piece is not cut within the limits, though that would lower the functional, but beyond them") {
  const Mesh mesh = spiky_grid(2, 8);
  const int n = static_cast<int>(mesh.points.size());
  const auto is_cut = [&](const Cutter::Stage& stage, double energy_limit) {
    std::vector<Piece> pieces;
    SeamSuggestionOptions options;
    options.energy_limit = energy_limit;
    options.scale_limit = options.qc_limit = 1000;
    Cutter cutter(opened(mesh, pieces), options, stage);
    cutter.solve({});
    REQUIRE(cutter.is_sound());
    return !step(cutter, unlimited).empty();
  };
  constexpr double beyond = 4.3;
  constexpr double within = 40;
  const Cutter::Stage whole{n, false, false}, copy{4 * n, true, false}, finest{n, true, true};
  for (const Cutter::Stage& stage : {whole, copy, finest}) {
    CHECK_FALSE(is_cut(stage, within));
    CHECK(is_cut(stage, beyond));
  }
  CHECK(is_cut({4 * n, true, true}, within));  // a copy of a large piece
}

TEST_CASE("many places where a chart covers itself are cut in one step, though each cut removes one") {
  const Mesh mesh = ramps(4);
  std::vector<Piece> pieces;
  SeamSuggestionOptions options;
  options.qc_limit = options.energy_limit = options.scale_limit = 1e6;  // the map is as good as can be
  Cutter cutter(opened(mesh, pieces), options, {});
  cutter.solve({});
  REQUIRE(cutter.quality().solved);
  REQUIRE_FALSE(is_sound(maps_of(pieces[0], cutter.seams().changed({}, {}))));
  CHECK_FALSE(step(cutter, unlimited).empty());
  CHECK(maps_of(pieces[0], cutter.seams().changed({}, {})).size() == 5);
  int steps = 1;
  while (!step(cutter, unlimited).empty()) ++steps;
  CHECK(steps <= 3);
  CHECK(is_sound(maps_of(pieces[0], cutter.seams().changed({}, {}))));
}

TEST_CASE("in the end no chart covers itself or has a flipped face, and no seam is left that can be sewn up") {
  const Mesh mesh = long_arms();
  std::vector<Piece> pieces;
  const SeamSuggestionOptions options;
  Cutter cutter(opened(mesh, pieces), options, {});
  cutter.solve({});
  while (!step(cutter, unlimited).empty()) {
  }
  CHECK(is_sound(maps_of(pieces[0], cutter.seams().changed({}, {}))));
  CHECK(cutter.quality().energy <= options.energy_limit);
  const PieceSeams& seams = cutter.seams();
  for (const SeamChain& chain : seams.chains()) {
    const SeamEdges whole = seams.with_cut_images(chain.edges);
    const TrialMaps charts = maps_of(pieces[0], seams.changed({}, whole));
    const double cost = seams.cost(seams.edges()) - seams.cost(whole) + seams.turning({}, whole);
    const double value = SeamFunctional(options)(cost, seams.open_rings({}, whole), charts.size(),
                                                 map_quality(charts, options.scale_limit));
    CHECK_FALSE((is_sound(charts) && value < cutter.value()));
  }
}

TEST_CASE("no step is longer than allowed") {
  std::vector<Piece> pieces;
  const SeamSuggestionOptions options;
  const Mesh mesh = spiky_grid(2, 8);
  Cutter cutter(opened(mesh, pieces), options, {});
  cutter.solve({});
  const double before = cutter.quality().distortion();
  CHECK(step(cutter, 0.5).empty());
  CHECK(cutter.finished());
  CHECK(cutter.quality().distortion() == before);
  Cutter other(opened(mesh, pieces), options, {});
  other.solve({});
  for (SeamEdges cut = step(other, 20); !cut.empty(); cut = step(other, 20)) {
    CHECK(other.seams().length(cut) <= 20);
  }
}

TEST_CASE("a good map is left alone") {
  std::vector<Piece> pieces;
  const SeamSuggestionOptions options;
  const Mesh mesh = bumpy_grid(6, 6);
  Cutter cutter(opened(mesh, pieces), options, {});
  cutter.solve({});
  CHECK(step(cutter, unlimited).empty());
}

TEST_CASE("where the first map fails the surface is cut further") {
  // A tall closed tower, slit along its foot only: its map shrinks beyond what double precision resolves.
  Mesh mesh = cell_surface(60, [](int i, int j, int k) { return i < 2 && j < 2 && k < 60; });
  mesh.seams = {{0, 1}};
  std::vector<Piece> pieces;
  const SeamSuggestionOptions options;
  Cutter cutter(opened(mesh, pieces), options, {});
  cutter.solve({});
  while (!step(cutter, unlimited).empty()) {
  }
  CHECK(cutter.quality().solved);
  CHECK(cutter.quality().within_limit >= 0.95);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
