#include "linear_algebra/nested_dissection.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "concurrency/parallel_calls.h"
#include "graph/vertex_separator.h"

namespace spectral_conformal {
namespace {

/// A part with at most this many nodes is a leaf: minimum degree orders it nearly as well, in less time.
constexpr int max_leaf_size = 2000;
/// Directions tried, of which the best is refined.
constexpr int n_directions = 8;
/// Largest distance of a separator from the plane, in edges: on a triangle mesh with 535,000 vertices, 0, 3 and 12 give
/// 7.4e9, 7.0e9 and 6.7e9 multiplications, in 0.02, 0.14 and 0.68 s.
constexpr int max_distance = 3;

class Dissector {
 public:
  Dissector(const Adjacency& graph, const Eigen::Ref<const Positions>& positions)
      : graph_(graph),
        positions_(positions),
        part_of_(static_cast<std::size_t>(graph.n_nodes()), 0),
        side_(part_of_.size(), SeparatorSide::sink),
        near_index_(part_of_.size(), no_index) {}

  NestedDissection run() {
    result_.order.resize(part_of_.size());
    std::iota(result_.order.begin(), result_.order.end(), 0);
    std::vector<Part> parts{{0, graph_.n_nodes(), 0}};
    while (!parts.empty()) parts = dissect(parts);
    return std::move(result_);
  }

 private:
  struct Part {
    int begin;
    int end;  ///< in the order
    int number;
    int size() const { return end - begin; }
  };
  /// The ends of the two halves of a part; the rest is its separator.
  struct Halves {
    int first_end = no_index;
    int second_end = no_index;
  };

  /// Cuts the parts and returns their parts. Of other parts, threads read only `part_of_`, which does not change
  /// meanwhile.
  std::vector<Part> dissect(const std::vector<Part>& parts) {
    std::vector<Halves> halves(parts.size());
    run_in_parallel(
        static_cast<int>(parts.size()),
        [&](int i, const Progress&) {
          const auto k = static_cast<std::size_t>(i);
          if (parts[k].size() > max_leaf_size) halves[k] = cut(parts[k]);
        },
        {}, "");
    std::vector<Part> next;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const Part& part = parts[k];
      if (halves[k].first_end == no_index) {
        if (part.size() > 0) result_.leaves.push_back({part.begin, part.end});
        continue;
      }
      add(part.begin, halves[k].first_end, next);
      add(halves[k].first_end, halves[k].second_end, next);
      for (int i = halves[k].second_end; i < part.end; ++i) part_of_[result_.order[i]] = no_index;
    }
    return next;
  }

  void add(int begin, int end, std::vector<Part>& parts) {
    parts.push_back({begin, end, ++last_number_});
    for (int i = begin; i < end; ++i) part_of_[result_.order[i]] = last_number_;
  }

  /// Orders the nodes of a part by side.
  Halves cut(const Part& part) {
    const Plane plane = this->plane(part);
    poll();
    for (int i = part.begin; i < part.end; ++i) {
      const int node = result_.order[i];
      const bool is_below = positions_.row(node).dot(plane.normal) < plane.height;
      side_[node] = is_below ? SeparatorSide::source : SeparatorSide::sink;
    }
    poll(part.size());
    separate(part);
    std::array<std::vector<int>, 3> nodes;
    for (int i = part.begin; i < part.end; ++i) {
      const int node = result_.order[i];
      const SeparatorSide side = side_[node];
      nodes[side == SeparatorSide::source ? 0 : side == SeparatorSide::sink ? 1 : 2].push_back(node);
    }
    poll(part.size());
    if (nodes[0].empty() || nodes[1].empty()) return {};
    auto at = result_.order.begin() + part.begin;
    for (const std::vector<int>& each : nodes) at = std::copy(each.begin(), each.end(), at);
    const int first_end = part.begin + static_cast<int>(nodes[0].size());
    return {first_end, first_end + static_cast<int>(nodes[1].size())};
  }

  /// normal . x = height.
  struct Plane {
    Eigen::RowVector3d normal;
    double height;
  };

  /// A plane that halves a sample of the part's nodes and cuts few of them.
  Plane plane(const Part& part) const {
    const int n_samples = std::min(part.size(), std::min(128 + part.size() / 128, 2000));
    std::vector<int> sample;
    sample.reserve(static_cast<std::size_t>(n_samples));
    Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
    for (int k = 0; k < n_samples; ++k) {
      const auto at = part.begin + static_cast<std::ptrdiff_t>(part.size()) * k / n_samples;
      sample.push_back(result_.order[static_cast<std::size_t>(at)]);
      mean += positions_.row(sample.back()) / n_samples;
    }
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const int node : sample) {
      const Eigen::RowVector3d offset = positions_.row(node) - mean;
      covariance += offset.transpose() * offset;
    }
    // Planes along the direction of least extent cut a surface along its shortest lines.
    const Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors();
    const Eigen::Matrix<double, 3, 2> across = axes.rightCols<2>();
    std::vector<Eigen::RowVector2d> points;
    std::vector<Eigen::RowVector2d> edges;
    std::vector<std::size_t> last_edge;
    for (const int node : sample) {
      points.emplace_back((positions_.row(node) - mean) * across);
      for (const Adjacency::Arc arc : graph_.arcs(node)) {
        if (part_of_[arc.to] == part.number)
          edges.emplace_back((positions_.row(arc.to) - positions_.row(node)) * across);
      }
      last_edge.push_back(edges.size());
    }
    Plane best{Eigen::RowVector3d::Zero(), 0};
    double fewest = infinity;
    std::vector<double> height(sample.size());
    std::vector<double> sorted;
    const auto try_angle = [&](double angle) {
      const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
      for (std::size_t i = 0; i < points.size(); ++i) height[i] = points[i] * direction;
      sorted = height;
      std::sort(sorted.begin(), sorted.end());
      const double low = sorted[sorted.size() / 3];
      const double high = sorted[sorted.size() - 1 - sorted.size() / 3];
      if (!(high > low)) return false;
      // The mean number of sample nodes that a plane in the middle third separates from a neighbor above it.
      double n_cut = 0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (height[i] < low || height[i] > high) continue;
        double above = 0;
        for (std::size_t e = i == 0 ? 0 : last_edge[i - 1]; e < last_edge[i]; ++e) {
          above = std::max(above, edges[e].dot(direction));
        }
        n_cut += above / (high - low);
      }
      if (n_cut >= fewest) return false;
      fewest = n_cut;
      best.normal = (across * direction).transpose();
      best.height = mean.dot(best.normal) + sorted[sorted.size() / 2];
      return true;
    };
    double best_angle = 0;
    double step = pi / n_directions;
    for (int k = 0; k < n_directions; ++k) {
      if (try_angle(k * step)) best_angle = k * step;
    }
    // A plane along the rows of a grid cuts fewer nodes than one rotated by a few degrees: refine until the rotation no
    // longer moves the plane's ends from row to row.
    while (step * step * part.size() > 1) {
      step /= 2;
      const double angle = best_angle;
      for (const double turned : {angle - step, angle + step}) {
        if (try_angle(turned)) best_angle = turned;
      }
    }
    return best;
  }

  /// Finds a smallest separator among the nodes near the cut, if these are few enough.
  void separate(const Part& part) {
    const std::vector<int> near = near_cut(part);
    std::vector<char> is_source(near.size(), 0);
    std::vector<char> is_sink(near.size(), 0);
    const auto for_each_arc = [&](const auto& visit) {
      for (std::size_t i = 0; i < near.size(); ++i) {
        for (const Adjacency::Arc arc : graph_.arcs(near[i])) {
          if (part_of_[arc.to] == part.number) visit(static_cast<int>(i), arc.to);
        }
      }
    };
    for_each_arc([&](int from, int to) {
      if (near_index_[to] == no_index) (side_[to] == SeparatorSide::source ? is_source : is_sink)[from] = 1;
    });
    const Adjacency graph = Adjacency::from_arcs(static_cast<int>(near.size()), [&](const auto& visit) {
      for_each_arc([&](int from, int to) {
        if (near_index_[to] != no_index) visit(from, no_index, near_index_[to]);
      });
    });
    const std::vector<SeparatorSide> side = smallest_vertex_separator(graph, is_source, is_sink);
    for (std::size_t i = 0; i < near.size(); ++i) {
      side_[near[i]] = side[i];
      near_index_[near[i]] = no_index;
    }
  }

  /// The part's nodes with a neighbor on the other side, and the nodes within some edges of them, as long as these are
  /// not too many. Sets their near_index_.
  std::vector<int> near_cut(const Part& part) {
    std::vector<int> near;
    const auto add = [&](int node) {
      near_index_[node] = static_cast<int>(near.size());
      near.push_back(node);
    };
    for (int i = part.begin; i < part.end; ++i) {
      const int node = result_.order[i];
      for (const Adjacency::Arc arc : graph_.arcs(node)) {
        if (part_of_[arc.to] != part.number || side_[arc.to] == side_[node]) continue;
        add(node);
        break;
      }
    }
    poll(part.size());
    std::size_t begin = 0;
    for (int distance = 0; distance < max_distance && 4 * near.size() < static_cast<std::size_t>(part.size());
         ++distance) {
      const std::size_t end = near.size();
      for (; begin < end; ++begin) {
        for (const Adjacency::Arc arc : graph_.arcs(near[begin])) {
          if (part_of_[arc.to] == part.number && near_index_[arc.to] == no_index) add(arc.to);
        }
      }
    }
    return near;
  }

  const Adjacency& graph_;
  const Eigen::Ref<const Positions>& positions_;
  NestedDissection result_;
  std::vector<int> part_of_;
  std::vector<SeparatorSide> side_;
  std::vector<int> near_index_;  ///< index among the nodes near the cut of the current part
  int last_number_ = 0;
};

}  // namespace

NestedDissection nested_dissection(const Adjacency& graph, const Eigen::Ref<const Positions>& positions) {
  return Dissector(graph, positions).run();
}

}  // namespace spectral_conformal
