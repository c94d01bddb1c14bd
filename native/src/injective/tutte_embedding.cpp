#include "injective/tutte_embedding.h"

#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <tuple>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "concurrency/parallel_calls.h"
#include "geometry/tolerances.h"
#include "graph/adjacency.h"
#include "graph/shortest_paths.h"
#include "mesh/boundary_loops.h"
#include "mesh/edge_table.h"
#include "quality/flips.h"

namespace spectral_conformal {
namespace {

struct WeightedEdge {
  int i;
  int j;
  double length;      ///< in 3D
  double weight = 1;  ///< positive; initially Tutte's equal weights
};

/// The edges of the triangles, and the edges from each hole's loop to a vertex in its middle, numbered from V on.
std::vector<WeightedEdge> weighted_edges(const std::vector<std::array<int, 3>>& triangles,
                                         const std::vector<BoundaryLoop>& loops, int outer,
                                         const Eigen::Ref<const Positions>& positions) {
  const EdgeTable<int> table(static_cast<int>(positions.rows()), [&](const auto& visit) {
    for_each_polled(triangles.size(), [&](std::size_t t) {
      for (int k = 0; k < 3; ++k) visit(triangles[t][k], triangles[t][(k + 1) % 3], static_cast<int>(t));
    });
  });
  std::vector<WeightedEdge> edges;
  edges.reserve(table.n_edges());
  double total = 0;
  table.for_each_edge([&](const std::array<int, 2>& ends, const auto* /*first*/, const auto* /*last*/) {
    edges.push_back({ends[0], ends[1], (positions.row(ends[0]) - positions.row(ends[1])).norm()});
    total += edges.back().length;
  });
  // The ends of edges of length 0 must separate, too.
  const double min_length = sliver * total / static_cast<double>(edges.size());
  for (WeightedEdge& edge : edges) edge.length = std::max(edge.length, min_length);
  int middle = static_cast<int>(positions.rows());
  for (std::size_t k = 0; k < loops.size(); ++k) {
    if (static_cast<int>(k) == outer) continue;
    // About the radius of a circle of that length, 2 pi rounded down.
    const double radius = std::max(loop_length(loops[k], positions) / 6, min_length);
    for (const int v : loops[k]) edges.push_back({v, middle, radius});
    ++middle;
  }
  return edges;
}

/// Maps the loop to the unit circle in proportion to its edge lengths; to equal arcs if its length is 0.
void map_to_circle(const BoundaryLoop& loop, const Eigen::Ref<const Positions>& positions, ComplexVector& z) {
  const double length = loop_length(loop, positions);
  const double min_length = length > 0 ? sliver * length / static_cast<double>(loop.size()) : 1;
  std::vector<double> reached{0};
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const double edge = (positions.row(loop[(i + 1) % loop.size()]) - positions.row(loop[i])).norm();
    reached.push_back(reached.back() + std::max(edge, min_length));
  }
  for (std::size_t i = 0; i < loop.size(); ++i) z[loop[i]] = std::polar(1.0, 2 * pi * reached[i] / reached.back());
}

/// The Tutte system: each vertex not on the circle lies at the weighted mean of its neighbors.
class TutteSystem {
 public:
  TutteSystem(const std::vector<WeightedEdge>& edges, const BoundaryLoop& circle, Eigen::Index n,
              FactorizationBackend backend)
      : edges_(edges), unknown_(static_cast<std::size_t>(n), 0) {
    for (const int v : circle) unknown_[v] = -1;
    int count = 0;
    for (std::size_t v = 0; v < unknown_.size(); ++v) {
      if (unknown_[v] == 0) unknown_[v] = count++;
    }
    n_unknown_ = count;
    if (count > 0) factorization_ = make_factorization(backend, count);
  }

  /// Solves for all vertices of z not on the circle, with the current edge weights. Returns false, z unchanged, if the
  /// range of the weights exceeds double precision.
  bool solve(ComplexVector& z) {
    if (n_unknown_ == 0) return true;
    std::vector<Eigen::Triplet<Complex>> entries;
    entries.reserve(3 * edges_.size());
    ComplexVector right_side = ComplexVector::Zero(n_unknown_);
    for_each_polled(edges_.size(), [&](std::size_t k) {
      const WeightedEdge& edge = edges_[k];
      const int i = unknown_[edge.i];
      const int j = unknown_[edge.j];
      if (i >= 0) entries.emplace_back(i, i, edge.weight);
      if (j >= 0) entries.emplace_back(j, j, edge.weight);
      if (i >= 0 && j >= 0) entries.emplace_back(std::max(i, j), std::min(i, j), -edge.weight);
      if (i >= 0 && j < 0) right_side[i] += edge.weight * z[edge.j];
      if (j >= 0 && i < 0) right_side[j] += edge.weight * z[edge.i];
    });
    const HermitianMatrix matrix = lower_triangle(n_unknown_, entries);
    if (!analyzed_) factorization_->analyze(matrix);
    analyzed_ = true;
    if (!factorization_->factorize(matrix)) return false;
    ComplexVector solution;
    factorization_->solve(right_side, solution);
    if (!solution.allFinite()) return false;
    for (std::size_t v = 0; v < unknown_.size(); ++v) {
      if (unknown_[v] >= 0) z[static_cast<Eigen::Index>(v)] = solution[unknown_[v]];
    }
    return true;
  }

 private:
  const std::vector<WeightedEdge>& edges_;
  std::vector<int> unknown_;  ///< index of the unknown of each vertex, -1 on the circle
  int n_unknown_ = 0;
  std::unique_ptr<Factorization> factorization_;
  bool analyzed_ = false;
};

/// For every edge, the logarithm of its length in the plane over its length in 3D.
std::vector<double> log_stretch(const std::vector<WeightedEdge>& edges, const ComplexVector& z) {
  std::vector<double> result;
  result.reserve(edges.size());
  // Shorter distances in the unit circle are rounding. The ratios of stretches, of which the weights take the root,
  // then stay in the range of double precision.
  for_each_polled(edges.size(), [&](std::size_t k) {
    const WeightedEdge& edge = edges[k];
    result.push_back(std::log(std::max(std::abs(z[edge.i] - z[edge.j]), epsilon) / edge.length));
  });
  return result;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double variance(const std::vector<double>& values) {
  const double center = mean(values);
  double sum = 0;
  for (const double value : values) sum += (value - center) * (value - center);
  return sum / static_cast<double>(values.size());
}

/// Lowers the weights of edges that are short in the plane for their length in 3D, and raises the others, by the square
/// root of the stretch, since the lengths respond to the weights of whole neighborhoods.
void reweight(std::vector<WeightedEdge>& edges, const std::vector<double>& log_stretch) {
  const double center = mean(log_stretch);
  for_each_polled(edges.size(), [&](std::size_t k) { edges[k].weight *= std::exp(0.5 * (log_stretch[k] - center)); });
}

/// Nearly removes the edges between vertices equally far from the circle. Edges around a limb then no longer contract
/// it, so its rings are evenly spaced.
void weaken_rings(std::vector<WeightedEdge>& edges, const BoundaryLoop& circle, Eigen::Index n) {
  std::vector<std::array<int, 2>> ends;
  ends.reserve(edges.size());
  for (const WeightedEdge& edge : edges) ends.push_back({edge.i, edge.j});
  const std::vector<int> steps = steps_from(Adjacency(static_cast<int>(n), ends), circle);
  // Positive, as the theorem requires, and far above rounding relative to 1.
  for (WeightedEdge& edge : edges) edge.weight = steps[edge.i] == steps[edge.j] ? single_rounding : 1;
}

struct Embedding {
  ComplexVector z;  ///< empty if there is none
  int flipped = std::numeric_limits<int>::max();
  double unevenness = 0;  ///< variance of log_stretch
};

/// The best of several rounds, each reweighting the previous one.
Embedding reweighted_embedding(const std::vector<std::array<int, 3>>& triangles, std::vector<WeightedEdge>& edges,
                               TutteSystem& system, ComplexVector z, const Progress& progress) {
  Embedding best;
  constexpr int rounds = 10;  // bounds the time: one factorization each
  for (int round = 0; round < rounds; ++round) {
    report(progress, static_cast<double>(round) / rounds, "embedding");
    if (!system.solve(z)) break;
    const std::vector<double> stretch = log_stretch(edges, z);
    const int flipped = static_cast<int>(non_positive_triangles(triangles, z).size());
    const double unevenness = variance(stretch);
    if (best.z.size() == 0 || std::tie(flipped, unevenness) < std::tie(best.flipped, best.unevenness)) {
      best = {z, flipped, unevenness};
    }
    reweight(edges, stretch);
  }
  return best;
}

}  // namespace

ComplexVector tutte_embedding(const std::vector<std::array<int, 3>>& triangles, const std::vector<BoundaryLoop>& loops,
                              int outer, const Eigen::Ref<const Positions>& positions, FactorizationBackend backend,
                              const Progress& progress) {
  std::vector<WeightedEdge> edges = weighted_edges(triangles, loops, outer, positions);
  const BoundaryLoop& circle = loops[static_cast<std::size_t>(outer)];
  const Eigen::Index n = positions.rows() + static_cast<Eigen::Index>(loops.size()) - 1;
  ComplexVector z = ComplexVector::Zero(n);
  map_to_circle(circle, positions, z);
  TutteSystem equations(edges, circle, n, backend);
  Embedding best = reweighted_embedding(triangles, edges, equations, z, part(progress, 0, 0.5));
  if (best.flipped > 0) {
    weaken_rings(edges, circle, n);
    Embedding other = reweighted_embedding(triangles, edges, equations, z, part(progress, 0.5, 1));
    if (other.flipped < best.flipped) best = std::move(other);
  }
  return best.z.size() == 0 ? best.z : best.z.head(positions.rows());
}

}  // namespace spectral_conformal
