#include <doctest/doctest.h>

#include <Eigen/SparseCore>
#include <algorithm>
#include <numeric>
#include <vector>

#include "linear_algebra/distance_numbering.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

/// Paths of the given numbers of nodes, one after the other.
HermitianMatrix paths(const std::vector<int>& lengths) {
  std::vector<Eigen::Triplet<Complex>> entries;
  int node = 0;
  for (const int length : lengths) {
    for (int i = 0; i < length; ++i, ++node) {
      entries.emplace_back(node, node, 2);
      if (i > 0) entries.emplace_back(node, node - 1, -1);
    }
  }
  HermitianMatrix matrix(node, node);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

TEST_SUITE_BEGIN("distance_numbering");

TEST_CASE("a path is taken from one end to the other") {
  const std::vector<int> numbering = numbering_by_distance(paths({7}));
  CHECK(numbering == std::vector<int>{0, 1, 2, 3, 4, 5, 6});
}

TEST_CASE("every row of every connected part once, alone or not") {
  const std::vector<int> numbering = numbering_by_distance(paths({4, 1, 9}));
  std::vector<int> sorted = numbering;
  std::sort(sorted.begin(), sorted.end());
  std::vector<int> all(14);
  std::iota(all.begin(), all.end(), 0);
  CHECK(sorted == all);
  CHECK(numbering[4] == 4);
  CHECK(numbering_by_distance(HermitianMatrix(0, 0)).empty());
}

TEST_CASE("the distance from the last vertex, which is at an end, only falls") {
  const Patch patch(quad_grid(20, 20));
  const std::vector<int> numbering = numbering_by_distance(patch.energy(Weights::uniform).matrix());
  // Both diagonals of a quad are edges.
  const auto distance = [&](int v) {
    return (patch.positions.row(v) - patch.positions.row(numbering.back())).head<2>().cwiseAbs().maxCoeff();
  };
  const double edge = patch.positions.col(0).maxCoeff() / 20;
  for (std::size_t i = 1; i < numbering.size(); ++i) {
    CHECK(distance(numbering[i]) < distance(numbering[i - 1]) + 0.5 * edge);
  }
  CHECK(distance(numbering.front()) > 19.5 * edge);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
