#include "seams/edge_flow.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "graph/disjoint_sets.h"
#include "seams/seam_graph.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {
namespace {

/// Largest cosine of a corner of two triangles that count as a quad: the pairs of a triangulated grid pass, those of
/// equilateral triangles do not.
constexpr double max_corner_cosine = 0.45;
/// Largest angle between these triangles.
constexpr double max_bend = 30 * pi / 180;

class QuadFinder {
 public:
  QuadFinder(const PolygonMesh& mesh, const SeamGraph& graph) : mesh_(mesh), graph_(graph) {}

  /// See EdgeFlow::quad.
  std::vector<int> quads() const {
    std::vector<int> result(static_cast<std::size_t>(mesh_.n_faces), -1);
    for (int face = 0; face < mesh_.n_faces; ++face) {
      if (mesh_.n_corners(face) == 4) result[face] = face;
    }
    for (const auto& [cosine, edge] : pairs()) {
      const auto& faces = graph_.edges()[edge].faces;
      if (result[faces[0]] < 0 && result[faces[1]] < 0) {
        result[faces[0]] = result[faces[1]] = std::min(faces[0], faces[1]);
      }
    }
    return result;
  }

 private:
  bool is_triangle(int face) const { return mesh_.n_corners(face) == 3; }
  Eigen::Vector3d point(int vertex) const { return Eigen::Map<const Eigen::Vector3d>(mesh_.position(vertex)); }
  /// The corner of a triangle that is not on the edge.
  int apex(int face, const SeamGraph::Edge& edge) const {
    const int* const corners = mesh_.corner_vertices + mesh_.face_offsets[face];
    return *std::find_if(corners, corners + 2, [&](int v) { return v != edge.vertices[0] && v != edge.vertices[1]; });
  }
  /// The edges between triangles that would make a quad, the most rectangular first: the largest cosine of a corner, in
  /// millionths, so that rounding errors do not decide, and the edge.
  std::vector<std::pair<long, int>> pairs() const {
    std::vector<std::pair<long, int>> result;
    for (std::size_t e = 0; e < graph_.edges().size(); ++e) {
      const SeamGraph::Edge& edge = graph_.edges()[e];
      poll();
      if (edge.cut || !is_triangle(edge.faces[0]) || !is_triangle(edge.faces[1])) continue;
      if (SeamGraph::dihedral_angle(edge) > max_bend) continue;
      const double cosine = largest_cosine(edge);
      if (cosine <= max_corner_cosine) result.emplace_back(std::lround(1e6 * cosine), static_cast<int>(e));
    }
    std::sort(result.begin(), result.end());
    return result;
  }
  /// Of the corners of the quad around two triangles.
  double largest_cosine(const SeamGraph::Edge& edge) const {
    const std::array<Eigen::Vector3d, 4> corners{point(edge.vertices[0]), point(apex(edge.faces[0], edge)),
                                                 point(edge.vertices[1]), point(apex(edge.faces[1], edge))};
    double largest = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const Eigen::Vector3d before = corners[(k + 3) % 4] - corners[k];
      const Eigen::Vector3d after = corners[(k + 1) % 4] - corners[k];
      const double lengths = before.norm() * after.norm();
      if (!(lengths > 0)) return 1;
      largest = std::max(largest, std::abs(before.dot(after)) / lengths);
    }
    return largest;
  }

  const PolygonMesh& mesh_;
  const SeamGraph& graph_;
};

std::array<int, 2> quads_beside(const SeamGraph& graph, const std::vector<int>& quad, int edge) {
  const auto& faces = graph.edges()[edge].faces;
  return {quad[faces[0]], quad[faces[1]]};
}

/// The four edges around a regular vertex; empty for another.
std::vector<int> edges_around(const SeamGraph& graph, const std::vector<int>& quad, int vertex) {
  std::vector<int> around;
  for (const auto& arc : graph.adjacency().arcs(vertex)) {
    if (graph.edges()[arc.edge].cut) return {};
    const auto [one, other] = quads_beside(graph, quad, arc.edge);
    if (one < 0 || other < 0) return {};
    if (one == other) continue;
    if (around.size() == 4) return {};
    around.push_back(arc.edge);
  }
  return around.size() == 4 ? around : std::vector<int>{};
}

/// The families of loops: those on opposite sides of a quad belong to one. loop_of: (edges,), -1 for none.
std::vector<int> families_of(const SeamGraph& graph, const std::vector<int>& loop_of, int n_loops) {
  const std::vector<int>& quad = graph.flow().quad;
  std::vector<std::array<int, 2>> sides;  // quad, edge
  for (int e = 0; e < static_cast<int>(loop_of.size()); ++e) {
    if (loop_of[e] < 0) continue;
    for (const int q : quads_beside(graph, quad, e)) sides.push_back({q, e});
  }
  std::sort(sides.begin(), sides.end());
  DisjointSets sets(n_loops);
  for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
    while (last < sides.size() && sides[last][0] == sides[first][0]) ++last;
    poll();
    for (std::size_t i = first; i < last; ++i) {
      for (std::size_t j = i + 1; j < last; ++j) {
        const auto& one = graph.edges()[sides[i][1]].vertices;
        const auto& other = graph.edges()[sides[j][1]].vertices;
        const bool meet = std::find_first_of(one.begin(), one.end(), other.begin(), other.end()) != one.end();
        if (!meet) sets.unite(loop_of[sides[i][1]], loop_of[sides[j][1]]);
      }
    }
  }
  std::vector<int> result;
  result.reserve(static_cast<std::size_t>(n_loops));
  for (int loop = 0; loop < n_loops; ++loop) result.push_back(sets.find(loop));
  return result;
}

}  // namespace

EdgeFlow EdgeFlow::of(const PolygonMesh& mesh, const SeamGraph& graph) {
  const std::size_t n_edges = graph.edges().size();
  EdgeFlow result{QuadFinder(mesh, graph).quads(), std::vector<std::array<int, 2>>(n_edges, {-1, -1})};
  for (int v = 0; v < graph.n_vertices(); ++v) {
    poll();
    const std::vector<int> around = edges_around(graph, result.quad, v);
    for (const int edge : around) {
      const auto quads = quads_beside(graph, result.quad, edge);
      const auto opposite = std::find_if(around.begin(), around.end(), [&](int other) {
        const auto others = quads_beside(graph, result.quad, other);
        return std::find_first_of(quads.begin(), quads.end(), others.begin(), others.end()) == quads.end();
      });
      if (opposite != around.end()) result.onward[edge][graph.edges()[edge].vertices[0] == v ? 0 : 1] = *opposite;
    }
  }
  return result;
}

EdgeLoops EdgeLoops::of(const SeamGraph& graph) {
  const auto& edges = graph.edges();
  EdgeLoops result;
  std::vector<char> is_known(edges.size(), 0);
  std::vector<int> passed(static_cast<std::size_t>(graph.n_vertices()), -1);  // by the walk from this edge
  result.loop_of.assign(edges.size(), -1);
  for (int first = 0; first < static_cast<int>(edges.size()); ++first) {
    if (is_known[first] != 0 || edges[first].cut) continue;
    std::vector<int> loop;
    int vertex = edges[first].vertices[0];
    int edge = first;
    do {
      poll();
      is_known[edge] = 1;
      loop.push_back(edge);
      vertex = edges[edge].other_end(vertex);
      if (std::exchange(passed[vertex], first) == first) break;
      edge = graph.onward(edge, vertex);
    } while (edge >= 0 && is_known[edge] == 0 && !edges[edge].cut);
    if (edge != first) continue;
    for (const int e : loop) result.loop_of[e] = static_cast<int>(result.loops.size());
    result.loops.push_back(std::move(loop));
  }
  result.family = families_of(graph, result.loop_of, static_cast<int>(result.loops.size()));
  return result;
}

}  // namespace spectral_conformal
