#include "seams/avoided_edges.h"

#include <algorithm>
#include <cstddef>

#include "concurrency/work_counter.h"

namespace spectral_conformal {
namespace {

/// Longer than any detour on a mesh of less than a million edges, but small enough that sums keep their digits.
constexpr double prohibitive = 1e6;

std::array<int, 2> sorted(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

}  // namespace

AvoidedEdges::AvoidedEdges(const SeamSuggestionOptions& options, const MirrorSymmetry& symmetry,
                           const std::vector<int>& mesh_vertices) {
  if (options.n_avoided_edges == 0) return;
  int largest = -1;
  for (const int v : mesh_vertices) largest = std::max(largest, v);
  std::vector<int> canonical(static_cast<std::size_t>(largest) + 1, -1);
  for (std::size_t i = 0; i < mesh_vertices.size(); ++i) {
    canonical[static_cast<std::size_t>(mesh_vertices[i])] = static_cast<int>(i);
  }
  const auto index = [&](int v) { return v > largest ? -1 : canonical[static_cast<std::size_t>(v)]; };
  is_end_.assign(mesh_vertices.size(), 0);
  for (int k = 0; k < options.n_avoided_edges; ++k) {
    const int a = index(options.avoided_edges[k][0]);
    const int b = index(options.avoided_edges[k][1]);
    if (a < 0 || b < 0) continue;
    edges_.push_back(sorted(a, b));
    if (symmetry.axis < 0) continue;
    const int c = symmetry.vertex[static_cast<std::size_t>(a)];
    const int d = symmetry.vertex[static_cast<std::size_t>(b)];
    if (c >= 0 && d >= 0) edges_.push_back(sorted(c, d));
  }
  std::sort(edges_.begin(), edges_.end());
  for (const auto& edge : edges_) {
    for (const int v : edge) is_end_[static_cast<std::size_t>(v)] = 1;
  }
}

void AvoidedEdges::raise(const SeamGraph& graph, const Piece& piece, bool is_coarse,
                         std::vector<double>& factors) const {
  if (edges_.empty()) return;
  for (std::size_t e = 0; e < factors.size(); ++e) {
    const auto [first, second] = graph.edges()[e].vertices;
    const int a = piece.vertices[static_cast<std::size_t>(first)];
    const int b = piece.vertices[static_cast<std::size_t>(second)];
    if (!is_end_[static_cast<std::size_t>(a)] || !is_end_[static_cast<std::size_t>(b)]) continue;
    count_steps(1);
    if (is_coarse || std::binary_search(edges_.begin(), edges_.end(), sorted(a, b))) factors[e] *= prohibitive;
  }
}

}  // namespace spectral_conformal
