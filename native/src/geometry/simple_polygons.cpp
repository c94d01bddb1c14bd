#include "geometry/simple_polygons.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <set>

#include "concurrency/cancellation_scope.h"
#include "concurrency/parallel_calls.h"
#include "geometry/orientation.h"
#include "geometry/signed_area.h"

namespace spectral_conformal {
namespace {

/// Two edges of one vertex overlap if they leave it in the same direction.
bool leave_alike(Complex shared, Complex first, Complex second) {
  return orientation(first, shared, second) == 0 && !(dot(first - shared, second - shared) < 0);
}

class EdgeSweep {
 public:
  EdgeSweep(const std::vector<BoundaryLoop>& polygons, const ComplexVector& z) : z_(z), line_(Above{this}) {
    for (const BoundaryLoop& polygon : polygons) {
      const std::size_t first = edges_.size();
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const int from = polygon[i];
        const int to = polygon[(i + 1) % polygon.size()];
        corners_.push_back({from, {first + (i + polygon.size() - 1) % polygon.size(), first + i}});
        edges_.push_back(is_left_of(z[to], z[from]) ? Edge{to, from} : Edge{from, to});
      }
    }
    places_.assign(edges_.size(), line_.end());
  }

  bool finds_all_apart() {
    call_while_polling(corners_.size(), [&] {
      std::sort(corners_.begin(), corners_.end(),
                [&](const Corner& a, const Corner& b) { return is_left_of(z_[a.vertex], z_[b.vertex]); });
    });
    const auto coincide = [&](const Corner& a, const Corner& b) { return z_[a.vertex] == z_[b.vertex]; };
    if (std::adjacent_find(corners_.begin(), corners_.end(), coincide) != corners_.end()) return false;
    for (const Corner& corner : corners_) {
      poll();
      for (const std::size_t e : corner.edges) {
        if (edges_[e].right == corner.vertex && !end(e)) return false;
      }
      for (const std::size_t e : corner.edges) {
        if (edges_[e].left == corner.vertex && !begin(e)) return false;
      }
    }
    return true;
  }

 private:
  struct Edge {
    int left;
    int right;
  };
  struct Corner {
    int vertex;
    std::array<std::size_t, 2> edges;
  };
  /// The order along the line, as far as an edge that begins needs it.
  struct Above {
    const EdgeSweep* sweep;
    bool operator()(std::size_t e, std::size_t other) const {
      return e == sweep->begun_ ? sweep->begins_below(other) : !sweep->begins_below(e);
    }
  };
  using Line = std::multiset<std::size_t, Above>;

  /// Whether the edge that begins lies below another on the line. If the two overlap, either answer will do.
  bool begins_below(std::size_t other) const {
    const auto& [left, right] = edges_[other];
    const Edge& own = edges_[begun_];
    return orientation(z_[left], z_[right], z_[own.left == left ? own.right : own.left]) < 0;
  }

  /// Whether an edge and its neighbors on the line are apart where it begins.
  bool begin(std::size_t e) {
    begun_ = e;
    const auto place = line_.insert(e);
    places_[e] = place;
    return is_apart_from_below(place) && is_apart_from_below(std::next(place));
  }
  /// Whether the edges that become neighbors where another ends are apart.
  bool end(std::size_t e) { return is_apart_from_below(line_.erase(places_[e])); }

  bool is_apart_from_below(Line::iterator place) const {
    return place == line_.end() || place == line_.begin() || are_apart(*std::prev(place), *place);
  }
  bool are_apart(std::size_t e, std::size_t other) const {
    const Edge& first = edges_[e];
    const Edge& second = edges_[other];
    // Each vertex has two edges: these are neighbors.
    if (first.left == second.left) return !leave_alike(z_[first.left], z_[first.right], z_[second.right]);
    if (first.right == second.right) return !leave_alike(z_[first.right], z_[first.left], z_[second.left]);
    return lies_beside(first, second) || lies_beside(second, first);
  }
  bool lies_beside(const Edge& edge, const Edge& line) const {
    const int side = orientation(z_[line.left], z_[line.right], z_[edge.left]);
    return side != 0 && side == orientation(z_[line.left], z_[line.right], z_[edge.right]);
  }

  const ComplexVector& z_;
  std::vector<Edge> edges_;
  std::vector<Corner> corners_;  ///< with their edges, in the order of the sweep
  std::size_t begun_ = 0;        ///< the last edge that began
  Line line_;                    ///< edges that meet the line, from below
  std::vector<Line::iterator> places_;
};

}  // namespace

bool are_simple_polygons(const std::vector<BoundaryLoop>& polygons, const ComplexVector& z) {
  return EdgeSweep(polygons, z).finds_all_apart();
}

}  // namespace spectral_conformal
