#include "seams/cut_surface.h"

#include "concurrency/cancellation_scope.h"
#include "concurrency/work_counter.h"

namespace spectral_conformal {

int handle_curves(const Chart& chart) {
  // The loops of a non-orientable chart are not chained reliably.
  const int loops = chart.orientable ? static_cast<int>(chart.boundary_loops.size()) : 0;
  return 2 - loops - chart.euler_characteristic;
}

CutSurface CutSurface::of(const PolygonMesh& mesh, const SeamGraph& graph) {
  CutSurface result;
  result.half_edges_ = HalfEdges::of(mesh);
  const HalfEdges& half_edges = result.half_edges_;
  result.halves_.resize(graph.edges().size(), {-1, -1});
  for (int c = 0; c < half_edges.n_corners(); ++c) {
    poll();
    const int twin = half_edges.twin(c);
    result.twin_.push_back(twin);
    if (c < twin) result.halves_[graph.find_edge(half_edges.from(c), half_edges.to(c))] = {c, twin};
  }
  result.fans_ = DisjointSets(half_edges.n_corners());
  result.sides_ = DisjointSets(2 * mesh.n_faces);
  result.topology_ = result.measured();
  return result;
}

bool CutSurface::try_cut(const std::vector<int>& edges, bool may_join) {
  std::vector<int> parted;
  for (const int edge : edges) {
    const auto [half, twin] = halves_[edge];
    if (half < 0 || twin_[half] < 0) continue;
    twin_[half] = twin_[twin] = -1;
    parted.push_back(edge);
  }
  const Topology left = measured();
  const bool joins = may_join && left.loops < topology_.loops;
  if (left.connected && left.handle_curves < topology_.handle_curves + (joins ? 1 : 0)) {
    topology_ = left;
    return true;
  }
  for (const int edge : parted) {
    const auto [half, twin] = halves_[edge];
    twin_[half] = twin;
    twin_[twin] = half;
  }
  return false;
}

/// By the Euler characteristic, and the boundary loops, along which each vertex meets two half-edges. Across an edge,
/// the sides of both faces are joined, front to back where these are wound against each other: a connected surface has
/// two sides, or one if it is not orientable.
CutSurface::Topology CutSurface::measured() {
  fans_.separate();
  sides_.separate();
  int euler_characteristic = 0;
  int n_sides = 0;
  int first_face = -1;
  for (int c = 0; c < half_edges_.n_corners(); ++c) {
    const int face = half_edges_.face(c);
    if (!half_edges_.is_used(face)) continue;
    if (first_face < 0) first_face = face;
    const bool is_new_face = c == 0 || half_edges_.face(c - 1) != face;
    if (is_new_face) n_sides += 2;
    const int twin = twin_[c];
    // A vertex per corner, an edge per half-edge without a twin or the first of two.
    euler_characteristic += (is_new_face ? 1 : 0) + 1 - (twin < c && twin >= 0 ? 0 : 1);
    if (twin < c) continue;
    const bool opposed = half_edges_.is_opposed(c);
    const int other = half_edges_.face(twin);
    const int turned = opposed ? 0 : 1;
    if (fans_.unite(c, opposed ? half_edges_.next(twin) : twin)) --euler_characteristic;
    if (fans_.unite(half_edges_.next(c), opposed ? twin : half_edges_.next(twin))) --euler_characteristic;
    if (sides_.unite(2 * face, 2 * other + turned)) --n_sides;
    if (sides_.unite(2 * face + 1, 2 * other + 1 - turned)) --n_sides;
  }
  int loops = 0;
  for (int c = 0; c < half_edges_.n_corners(); ++c) {
    if (half_edges_.is_used(half_edges_.face(c)) && twin_[c] < 0 && !fans_.unite(c, half_edges_.next(c))) ++loops;
  }
  count_steps(half_edges_.n_corners());
  poll(half_edges_.n_corners());
  const bool orientable = sides_.find(2 * first_face) != sides_.find(2 * first_face + 1);
  return {n_sides == (orientable ? 2 : 1), loops, 2 - (orientable ? loops : 0) - euler_characteristic};
}

}  // namespace spectral_conformal
