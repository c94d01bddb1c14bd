#include <doctest/doctest.h>

#include <cmath>

#include "meshes.h"
#include "spectral_conformal/errors.h"
#include "spectral_conformal/map_relaxation.h"

namespace spectral_conformal::test {
namespace {

struct Start {
  Patch patch;
  ComplexVector z;
  std::vector<std::array<int, 3>> triangles;

  explicit Start(const Mesh& mesh)
      : patch(mesh), z(conformal_map(patch)), triangles(patch.chart.triangles.begin(), patch.chart.triangles.end()) {}
  MapRelaxation relaxation(const MapRelaxationOptions& options, const std::vector<char>& fixed = {},
                           const Progress& progress = {}) const {
    return MapRelaxation::begin(patch.positions, triangles, z, fixed, {}, options, progress);
  }
};

void finish(MapRelaxation& relaxation) {
  while (relaxation.advance(10)) continue;
}

}  // namespace

TEST_SUITE_BEGIN("map_relaxation");

TEST_CASE("the energy falls to one end, whatever the backend, the similarity of the start and the portions of steps") {
  const Start start(bumpy_grid(10, 8));
  for (const double sizes : {0.0, 0.5, 1.0}) {
    double end = 0;
    for (const auto backend : backends()) {
      MapRelaxation relaxation = start.relaxation({sizes, 1e-8, false, backend});
      double energy = relaxation.energy();
      CHECK(energy == relaxation.energy_before());
      while (relaxation.advance(1)) {
        CHECK(relaxation.energy() <= energy);
        energy = relaxation.energy();
      }
      CHECK(relaxation.has_converged());
      CHECK(relaxation.flipped() == 0);
      CHECK(relaxation.energy() < relaxation.energy_before());
      CHECK(relaxation.energy() > 2 + 2 * sizes);
      if (end > 0) CHECK(relaxation.energy() == doctest::Approx(end).epsilon(1e-9));
      end = relaxation.energy();
    }
    Start turned = start;
    turned.z = turned.z.conjugate().eval() * Complex(0.3, 5);
    MapRelaxation relaxation = turned.relaxation({sizes, 1e-8});
    finish(relaxation);
    CHECK(relaxation.energy() == doctest::Approx(end).epsilon(1e-8));
  }
}

TEST_CASE("a cancelled step can be taken again") {
  const Start start(bumpy_grid(8, 6));
  MapRelaxation whole = start.relaxation({1, 1e-6});
  finish(whole);
  for (int allowed = 0; allowed < 12; ++allowed) {
    MapRelaxation relaxation = start.relaxation({1, 1e-6});
    int reports = 0;
    CHECK_THROWS_AS(relaxation.advance(100, [&](double, const char*) { return reports++ < allowed; }), Cancelled);
    finish(relaxation);
    CHECK(relaxation.z() == whole.z());
  }
}

TEST_CASE("flipped triangles are unfolded where asked") {
  Start start(flat_grid(6, 6));
  start.z = flat_map(start.patch.positions);
  start.z[24] += Complex(1.6, 0.4);
  MapRelaxation kept = start.relaxation({1, 1e-3});
  CHECK(kept.flipped() > 0);
  CHECK(start.relaxation({1, 1e-3, true}).flipped() == 0);
  const int before = kept.flipped();
  finish(kept);
  CHECK(kept.flipped() <= before);
}

TEST_CASE("a map keeps the equations that it meets, also mirrored, unfolded and with fixed vertices") {
  // The border's first edge at 0.3 radians.
  Start start(bumpy_grid(6, 6));
  const int first = start.patch.outer()[0];
  const int second = start.patch.outer()[1];
  start.z *= std::polar(1.0, 0.3) / (start.z[second] - start.z[first]);
  for (const bool mirrored : {false, true}) {
    if (mirrored) start.z = start.z.conjugate().eval();
    MapRelaxationOptions options{1, 1e-6, mirrored};
    const double sine = std::sin(mirrored ? -0.3 : 0.3);
    options.constraints.add(
        {{2 * first, -sine}, {2 * second, sine}, {2 * first + 1, std::cos(0.3)}, {2 * second + 1, -std::cos(0.3)}});
    for (const bool holds : {false, true}) {
      std::vector<char> fixed(holds ? static_cast<std::size_t>(start.z.size()) : 0, 0);
      if (holds) fixed[first] = 1;
      MapRelaxation relaxation = start.relaxation(options, fixed);
      finish(relaxation);
      const Complex along = relaxation.z()[second] - relaxation.z()[first];
      CHECK(std::arg(along) == doctest::Approx(mirrored ? -0.3 : 0.3).epsilon(1e-12));
      CHECK(std::abs(along) != doctest::Approx(1));
      CHECK(relaxation.energy() < relaxation.energy_before());
      if (holds) CHECK(relaxation.z()[first] == start.z[first]);
    }
  }
}

TEST_CASE("a map without area is returned as it is") {
  Start start(flat_grid(4, 4));
  start.z.setZero();
  MapRelaxation relaxation = start.relaxation({});
  CHECK_FALSE(relaxation.advance(5));
  CHECK(relaxation.z() == start.z);
  CHECK(std::isinf(relaxation.energy()));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
