#include <doctest/doctest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "meshes.h"
#include "parameterization/constrained_map.h"
#include "spectral_conformal/parameterize.h"

namespace spectral_conformal::test {
namespace {

/// One u for the vertices of a patch.
LinearConstraints with_one_u(int n_vertices, const std::vector<int>& column) {
  LinearConstraints ties;
  ties.n_unknowns = 2 * n_vertices;
  ties.unknown.resize(static_cast<std::size_t>(ties.n_unknowns));
  std::iota(ties.unknown.begin(), ties.unknown.end(), 0);
  ties.sign.assign(ties.unknown.size(), 1);
  for (const int v : column) ties.unknown[static_cast<std::size_t>(2 * v)] = 2 * column.front();
  std::vector<int> all(static_cast<std::size_t>(n_vertices));
  std::iota(all.begin(), all.end(), 0);
  return ties.restricted(all, 0);
}

}  // namespace

TEST_SUITE("constrained_map") {
  TEST_CASE("it has the area in 3D and its mean at the origin, and is neither turned nor polished") {
    const Patch patch(bumpy_grid(12, 7));
    const auto n_vertices = static_cast<int>(patch.positions.rows());
    SolveOptions options;
    options.constraints = with_one_u(n_vertices, {0, 1, 2, 3});
    options.polish = true;
    options.fold_free = true;
    Solver solver(patch.chart, patch.positions, {});
    const Parameterization map = solver.solve(options, {});
    for (const int v : {1, 2, 3}) CHECK(map.z[v].real() == map.z[0].real());
    CHECK(std::abs(map.z.mean()) < 1e-12);
    CHECK(shoelace_area(patch.outer(), map.z) == doctest::Approx(solver.energy().area() * std::pow(solver.scale(), 2)));
    CHECK(map.polish_steps == 0);
    CHECK(map.eigenvalue_of == EigenvalueOf::eigenvector);
    CHECK(map.eigenvalue > solver.solve({}, {}).eigenvalue);
  }
}

}  // namespace spectral_conformal::test
