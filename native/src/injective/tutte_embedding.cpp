#include "injective/tutte_embedding.h"

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <tuple>
#include <utility>

#include "mesh/boundary_loops.h"
#include "quality/flips.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal {
namespace {

struct Spring {
  int i;
  int j;
  double length;  ///< in 3D
  double weight = 1;
};

/// The edges of the triangles and the spokes of the holes, whose middles are the vertices from V on.
std::vector<Spring> make_springs(const std::vector<std::array<int, 3>>& triangles,
                                 const std::vector<BoundaryLoop>& loops, int outer,
                                 const Eigen::Ref<const Positions>& positions) {
  std::vector<std::pair<int, int>> edges;
  edges.reserve(3 * triangles.size());
  for (const auto& triangle : triangles) {
    for (int k = 0; k < 3; ++k) edges.push_back(std::minmax(triangle[k], triangle[(k + 1) % 3]));
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<Spring> springs;
  springs.reserve(edges.size());
  double total = 0;
  for (const auto& [i, j] : edges) {
    springs.push_back({i, j, (positions.row(i) - positions.row(j)).norm()});
    total += springs.back().length;
  }
  // Edges without length must have a place, too.
  const double least = 1e-3 * total / static_cast<double>(edges.size());
  for (Spring& spring : springs) spring.length = std::max(spring.length, least);
  int middle = static_cast<int>(positions.rows());
  for (std::size_t k = 0; k < loops.size(); ++k) {
    if (static_cast<int>(k) == outer) continue;
    const double radius = std::max(loop_length(loops[k], positions) / 6, least);
    for (const int v : loops[k]) springs.push_back({v, middle, radius});
    ++middle;
  }
  return springs;
}

/// Points of the unit circle, their distances in proportion to the loop's edges.
void lay_on_circle(const BoundaryLoop& loop, const Eigen::Ref<const Positions>& positions, ComplexVector& z) {
  const double least = 1e-3 * loop_length(loop, positions) / static_cast<double>(loop.size());
  std::vector<double> reached{0};
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const double edge = (positions.row(loop[(i + 1) % loop.size()]) - positions.row(loop[i])).norm();
    reached.push_back(reached.back() + std::max(edge, least));
  }
  constexpr double pi = 3.14159265358979323846;
  for (std::size_t i = 0; i < loop.size(); ++i) z[loop[i]] = std::polar(1.0, 2 * pi * reached[i] / reached.back());
}

/// The equations of the vertices that are not on the circle.
class Equilibrium {
 public:
  Equilibrium(const std::vector<Spring>& springs, const BoundaryLoop& circle, Eigen::Index n,
              FactorizationBackend backend)
      : springs_(springs), unknown_(static_cast<std::size_t>(n), 0) {
    for (const int v : circle) unknown_[v] = -1;
    int count = 0;
    for (std::size_t v = 0; v < unknown_.size(); ++v) {
      if (unknown_[v] == 0) unknown_[v] = count++;
    }
    n_unknown_ = count;
    if (count > 0) factorization_ = make_factorization(backend, count);
  }

  /// Moves all vertices but those on the circle to the weighted means of their neighbours.
  void solve(ComplexVector& z) {
    if (n_unknown_ == 0) return;
    std::vector<Eigen::Triplet<Complex>> entries;
    entries.reserve(3 * springs_.size());
    ComplexVector pull = ComplexVector::Zero(n_unknown_);
    for (const Spring& spring : springs_) {
      const int i = unknown_[spring.i];
      const int j = unknown_[spring.j];
      if (i >= 0) entries.emplace_back(i, i, spring.weight);
      if (j >= 0) entries.emplace_back(j, j, spring.weight);
      if (i >= 0 && j >= 0) entries.emplace_back(std::max(i, j), std::min(i, j), -spring.weight);
      if (i >= 0 && j < 0) pull[i] += spring.weight * z[spring.j];
      if (j >= 0 && i < 0) pull[j] += spring.weight * z[spring.i];
    }
    HermitianMatrix matrix(n_unknown_, n_unknown_);
    matrix.setFromTriplets(entries.begin(), entries.end());
    if (!analyzed_) factorization_->analyze(matrix);
    analyzed_ = true;
    if (!factorization_->factorize(matrix)) {
      throw SolveFailure("The embedding into a circle could not be solved in double precision",
                         "add seams that make the patch flatter.");
    }
    ComplexVector place;
    factorization_->solve(pull, place);
    for (std::size_t v = 0; v < unknown_.size(); ++v) {
      if (unknown_[v] >= 0) z[static_cast<Eigen::Index>(v)] = place[unknown_[v]];
    }
  }

 private:
  const std::vector<Spring>& springs_;
  std::vector<int> unknown_;  ///< number of the unknown of each vertex, -1 on the circle
  int n_unknown_ = 0;
  std::unique_ptr<Factorization> factorization_;
  bool analyzed_ = false;
};

/// The logarithm of every edge's length in the plane over that in 3D.
std::vector<double> log_stretch(const std::vector<Spring>& springs, const ComplexVector& z) {
  constexpr double least = 1e-15;
  std::vector<double> result;
  result.reserve(springs.size());
  for (const Spring& spring : springs) {
    result.push_back(std::log(std::max(std::abs(z[spring.i] - z[spring.j]), least) / spring.length));
  }
  return result;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double variance(const std::vector<double>& values) {
  const double centre = mean(values);
  double sum = 0;
  for (const double value : values) sum += (value - centre) * (value - centre);
  return sum / static_cast<double>(values.size());
}

/// Weakens the springs along edges that are short in the plane for their length in 3D, and strengthens the others.
void spread(std::vector<Spring>& springs, const std::vector<double>& log_stretch) {
  constexpr double most = 23;  // a factor of 1e10
  const double centre = mean(log_stretch);
  for (std::size_t k = 0; k < springs.size(); ++k) {
    springs[k].weight *= std::exp(0.5 * std::clamp(log_stretch[k] - centre, -most, most));
  }
}

/// For every vertex the least number of springs to the circle.
std::vector<int> steps_from_circle(const std::vector<Spring>& springs, const BoundaryLoop& circle, Eigen::Index n) {
  std::vector<std::vector<int>> neighbours(static_cast<std::size_t>(n));
  for (const Spring& spring : springs) {
    neighbours[spring.i].push_back(spring.j);
    neighbours[spring.j].push_back(spring.i);
  }
  std::vector<int> steps(neighbours.size(), -1);
  std::vector<int> reached(circle.begin(), circle.end());
  for (const int v : circle) steps[v] = 0;
  for (std::size_t k = 0; k < reached.size(); ++k) {
    for (const int v : neighbours[reached[k]]) {
      if (steps[v] >= 0) continue;
      steps[v] = steps[reached[k]] + 1;
      reached.push_back(v);
    }
  }
  return steps;
}

/// Nearly slack springs between vertices that are equally far from the circle: what goes round a limb no longer draws
/// it together, so that its rings follow each other at even distances.
void loosen_rings(std::vector<Spring>& springs, const BoundaryLoop& circle, Eigen::Index n) {
  constexpr double slack = 1e-6;
  const std::vector<int> steps = steps_from_circle(springs, circle, n);
  for (Spring& spring : springs) spring.weight = steps[spring.i] == steps[spring.j] ? slack : 1;
}

struct Embedding {
  ComplexVector z;
  int flipped = 0;
  double unevenness = 0;  ///< variance of log_stretch
};

/// The best of several rounds, each of which spreads the last one.
Embedding spread_embedding(const std::vector<std::array<int, 3>>& triangles, std::vector<Spring>& springs,
                           Equilibrium& equilibrium, ComplexVector z, const Progress& progress) {
  Embedding best;
  constexpr int rounds = 10;
  for (int round = 0; round < rounds; ++round) {
    report(progress, static_cast<double>(round) / rounds, "embedding");
    equilibrium.solve(z);
    const std::vector<double> stretch = log_stretch(springs, z);
    const int flipped = static_cast<int>(non_positive_triangles(triangles, z).size());
    const double unevenness = variance(stretch);
    if (round == 0 || std::tie(flipped, unevenness) < std::tie(best.flipped, best.unevenness)) {
      best = {z, flipped, unevenness};
    }
    spread(springs, stretch);
  }
  return best;
}

}  // namespace

ComplexVector convex_embedding(const std::vector<std::array<int, 3>>& triangles, const std::vector<BoundaryLoop>& loops,
                               int outer, const Eigen::Ref<const Positions>& positions, FactorizationBackend backend,
                               const Progress& progress) {
  std::vector<Spring> springs = make_springs(triangles, loops, outer, positions);
  const BoundaryLoop& circle = loops[static_cast<std::size_t>(outer)];
  const Eigen::Index n = positions.rows() + static_cast<Eigen::Index>(loops.size()) - 1;
  ComplexVector z = ComplexVector::Zero(n);
  lay_on_circle(circle, positions, z);
  Equilibrium equilibrium(springs, circle, n, backend);
  Embedding best = spread_embedding(triangles, springs, equilibrium, z, part(progress, 0, 0.5));
  if (best.flipped > 0) {
    loosen_rings(springs, circle, n);
    Embedding loose = spread_embedding(triangles, springs, equilibrium, z, part(progress, 0.5, 1));
    if (loose.flipped < best.flipped) best = std::move(loose);
  }
  return best.z.head(positions.rows());
}

}  // namespace spectral_conformal
