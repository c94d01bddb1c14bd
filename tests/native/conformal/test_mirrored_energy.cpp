#include <doctest/doctest.h>

#include "conformal/mirrored_energy.h"
#include "meshes.h"

namespace spectral_conformal::test {

TEST_SUITE("mirrored_energy") {
  TEST_CASE("only what is opposite in u and level in v is an image") {
    LinearEquations equations;
    equations.add({{0, 1.0}, {6, 1.0}});  // 0 and 3
    equations.add({{7, 2.0}, {1, -2.0}});
    equations.add({{2, 1.0}});               // 1 on the axis
    equations.add({{4, 1.0}, {8, 1.0}});     // opposite alone
    equations.add({{11, 1.0}, {13, -1.0}});  // level alone
    CHECK(mirror_images(equations, 7) == std::vector<int>{3, 1, -1, 0, -1, -1, -1});
    LinearEquations chain;
    chain.add({{1, 1.0}, {3, -1.0}});
    chain.add({{0, 1.0}});
    CHECK(mirror_images(chain, 7).empty());
  }

  TEST_CASE("two triangles of different shape cost a mirrored map the same") {
    // Two sides of an axis, one of them three times as far from it.
    Positions positions(4, 3);
    positions << 0, 0, 0, 0, 2, 0, -1, 0.5, 0, 3, 1, 0;
    const std::vector<std::array<int, 3>> triangles{{1, 2, 0}, {0, 3, 1}};
    const std::vector<TriangleWeight> whole(2);
    const ConformalEnergy energy = conformal_energy(positions, triangles, whole, Weights::uniform);
    const ConformalEnergy mean = mirrored_energy(energy, positions, {0, 1, 3, 2});
    const auto costs = [&](const ConformalEnergy& of, const ComplexVector& z) {
      std::array<double, 2> result{};
      for (std::size_t t = 0; t < 2; ++t) {
        const auto& [a, b, c] = triangles[t];
        const TriangleShape& s = of.energy_shapes()[t];
        result[t] = std::norm(s.antiholomorphic_part(z[b] - z[a], z[c] - z[a])) / s.area();
      }
      return result;
    };
    ComplexVector z(4);
    z << Complex(0, 0), Complex(0, 1.5), Complex(-1.2, 0.8), Complex(1.2, 0.8);
    const auto [one, other] = costs(mean, z);
    CHECK(one == doctest::Approx(other).epsilon(1e-14));
    CHECK(one > 0);
    // The map that is conformal for the mean has K_1 = K_2.
    const TriangleShape& s = mean.energy_shapes()[1];
    z << Complex(0, 0), Complex(0, 1), 0, 0;
    z[3] = s.x1 / Complex(s.x2, s.y2) * Complex(0, 1);
    z[2] = -std::conj(z[3]);
    CHECK(mean.value(z) < 1e-14);
    std::array<double, 2> stretch{};
    for (std::size_t t = 0; t < 2; ++t) {
      const auto& [a, b, c] = triangles[t];
      stretch[t] = energy.shapes()[t].quasi_conformal_distortion(z[b] - z[a], z[c] - z[a]);
    }
    CHECK(stretch[0] == doctest::Approx(stretch[1]).epsilon(1e-12));
    CHECK(stretch[0] > 1.2);
  }

  TEST_CASE("where no triangle is the image, its place in space counts") {
    Positions positions(4, 3);
    positions << 0, 0, 0, 0, 2, 0, -1, 0.5, 0, 3, 1, 0;
    const std::vector<TriangleWeight> whole(1);
    const std::vector<TriangleWeight> both(2);
    const ConformalEnergy one = conformal_energy(positions, {{{1, 2, 0}}}, whole, Weights::uniform);
    const ConformalEnergy two = conformal_energy(positions, {{{1, 2, 0}, {0, 3, 1}}}, both, Weights::uniform);
    const std::vector<int> image{0, 1, 3, 2};
    const TriangleShape alone = mirrored_energy(one, positions, image).energy_shapes()[0];
    const TriangleShape paired = mirrored_energy(two, positions, image).energy_shapes()[0];
    CHECK(alone.x1 == doctest::Approx(paired.x1));
    CHECK(alone.x2 == doctest::Approx(paired.x2));
    CHECK(alone.y2 == doctest::Approx(paired.y2));
  }

  TEST_CASE("what no image concerns keeps its shape") {
    const Patch patch(bumpy_grid(4, 3));
    const ConformalEnergy energy = patch.energy(Weights::uniform);
    const ConformalEnergy same = mirrored_energy(energy, patch.positions, std::vector<int>(patch.positions.rows(), -1));
    const ComplexVector flat = flat_map(patch.positions);
    CHECK(same.value(flat) == energy.value(flat));
  }
}

}  // namespace spectral_conformal::test
