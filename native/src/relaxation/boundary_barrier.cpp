#include "relaxation/boundary_barrier.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "geometry/quadratic_roots.h"
#include "geometry/signed_area.h"
#include "geometry/tolerances.h"

namespace spectral_conformal {
namespace {

/// D relative to the shortest edge: a corner of three edges of 15 degrees or more feels no force.
constexpr double relative_reach = 0.25;
/// Small, so that contacts hardly deform the map and do not stop it early: on patches grown at random on 17 models, 1
/// left mean QCs of up to 45 where this leaves 1.003.
constexpr double weight_of_all = 1e-4;
/// More make a vertex cost as much as all others.
constexpr std::size_t max_contacts = 64;

/// The nearest point of an edge, seen from a given point.
struct Nearest {
  double position;  ///< from 0 to 1
  Complex away;     ///< from there to the given point
  double square;    ///< squared length of the edge
};

Nearest nearest_point(Complex point, Complex from, Complex to) {
  const Complex side = to - from;
  const double square = std::norm(side);
  const double position = square > 0 ? std::clamp(dot(side, point - from) / square, 0.0, 1.0) : 0.0;
  const Complex away = point - from - position * side;
  return {position, away, std::norm(away)};
}

/// The time, within one step, at which a moving point (from `point`, by `moves`) meets a moving segment.
double time_of_contact(Complex point, Complex moves, Complex a, Complex a_moves, Complex b, Complex b_moves) {
  // Extend the segment a little, since rounding may put a point that meets its end there.
  const Complex side = b - a;
  const Complex side_moves = b_moves - a_moves;
  const Complex arm = point - a;
  const Complex arm_moves = moves - a_moves;
  double first = infinity;
  for (const double t : quadratic_roots(cross(side, arm), cross(side, arm_moves) + cross(side_moves, arm),
                                        cross(side_moves, arm_moves))) {
    if (!(t >= 0 && t <= 1 && t < first)) continue;
    const Complex then = side + t * side_moves;
    const double along = dot(then, arm + t * arm_moves);
    if (along >= -insignificant * std::norm(then) && along <= (1 + insignificant) * std::norm(then)) first = t;
  }
  return first;
}

}  // namespace

bool BoundaryBarrier::is_apart(std::size_t i, int edge) const {
  const int vertex = edges_[i].from;
  const BoundaryEdge& other = edges_[static_cast<std::size_t>(edge)];
  if (other.from == vertex || other.to == vertex) return false;
  return touched_.empty() || !std::binary_search(touched_[i].begin(), touched_[i].end(), edge);
}

SegmentTree BoundaryBarrier::tree_along(const ComplexVector& z, const ComplexVector& step) const {
  std::vector<MovingSegment> ways;
  ways.reserve(barriers_.size());
  for (const int k : barriers_) {
    const auto& [from, to, length] = edges_[static_cast<std::size_t>(k)];
    ways.push_back({z[from], z[to], step[from], step[to]});
  }
  return SegmentTree::over(ways);
}

bool BoundaryBarrier::list_pairs(const ComplexVector& z, const ComplexVector& step, std::size_t limit,
                                 std::vector<Pair>& pairs) const {
  const SegmentTree tree = tree_along(z, step);
  for (std::size_t i = 0; i < edges_.size() && pairs.size() < limit; ++i) {
    const int vertex = edges_[i].from;
    if (is_ignored_[i]) continue;
    tree.for_each_meeting({z[vertex], reach_[i], step[vertex]}, [&](int b) {
      const int k = barriers_[static_cast<std::size_t>(b)];
      const auto& [from, to, length] = edges_[static_cast<std::size_t>(k)];
      if (is_apart(i, k)) pairs.push_back({vertex, from, to, std::min(reach_[i], relative_reach * length)});
      return pairs.size() < limit;
    });
    poll();
  }
  return pairs.size() < limit;
}

void BoundaryBarrier::pass_hubs(Eigen::Index n_vertices) {
  std::vector<std::size_t> n_passes(static_cast<std::size_t>(n_vertices), 0);
  for (const BoundaryEdge& edge : edges_) ++n_passes[static_cast<std::size_t>(edge.from)];
  const auto is_hub = [&](int v) { return n_passes[static_cast<std::size_t>(v)] > max_contacts; };
  const auto end = std::remove_if(barriers_.begin(), barriers_.end(), [&](int k) {
    const BoundaryEdge& edge = edges_[static_cast<std::size_t>(k)];
    return is_hub(edge.from) || is_hub(edge.to);
  });
  if (end != barriers_.end()) ignores_contacts_ = true;
  barriers_.erase(end, barriers_.end());
}

void BoundaryBarrier::ignore_contacts(const SegmentTree& tree, const ComplexVector& z) {
  std::vector<std::vector<int>> touched(edges_.size());
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const int vertex = edges_[i].from;
    if (is_ignored_[i]) continue;
    // Nearer than a sliver of D, the energy of one pair would exceed that of all triangles.
    tree.for_each_meeting({z[vertex], sliver * reach_[i]}, [&](int b) {
      const int k = barriers_[static_cast<std::size_t>(b)];
      const auto& [from, to, length] = edges_[static_cast<std::size_t>(k)];
      if (from == vertex || to == vertex) return true;
      const double near = sliver * std::min(reach_[i], relative_reach * length);
      // Squared, so that the energy and its derivatives stay finite.
      if (nearest_point(z[vertex], z[from], z[to]).square <= near * near) touched[i].push_back(k);
      return touched[i].size() <= max_contacts;
    });
    if (!touched[i].empty()) ignores_contacts_ = true;
    if (touched[i].size() > max_contacts) is_ignored_[i] = 1;
    std::sort(touched[i].begin(), touched[i].end());
    poll();
  }
  if (ignores_contacts_) touched_ = std::move(touched);
}

void BoundaryBarrier::bound_reach(const SegmentTree& tree, const ComplexVector& z) {
  // With more edges within reach, half the reach will do.
  constexpr int max_near = 64;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const int vertex = edges_[i].from;
    if (is_ignored_[i]) continue;
    double& reach = reach_[i];
    for (bool is_bounded = false; !is_bounded && reach > 0;) {
      double nearest = reach;
      int n_near = 0;
      tree.for_each_meeting({z[vertex], reach}, [&](int b) {
        const int k = barriers_[static_cast<std::size_t>(b)];
        if (!is_apart(i, k)) return true;
        const auto& [from, to, length] = edges_[static_cast<std::size_t>(k)];
        nearest = std::min(nearest, std::sqrt(nearest_point(z[vertex], z[from], z[to]).square));
        return ++n_near < max_near && nearest > 0.5 * reach;
      });
      is_bounded = n_near < max_near && nearest > 0.5 * reach;
      reach = is_bounded ? nearest : std::min(nearest, 0.5 * reach);
    }
    poll();
  }
}

BoundaryBarrier BoundaryBarrier::around(const std::vector<BoundaryLoop>& loops, const ComplexVector& z,
                                        Contacts contacts) {
  BoundaryBarrier result;
  for (const BoundaryLoop& loop : loops) {
    const std::size_t n = loop.size();
    const std::size_t first = result.edges_.size();
    for (std::size_t i = 0; i < n; ++i) {
      const int from = loop[i];
      const int to = loop[(i + 1) % n];
      result.edges_.push_back({from, to, std::abs(z[to] - z[from])});
    }
    for (std::size_t i = 0; i < n; ++i) {
      result.reach_.push_back(relative_reach *
                              std::min(result.edges_[first + i].length, result.edges_[first + (i + n - 1) % n].length));
    }
  }
  // Where parts of the boundary meet, one edge stands for their vertex.
  std::vector<int> edge_from(static_cast<std::size_t>(z.size()), -1);
  for (std::size_t i = 0; i < result.edges_.size(); ++i) {
    int& first = edge_from[static_cast<std::size_t>(result.edges_[i].from)];
    result.is_ignored_.push_back(first >= 0);
    if (first < 0) {
      first = static_cast<int>(i);
    } else {
      result.reach_[first] = std::min(result.reach_[first], result.reach_[i]);
    }
  }
  result.weight_ = weight_of_all / static_cast<double>(result.edges_.size());
  result.barriers_.resize(result.edges_.size());
  std::iota(result.barriers_.begin(), result.barriers_.end(), 0);
  if (contacts == Contacts::counted) return result;
  result.pass_hubs(z.size());
  const SegmentTree tree = result.tree_along(z, ComplexVector::Zero(z.size()));
  result.ignore_contacts(tree, z);
  result.bound_reach(tree, z);
  return result;
}

std::vector<BoundaryBarrier::Pair> BoundaryBarrier::pairs_near(const ComplexVector& z,
                                                               const ComplexVector& step) const {
  std::vector<Pair> pairs;
  list_pairs(z, step, std::numeric_limits<std::size_t>::max(), pairs);
  return pairs;
}

BoundaryBarrier::Way BoundaryBarrier::way_along(const ComplexVector& z, const ComplexVector& step) const {
  // A step of few edges may take them all across each other.
  constexpr std::size_t few = 100000;
  constexpr std::size_t per_edge = 64;
  constexpr double least_part = 1e-6;
  Way way;
  while (way.part > least_part) {
    way.pairs.clear();
    if (list_pairs(z, way.part * step, std::max(few, per_edge * edges_.size()), way.pairs)) return way;
    way.part *= 0.5;
  }
  way.pairs = pairs_near(z, way.part * step);
  return way;
}

double BoundaryBarrier::add(const std::vector<Pair>& pairs, const ComplexVector& z, ComplexVector& gradient) const {
  double energy = 0;
  for (const Pair& pair : pairs) {
    const Nearest nearest = nearest_point(z[pair.vertex], z[pair.from], z[pair.to]);
    if (nearest.square >= pair.reach * pair.reach) continue;
    const double distance = std::sqrt(nearest.square);
    const double excess = pair.reach / distance - 1;
    energy += weight_ * excess * excess;
    if (!(distance > 0)) continue;
    // Motion of the nearest point along the edge changes the distance only to second order.
    const Complex slope = -2 * weight_ * excess * pair.reach / (nearest.square * distance) * nearest.away;
    gradient[pair.vertex] += slope;
    gradient[pair.from] -= (1 - nearest.position) * slope;
    gradient[pair.to] -= nearest.position * slope;
  }
  return std::isfinite(energy) ? energy : infinity;
}

void BoundaryBarrier::add_curvature(const std::vector<Pair>& pairs, const ComplexVector& z,
                                    Eigen::VectorXd& curvature) const {
  for (const Pair& pair : pairs) {
    const Nearest nearest = nearest_point(z[pair.vertex], z[pair.from], z[pair.to]);
    if (nearest.square >= pair.reach * pair.reach || !(nearest.square > 0)) continue;
    const double ratio = pair.reach / std::sqrt(nearest.square);
    const double second = 2 * 2 * weight_ * ratio * (3 * ratio - 2) / nearest.square;
    curvature[pair.vertex] += second;
    curvature[pair.from] += (1 - nearest.position) * second;
    curvature[pair.to] += nearest.position * second;
  }
}

double BoundaryBarrier::max_step(const std::vector<Pair>& pairs, const ComplexVector& z, const ComplexVector& step) {
  double first = infinity;
  for (const auto& [vertex, from, to, reach] : pairs) {
    first = std::min(first, time_of_contact(z[vertex], step[vertex], z[from], step[from], z[to], step[to]));
  }
  return first;
}

}  // namespace spectral_conformal
