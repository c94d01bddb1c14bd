#include "layout/congruent_islands.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <set>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "geometry/bounding_rectangles.h"
#include "geometry/signed_area.h"
#include "geometry/tolerances.h"

namespace spectral_conformal {
namespace {

/// What congruent outlines have in common.
struct Signature {
  double length = 0;     ///< of all edges
  double diameter = 0;   ///< of the bounding box, along the diagonal
  Complex center = 0;    ///< of the edges, weighted by length
  Complex farthest = 0;  ///< end of an edge, from the center
};

Signature signature_of(const IslandOutline& island) {
  Signature result;
  Complex sum = 0;
  for (const OutlineEdge& edge : island.edges) {
    const double length = std::abs(edge.to - edge.from);
    result.length += length;
    sum += 0.5 * length * (edge.from + edge.to);
  }
  result.center = result.length > 0 ? sum / result.length : island.edges.front().from;
  for (const OutlineEdge& edge : island.edges) {
    const Complex out = edge.from - result.center;
    if (std::norm(out) > std::norm(result.farthest)) result.farthest = out;
  }
  result.diameter = 2 * std::abs(result.farthest);
  return result;
}

PlaneMotion inverse(const PlaneMotion& motion) {
  const Complex factor = motion.mirrors ? 1.0 / std::conj(motion.factor) : 1.0 / motion.factor;
  PlaneMotion result{factor, motion.mirrors, 0};
  result.offset = -result(motion.offset);
  return result;
}

bool coincide(const IslandOutline& one, const PlaneMotion& motion, const IslandOutline& other, double tolerance) {
  return lies_on(one, motion, other, tolerance) && lies_on(other, inverse(motion), one, tolerance);
}

/// The rigid motion of `one` onto `other` with the least distance between the outlines, up to a factor of 2, if there
/// is any within the tolerance: it maps the center to the center, and the farthest point of `one` to a point equally
/// far.
std::optional<PlaneMotion> motion_onto(const IslandOutline& one, const Signature& of_one, const IslandOutline& other,
                                       const Signature& of_other, Congruence congruence, double tolerance) {
  if (congruence == Congruence::in_place) {
    if (std::abs(of_one.center - of_other.center) > tolerance || !coincide(one, {}, other, tolerance)) return {};
    return PlaneMotion{};
  }
  const double radius = std::abs(of_one.farthest);
  std::optional<PlaneMotion> best;
  double next = tolerance;  // which a better motion meets
  const double least = single_rounding * radius;
  for (const OutlineEdge& edge : other.edges) {
    const Complex out = edge.from - of_other.center;
    const double distance = std::abs(out);
    if (std::abs(distance - radius) > next) continue;
    for (const bool mirrors : {false, true}) {
      if (mirrors && congruence != Congruence::mirrored) continue;
      PlaneMotion motion;
      motion.mirrors = mirrors;
      if (radius > 0 && distance > 0) {
        motion.factor = out / distance / ((mirrors ? std::conj(of_one.farthest) : of_one.farthest) / radius);
      }
      motion.offset = of_other.center - motion(of_one.center);
      while (coincide(one, motion, other, next)) {
        best = motion;
        // Without a difference but rounding, there is no better one.
        if (next <= least) return best;
        next *= 0.5;
      }
    }
  }
  return best;
}

}  // namespace

bool lies_on(const IslandOutline& island, const PlaneMotion& motion, const IslandOutline& other, double tolerance) {
  const double limit = tolerance * tolerance;
  const std::size_t n = other.edges.size();
  // Neighbors along one outline are usually neighbors along the other, backward after a reflection.
  const std::size_t next = motion.mirrors ? n - 1 : 1;
  std::size_t near = 0;
  for (const OutlineEdge& edge : island.edges) {
    const Complex p = motion(edge.from);
    std::size_t tried = 0;
    while (tried < n && squared_distance(p, other.edges[near]) > limit) {
      near = (near + next) % n;
      ++tried;
    }
    poll(tried + 1);
    if (tried == n) return false;
  }
  return true;
}

std::vector<StackedIsland> congruent_islands(const std::vector<IslandOutline>& islands, Congruence congruence,
                                             double tolerance) {
  const std::size_t n = islands.size();
  std::vector<StackedIsland> result(n);
  std::vector<Signature> signatures(n);
  std::vector<int> order;
  for (std::size_t i = 0; i < n; ++i) {
    result[i].representative = static_cast<int>(i);
    if (islands[i].edges.empty()) continue;
    signatures[i] = signature_of(islands[i]);
    order.push_back(static_cast<int>(i));
  }
  // Candidates are neighbors by size.
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return signatures[static_cast<std::size_t>(a)].diameter < signatures[static_cast<std::size_t>(b)].diameter;
  });
  const auto island_at = [&](int place) { return static_cast<std::size_t>(order[static_cast<std::size_t>(place)]); };
  // The representatives among them, by area and place in this order; their diameters grow with the places.
  std::set<std::pair<double, int>> near;
  int first_near = 0;
  std::vector<int> candidates;
  for (int place = 0; place < static_cast<int>(order.size()); ++place) {
    const std::size_t i = island_at(place);
    const Signature& own = signatures[i];
    const double allowed = tolerance * own.diameter;
    for (; own.diameter - signatures[island_at(first_near)].diameter > 2 * allowed; ++first_near) {
      near.erase({islands[island_at(first_near)].area, first_near});
    }
    const double largest = islands[i].area + allowed * own.length;
    candidates.clear();
    for (auto at = near.lower_bound({islands[i].area - allowed * own.length, 0}); at != near.end(); ++at) {
      if (at->first > largest) break;
      candidates.push_back(at->second);
    }
    std::sort(candidates.rbegin(), candidates.rend());
    bool is_stacked = false;
    for (std::size_t k = 0; k < candidates.size() && !is_stacked; ++k) {
      const std::size_t other = island_at(candidates[k]);
      const auto motion = motion_onto(islands[i], own, islands[other], signatures[other], congruence, allowed);
      if (!motion) continue;
      result[i] = {static_cast<int>(other), *motion};
      is_stacked = true;
    }
    if (!is_stacked) near.emplace(islands[i].area, place);
  }
  return result;
}

}  // namespace spectral_conformal
