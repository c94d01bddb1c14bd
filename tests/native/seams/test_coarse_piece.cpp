#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "concurrency/work_counter.h"
#include "graph/disjoint_sets.h"
#include "meshes.h"
#include "seams/coarse_piece.h"
#include "seams/seam_graph.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal::test {
namespace {

/// The one piece of a mesh.
struct FinePiece : MirroredPieces {
  Mesh mesh;

  explicit FinePiece(Mesh given) : MirroredPieces(of(given.view())), mesh(std::move(given)) {
    REQUIRE(pieces.size() == 1);
  }
  const Piece& piece() const { return pieces[0]; }
  std::vector<signed char> side() const {
    std::vector<signed char> result;
    for (const int v : piece().vertices) result.push_back(symmetry.side[v]);
    return result;
  }
  CoarsePiece coarse(int n_vertices, const std::vector<double>& preference = {}) const {
    return coarse_piece(piece(), 0, mirrors[0], side(), preference, n_vertices, {});
  }
};

Chart whole_chart(const Piece& piece) {
  PolygonMesh view = piece.view();
  view.n_seam_edges = 0;
  const ChartDecomposition decomposition = build_charts(view);
  REQUIRE(decomposition.charts.size() == 1);
  CHECK(decomposition.degenerate_faces.empty());
  CHECK(decomposition.non_manifold_edges == 0);
  CHECK(decomposition.split_vertices == 0);
  CHECK(decomposition.charts[0].duplicates.empty());
  return decomposition.charts[0];
}

std::vector<Mesh> fine_meshes() {
  return {torus(60, 30), sphere(14), perforated_grid(24, 24), double_torus(), spiky_grid(4, 6)};
}

}  // namespace

TEST_SUITE_BEGIN("coarse_piece");

TEST_CASE("a coarse piece has the topology of the fine one and hardly more vertices than wanted") {
  for (const Mesh& mesh : fine_meshes()) {
    const FinePiece fine(mesh);
    const int wanted = static_cast<int>(fine.piece().vertices.size()) / 3;
    const CoarsePiece coarse = fine.coarse(wanted);
    const Chart before = whole_chart(fine.piece());
    const Chart after = whole_chart(coarse.piece);
    CHECK(after.n_vertices() <= 1.3 * wanted);
    CHECK(after.n_vertices() >= wanted - 1);
    CHECK(after.euler_characteristic == before.euler_characteristic);
    CHECK(after.boundary_loops.size() == before.boundary_loops.size());
    CHECK(after.orientable == before.orientable);
    CHECK(after.reversed_faces == 0);
  }
}

TEST_CASE("surfaces as rough as scans come down to what is wanted, too") {
  Mesh rough = torus(120, 60);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> noise(-0.1, 0.1);
  for (Eigen::Vector3d& point : rough.points) point += Eigen::Vector3d(noise(random), noise(random), noise(random));
  const FinePiece fine(rough);
  const int wanted = static_cast<int>(fine.piece().vertices.size()) / 30;
  const Chart coarse = whole_chart(fine.coarse(wanted).piece);
  CHECK(coarse.n_vertices() <= 1.1 * wanted);
  CHECK(coarse.euler_characteristic == 0);
}

TEST_CASE("its vertices and faces are some of the fine ones, in their order") {
  const FinePiece fine(torus(60, 30));
  const CoarsePiece coarse = fine.coarse(600);
  CHECK(std::is_sorted(coarse.vertex.begin(), coarse.vertex.end()));
  CHECK(std::is_sorted(coarse.piece.faces.begin(), coarse.piece.faces.end()));
  for (std::size_t v = 0; v < coarse.vertex.size(); ++v) {
    const auto row = static_cast<Eigen::Index>(v);
    CHECK(coarse.piece.vertices[v] == fine.piece().vertices[coarse.vertex[v]]);
    CHECK(coarse.piece.positions.row(row) == fine.piece().positions.row(coarse.vertex[v]));
    CHECK(coarse.cluster[coarse.vertex[v]] == static_cast<int>(v));
  }
}

TEST_CASE("clusters are connected, and every coarse edge is there between those of its ends") {
  for (const Mesh& mesh : fine_meshes()) {
    const FinePiece fine(mesh);
    const CoarsePiece coarse = fine.coarse(static_cast<int>(fine.piece().vertices.size()) / 5);
    DisjointSets connected(static_cast<int>(coarse.cluster.size()));
    std::set<std::array<int, 2>> between;
    const SeamGraph fine_graph = SeamGraph::of(fine.piece().view());
    const SeamGraph coarse_graph = SeamGraph::of(coarse.piece.view());
    for (const auto& edge : fine_graph.edges()) {
      const int a = coarse.cluster[edge.vertices[0]];
      const int b = coarse.cluster[edge.vertices[1]];
      if (a == b) connected.unite(edge.vertices[0], edge.vertices[1]);
      between.insert({std::min(a, b), std::max(a, b)});
    }
    for (std::size_t v = 0; v < coarse.cluster.size(); ++v) {
      CHECK(connected.find(static_cast<int>(v)) == connected.find(coarse.vertex[coarse.cluster[v]]));
    }
    for (const auto& edge : coarse_graph.edges()) CHECK(between.count(edge.vertices) == 1);
  }
}

TEST_CASE("what is its own mirror image remains so") {
  for (const Mesh& mesh : {sphere(14), double_torus(), spiky_grid(4, 6), torus(60, 30)}) {
    const FinePiece fine(mesh);
    REQUIRE(fine.mirrors[0].image == 0);
    const CoarsePiece coarse = fine.coarse(static_cast<int>(fine.piece().vertices.size()) / 4);
    CHECK(coarse.piece.vertices.size() < fine.piece().vertices.size() / 2);
    REQUIRE(coarse.mirror.image == 0);
    REQUIRE(coarse.mirror.vertex.size() == coarse.vertex.size());
    REQUIRE(coarse.mirror.face.size() == coarse.piece.faces.size());
    for (std::size_t v = 0; v < coarse.cluster.size(); ++v) {
      CHECK(coarse.cluster[fine.mirrors[0].vertex[v]] == coarse.mirror.vertex[coarse.cluster[v]]);
    }
    const auto corners = [&](int face, bool mirrored) {
      std::set<int> result;
      for (int c = coarse.piece.face_offsets[face]; c < coarse.piece.face_offsets[face + 1]; ++c) {
        const int v = coarse.piece.corner_vertices[c];
        result.insert(mirrored ? coarse.mirror.vertex[v] : v);
      }
      return result;
    };
    for (int face = 0; face < coarse.piece.n_faces(); ++face) {
      CHECK(corners(face, true) == corners(coarse.mirror.face[face], false));
    }
  }
}

TEST_CASE("vertices of seams stay, and those of the boundary stay on it") {
  Mesh mesh = quad_grid(30, 20);
  for (int i = 5; i < 12; ++i) mesh.seams.push_back({31 * i + 9, 31 * (i + 1) + 9});
  const FinePiece fine(mesh);
  const CoarsePiece coarse = fine.coarse(150);
  CHECK(coarse.piece.seams.size() == fine.piece().seams.size());
  const SeamGraph graph = SeamGraph::of(coarse.piece.view());
  for (const auto& seam : coarse.piece.seams) CHECK(graph.find_edge(seam[0], seam[1]) >= 0);
  const auto at_border = [&](Eigen::Index v, const Positions& at) {
    return at(v, 0) == 0 || at(v, 0) == 30 || at(v, 1) == 0 || at(v, 1) == 20;
  };
  for (std::size_t v = 0; v < coarse.cluster.size(); ++v) {
    if (at_border(static_cast<Eigen::Index>(v), fine.piece().positions)) {
      CHECK(at_border(coarse.cluster[v], coarse.piece.positions));
    }
  }
}

TEST_CASE("curved regions keep more vertices than flat ones, and flat ones stay flat") {
  const FinePiece fine(spiky_grid(4, 6));
  const CoarsePiece coarse = fine.coarse(static_cast<int>(fine.piece().vertices.size()) / 4);
  const auto fraction_above = [](const Positions& at) {
    return static_cast<double>((at.col(2).array() > 0.1).count()) / static_cast<double>(at.rows());
  };
  CHECK(fraction_above(coarse.piece.positions) > 1.2 * fraction_above(fine.piece().positions));
}

TEST_CASE("vertices are rather not merged across a change of the preference") {
  const FinePiece fine(sphere(14));
  std::vector<double> preference;
  for (Eigen::Index v = 0; v < fine.piece().positions.rows(); ++v) {
    preference.push_back(fine.piece().positions(v, 2) > 0.05 ? 1 : -1);
  }
  const auto mixed = [&](const CoarsePiece& coarse) {
    int n = 0;
    for (std::size_t v = 0; v < preference.size(); ++v) {
      n += preference[v] != preference[coarse.vertex[coarse.cluster[v]]] ? 1 : 0;
    }
    return n;
  };
  const int without = mixed(fine.coarse(250));
  CHECK(without > 0);
  CHECK(mixed(fine.coarse(250, preference)) < without / 2);
}

TEST_CASE("cancelling a coarse piece passes through") {
  const FinePiece fine(sphere(8));
  CHECK_THROWS_AS(
      coarse_piece(fine.piece(), 0, fine.mirrors[0], fine.side(), {}, 50, [](double, const char*) { return false; }),
      Cancelled);
}

TEST_CASE("large polygons and vertices of many faces follow what is merged beside them, in linear time") {
  // A drum with a polygon below, and above a fan.
  std::vector<double> steps;
  for (const int n : {375, 3000}) {
    Mesh drum;
    for (int row = 0; row < 3; ++row) {
      for (int i = 0; i < n; ++i) {
        const double angle = 2 * pi * i / n;
        drum.points.emplace_back(std::cos(angle) + 0.1 * std::cos(3 * angle), std::sin(angle), 0.02 * row);
      }
    }
    drum.points.emplace_back(0.3, 0.1, 0.5);
    std::vector<int> bottom;
    for (int i = 0; i < n; ++i) {
      const int next = (i + 1) % n;
      for (int row = 0; row < 2; ++row) drum.add({row * n + i, row * n + next, row * n + n + next, row * n + n + i});
      drum.add({2 * n + i, 2 * n + next, 3 * n});
      bottom.push_back(n - 1 - i);
    }
    drum.add(bottom);
    const FinePiece fine(drum);
    const WorkCounter counter;
    const CoarsePiece coarse = fine.coarse(n);
    steps.push_back(static_cast<double>(counter.counts().steps));
    const Chart chart = whole_chart(coarse.piece);
    CHECK(chart.n_vertices() <= 1.3 * n);
    CHECK(chart.euler_characteristic == 2);
    CHECK(chart.boundary_loops.empty());
  }
  CHECK(steps[1] <= 10 * steps[0]);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
