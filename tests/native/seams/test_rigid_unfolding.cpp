#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <vector>

#include "graph/disjoint_sets.h"
#include "mesh/charts.h"
#include "meshes.h"
#include "seams/pieces.h"
#include "seams/rigid_unfolding.h"

namespace spectral_conformal::test {
namespace {

struct Unfolded {
  Piece piece;
  SeamGraph graph;
  std::vector<int> seams;

  explicit Unfolded(const Mesh& mesh)
      : piece(MirroredPieces::of(mesh.view()).pieces.front()), graph(SeamGraph::of(piece.view())) {
    seams = rigid_unfolding_seams(piece, graph);
  }
  double seams_price() const {
    double sum = 0;
    for (const int e : seams) sum += graph.edges()[e].cost;
    return sum;
  }
  std::size_t n_charts() const {
    std::vector<std::array<int, 2>> cut;
    for (const int e : seams) cut.push_back(graph.edges()[e].vertices);
    PolygonMesh mesh = piece.view();
    mesh.seam_edges = cut.data();
    mesh.n_seam_edges = static_cast<int>(cut.size());
    return build_charts(mesh).charts.size();
  }
};

/// A prism over a regular polygon, its caps and sides one face each.
Mesh prism(int n, double height) {
  Mesh mesh;
  std::vector<int> bottom;
  std::vector<int> top;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * pi * i / n;
    for (const double z : {0.0, height}) mesh.points.emplace_back(std::cos(angle), std::sin(angle), z);
    bottom.insert(bottom.begin(), 2 * i);
    top.push_back(2 * i + 1);
    const int next = (i + 1) % n;
    mesh.add({2 * i, 2 * next, 2 * next + 1, 2 * i + 1});
  }
  mesh.add(bottom);
  mesh.add(top);
  return mesh;
}

Mesh box() {
  return cell_surface(3, [](int i, int j, int k) { return i < 1 && j < 2 && k < 3; });
}

/// The least price of seams that leave a box in one net: of all spanning trees of its six facets.
double least_price_of_box(const Unfolded& unfolded) {
  const auto facet = [&](int face) {
    const Positions corners = unfolded.piece.corners(face);
    for (int axis = 0; axis < 3; ++axis) {
      if (corners.col(axis).maxCoeff() == corners.col(axis).minCoeff())
        return 2 * axis + (corners(0, axis) > 0 ? 1 : 0);
    }
    return -1;
  };
  std::array<std::array<double, 6>, 6> border{};
  double all = 0;
  for (std::size_t e = 0; e < unfolded.graph.edges().size(); ++e) {
    const auto& edge = unfolded.graph.edges()[e];
    const int a = facet(edge.faces[0]);
    const int b = facet(edge.faces[1]);
    if (a == b) continue;
    border[std::min(a, b)][std::max(a, b)] += edge.cost;
    all += edge.cost;
  }
  std::vector<std::array<int, 2>> pairs;
  for (int a = 0; a < 6; ++a) {
    for (int b = a + 1; b < 6; ++b) {
      if (border[a][b] > 0) pairs.push_back({a, b});
    }
  }
  double most = 0;
  for (unsigned some = 0; some < (1U << pairs.size()); ++some) {
    DisjointSets sets(6);
    double joined = 0;
    int n = 0;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      if ((some >> k & 1U) == 0) continue;
      ++n;
      joined += border[pairs[k][0]][pairs[k][1]];
      sets.unite(pairs[k][0], pairs[k][1]);
    }
    bool is_tree = n == 5;
    for (int a = 1; a < 6; ++a) is_tree = is_tree && sets.find(a) == sets.find(0);
    if (is_tree) most = std::max(most, joined);
  }
  return all - most;
}

}  // namespace

TEST_SUITE_BEGIN("rigid_unfolding");

TEST_CASE("a box becomes one net, with the cheapest seams that there are") {
  const Unfolded unfolded(box());
  CHECK(unfolded.n_charts() == 1);
  CHECK(unfolded.seams_price() == doctest::Approx(least_price_of_box(unfolded)).epsilon(1e-12));
  // No seam runs across one of its flat sides.
  for (const int e : unfolded.seams) CHECK(SeamGraph::dihedral_angle(unfolded.graph.edges()[e]) > 1);
}

TEST_CASE("round caps come off their pipe, which gets one line, and those of few sides stay") {
  constexpr std::array<std::array<int, 2>, 4> cases{{{4, 1}, {6, 1}, {16, 3}, {48, 3}}};
  for (const auto& sides_and_charts : cases) {
    const int n = sides_and_charts[0];
    CAPTURE(n);
    const Unfolded unfolded(prism(n, 3));
    CHECK(unfolded.n_charts() == static_cast<std::size_t>(sides_and_charts[1]));
    int upright = 0;
    for (const int e : unfolded.seams) upright += unfolded.graph.edges()[e].length > 2.9 ? 1 : 0;
    CHECK(upright == 1);
  }
}

TEST_CASE("a flat mesh needs no seams, and a slit one no more") {
  CHECK(Unfolded(quad_grid(5, 4)).seams.empty());
  Mesh slit = quad_grid(4, 4);
  slit.seams = {{6, 7}, {7, 8}};
  CHECK(Unfolded(slit).seams.empty());
}

TEST_CASE("images of parts never overlap: a comb of long teeth, folded, is taken apart") {
  // A ring of walls around a square, inward and outward, has facets that would lie on each other.
  const Mesh frame =
      cell_surface(5, [](int i, int j, int k) { return k < 1 && (i == 0 || i == 4 || j == 0 || j == 4); });
  const Unfolded unfolded(frame);
  CHECK(unfolded.n_charts() >= 1);
  for (const int e : unfolded.seams) CHECK(SeamGraph::dihedral_angle(unfolded.graph.edges()[e]) > 1);
}

TEST_CASE("faces without area and existing seams do no harm") {
  Mesh mesh = prism(6, 1);
  mesh.points.push_back(mesh.points[0]);
  mesh.add({0, static_cast<int>(mesh.points.size()) - 1, 2});
  CHECK_NOTHROW(Unfolded{mesh});
  Mesh marked = prism(6, 1);
  marked.seams = {{0, 2}};
  const Unfolded unfolded(marked);
  CHECK(
      std::none_of(unfolded.seams.begin(), unfolded.seams.end(), [&](int e) { return unfolded.graph.edges()[e].cut; }));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
