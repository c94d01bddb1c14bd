#include "seams/seam_preferences.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "concurrency/work_counter.h"
#include "graph/numbering.h"
#include "seams/seam_price.h"
#include "seams/seam_style.h"

namespace spectral_conformal {
namespace {

/// Exceeds any detour on a mesh of less than a million edges, but sums keep their precision.
constexpr double prohibitive = 1e6;
/// Cost factor at an avoided vertex, as documented: a path up to eight times as long is taken instead.
constexpr double avoided = 8;

}  // namespace

SeamPreferences::SeamPreferences(const SeamSuggestionOptions& options, const MirrorSymmetry& symmetry,
                                 const std::vector<int>& mesh_vertices)
    : options_(options), mesh_vertices_(mesh_vertices) {
  if (options.n_avoided_edges == 0 && options.n_preferred_edges == 0) return;
  int last = -1;
  for (const int v : mesh_vertices) last = std::max(last, v);
  const std::vector<int> canonical = indices_in(mesh_vertices, static_cast<std::size_t>(last) + 1);
  const auto index = [&](int v) { return v > last ? -1 : canonical[v]; };
  const auto collect = [&](const std::array<int, 2>* edges, const double* strengths, int n, Marks& marks) {
    for (int k = 0; k < n; ++k) {
      const int a = index(edges[k][0]);
      const int b = index(edges[k][1]);
      const double strength = strengths == nullptr ? 1 : strengths[k];
      if (a < 0 || b < 0 || !(strength > 0)) continue;
      marks.edges.push_back({edge_between(a, b), strength});
      if (symmetry.axis < 0) continue;
      const int c = symmetry.vertex[a];
      const int d = symmetry.vertex[b];
      if (c >= 0 && d >= 0) marks.edges.push_back({edge_between(c, d), strength});
    }
    if (marks.edges.empty()) return;
    // If an edge has several marks, the strongest counts.
    std::sort(marks.edges.begin(), marks.edges.end(), [](const Mark& one, const Mark& other) {
      return one.edge != other.edge ? one.edge < other.edge : one.strength > other.strength;
    });
    marks.edges.erase(std::unique(marks.edges.begin(), marks.edges.end(),
                                  [](const Mark& one, const Mark& other) { return one.edge == other.edge; }),
                      marks.edges.end());
    marks.largest.assign(mesh_vertices.size(), 0);
    for (const Mark& mark : marks.edges) {
      for (const int v : mark.edge) {
        double& largest = marks.largest[v];
        largest = std::max(largest, mark.strength);
      }
    }
  };
  collect(options.avoided_edges, nullptr, options.n_avoided_edges, avoided_);
  collect(options.preferred_edges, options.edge_preference, options.n_preferred_edges, preferred_);
}

/// The strength of the mark of an edge between canonical vertices; 0 without a mark.
double SeamPreferences::Marks::strength(int a, int b, bool is_coarse) const {
  if (edges.empty()) return 0;
  const double weaker = std::min(largest[a], largest[b]);
  if (is_coarse || weaker == 0) return weaker;
  const std::array<int, 2> edge = edge_between(a, b);
  const auto at = std::lower_bound(edges.begin(), edges.end(), edge,
                                   [](const Mark& mark, const std::array<int, 2>& key) { return mark.edge < key; });
  return at != edges.end() && at->edge == edge ? at->strength : 0;
}

double SeamPreferences::painted_at(int vertex) const {
  return options_.vertex_preference == nullptr ? 0 : options_.vertex_preference[mesh_vertices_[vertex]];
}

double SeamPreferences::wanted_at(int vertex) const {
  return painted_at(vertex) + (preferred_.edges.empty() ? 0 : preferred_.largest[vertex]);
}

Eigen::Vector3d SeamPreferences::front() const {
  return weights_of(options_.style).front * Eigen::Vector3d(options_.front[0], options_.front[1], options_.front[2]);
}

bool SeamPreferences::agree(const Piece& one, const Piece& other, const std::vector<int>& image,
                            const Eigen::Matrix3d& rotation) const {
  constexpr double tolerance = 1e-3;
  if ((rotation * front() - front()).norm() > tolerance) return false;
  for (std::size_t v = 0; v < image.size(); ++v) {
    if (painted_at(one.vertices[v]) != painted_at(other.vertices[image[v]])) return false;
  }
  if (avoided_.edges.empty() && preferred_.edges.empty()) return true;
  bool is_equal = true;
  for_each_side(one.view(), [&](int c, int next, int /*face*/) {
    const int a = one.corner_vertices[c];
    const int b = one.corner_vertices[next];
    for (const Marks* marks : {&avoided_, &preferred_}) {
      is_equal = is_equal && marks->strength(one.vertices[a], one.vertices[b], false) ==
                                 marks->strength(other.vertices[image[a]], other.vertices[image[b]], false);
    }
  });
  return is_equal;
}

std::vector<double> SeamPreferences::cost_factors(const SeamGraph& graph, const Piece& piece, bool is_coarse) const {
  const Eigen::Vector3d front = this->front();
  std::vector<double> factors;
  factors.reserve(graph.edges().size());
  for (const SeamGraph::Edge& edge : graph.edges()) {
    const int a = piece.vertices[edge.vertices[0]];
    const int b = piece.vertices[edge.vertices[1]];
    count_steps(1);
    double factor = 1 + std::max(0.0, front.dot(edge.normal.normalized()));
    if (options_.shortest && edge.cost > 0) factor *= edge.length / edge.cost;
    factor *= std::pow(avoided, -0.5 * (painted_at(a) + painted_at(b)));
    if (avoided_.strength(a, b, is_coarse) > 0) factor *= prohibitive;
    const double preference = preferred_.strength(a, b, is_coarse);
    if (preference > 0 && edge.length > 0 && !options_.shortest) {
      const double price = edge.cost / edge.length;
      factor *= marked_price(price, preference) / price;
    }
    factors.push_back(factor);
  }
  return factors;
}

}  // namespace spectral_conformal
