#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "spectral_conformal/island_packing.h"

namespace spectral_conformal::test {
namespace {

/// L-shaped islands of several sizes, and a frame, the last, that stays.
PackingIslands hooks(int n, bool with_obstacle) {
  const std::vector<Complex> shape{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {0, 2}};
  PackingIslands islands;
  islands.face_offsets.push_back(0);
  std::vector<Complex> points;
  const auto add = [&](double size, Complex at, int island) {
    for (const Complex z : shape) {
      islands.corners.push_back(static_cast<int>(points.size()));
      points.push_back(at + size * z);
    }
    islands.face_offsets.push_back(static_cast<int>(points.size()));
    islands.island_of_face.push_back(island);
  };
  for (int k = 0; k < n; ++k) add(20 + 5 * (k % 4), Complex(100 * k, 0), k);
  if (with_obstacle) add(60, {50, 50}, -1);
  islands.points = Eigen::Map<ComplexVector>(points.data(), static_cast<Eigen::Index>(points.size()));
  islands.region.assign(static_cast<std::size_t>(n), -1);
  return islands;
}

PackingOptions tile(double margin) {
  PackingOptions options;
  options.regions = {{{0, 0}, {256, 256}}};
  options.margin = margin;
  return options;
}

}  // namespace

TEST_SUITE_BEGIN("island_packing");

TEST_CASE("without scaling, those that fit are packed and the others stay") {
  PackingOptions options = tile(4);
  options.scales = false;
  const IslandPacking all = IslandPacking::begin(hooks(4, false), options);
  CHECK(std::count(all.has_room().begin(), all.has_room().end(), true) == 4);
  const IslandPacking some = IslandPacking::begin(hooks(40, false), options);
  const auto packed = std::count(some.has_room().begin(), some.has_room().end(), true);
  CHECK(packed > 5);
  CHECK(packed < 40);
}

TEST_CASE("upright straightens leaning islands, and quarters keep them leaning") {
  PackingIslands islands = hooks(9, false);
  const PackingIslands straight = islands;
  islands.points *= std::polar(1.0, 0.3);
  islands.keeps_turn.assign(9, false);
  islands.keeps_turn[4] = true;
  PackingOptions options = tile(4);
  const auto lean = [](const PlaneMotion& motion, double before) {
    const Complex turn = motion.factor * std::polar(1.0, before) / std::abs(motion.factor);
    return std::abs(std::arg(turn * turn * turn * turn)) / 4;
  };
  for (const PackingTurns turns : {PackingTurns::quarters, PackingTurns::upright}) {
    options.turns = turns;
    const IslandPacking packing = IslandPacking::begin(islands, options);
    for (std::size_t i = 0; i < 9; ++i) {
      const bool stays_leaning = turns == PackingTurns::quarters || i == 4;
      CHECK(lean(packing.motions()[i], 0.3) == doctest::Approx(stays_leaning ? 0.3 : 0.0));
    }
  }
  // Straight islands are packed as with quarters.
  CHECK(IslandPacking::begin(straight, options).scale() == IslandPacking::begin(straight,
                                                                                [&] {
                                                                                  options.turns =
                                                                                      PackingTurns::quarters;
                                                                                  return options;
                                                                                }())
                                                               .scale());
}

TEST_CASE("square turns rectilinear islands by quarters once they are straight, and others freely") {
  PackingIslands islands = hooks(9, false);
  islands.points *= std::polar(1.0, 0.3);
  // The last one is a triangle.
  const int n_points = static_cast<int>(islands.points.size());
  islands.points.conservativeResize(n_points + 3);
  islands.points.tail(3) << Complex(5000, 0), Complex(5300, 10), Complex(5160, 90);
  for (int k = 0; k < 3; ++k) islands.corners.push_back(n_points + k);
  islands.face_offsets.push_back(static_cast<int>(islands.corners.size()));
  islands.island_of_face.push_back(9);
  islands.region.push_back(-1);
  PackingOptions options = tile(4);
  options.turns = PackingTurns::square;
  const IslandPacking packing = IslandPacking::begin(islands, options);
  for (std::size_t i = 0; i < 10; ++i) {
    const Complex turn = std::polar(1.0, 0.3) * packing.motions()[i].factor / std::abs(packing.motions()[i].factor);
    const double lean = std::abs(std::arg(turn * turn * turn * turn)) / 4;
    CHECK((lean < 1e-9) == (i < 9));
  }
}

TEST_CASE("islands below the least size are enlarged to it, the others share one scale") {
  PackingIslands islands = hooks(12, false);
  // The last hook is a hundredth as large as the others.
  for (Eigen::Index k = islands.points.size() - 6; k < islands.points.size(); ++k) {
    islands.points[k] = Complex(1100, 0) + 0.01 * (islands.points[k] - Complex(1100, 0));
  }
  const double length = 0.01 * 3 * (20 + 5 * (11 % 4));
  for (const bool scales : {true, false}) {
    PackingOptions options = tile(2);
    options.regions = {{{0, 0}, {512, 512}}};
    options.scales = scales;
    options.min_size = 8;
    const IslandPacking packing = IslandPacking::begin(islands, options);
    const double factor = std::abs(packing.motions().back().factor);
    CHECK(std::abs(packing.motions().front().factor) == doctest::Approx(packing.scale()));
    CHECK(factor * length >= 8 * (1 - 1e-6));
    CHECK(factor * length <= 8 * 1.1);
    CHECK(packing.scale() > (scales ? 1.5 : 0.999));
  }
}

TEST_CASE("where small islands alone would be too large there is no packing") {
  PackingOptions options = tile(0);
  options.min_size = 200;
  const IslandPacking packing = IslandPacking::begin(hooks(9, false), options);
  CHECK(packing.scale() == 0);
  CHECK(std::none_of(packing.has_room().begin(), packing.has_room().end(), [](bool has) { return has; }));
}

TEST_CASE("islands that overlap move as one if asked, and cover what they cover together") {
  PackingIslands islands = hooks(4, false);
  // The second hook overlaps the first; the others lie apart.
  for (Eigen::Index k = 6; k < 12; ++k) islands.points[k] -= Complex(80, 5);
  PackingOptions options = tile(2);
  const IslandPacking apart = IslandPacking::begin(islands, options);
  CHECK(apart.stack() == std::vector<int>{0, 1, 2, 3});
  options.keeps_overlaps = true;
  const IslandPacking together = IslandPacking::begin(islands, options);
  CHECK(together.stack() == std::vector<int>{0, 0, 2, 3});
  const PlaneMotion& first = together.motions()[0];
  const PlaneMotion& second = together.motions()[1];
  CHECK(std::abs(first.factor - second.factor) < 1e-12);
  CHECK(std::abs(first.offset - second.offset) < 1e-9);
  // Hooks of sides 20, 25, 30 and 35 have four squares each; the first two share some of their area.
  const double sum = 4 * (20 * 20 + 25 * 25 + 30 * 30 + 35 * 35);
  const double area = together.fill() * 256 * 256 / (together.scale() * together.scale());
  CHECK(area < sum - 100);
  CHECK(area > sum - 4 * 20 * 20);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
