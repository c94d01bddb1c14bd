#include "injective/local_unfolding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "concurrency/parallel_calls.h"
#include "graph/grouped.h"
#include "relaxation/descent.h"

namespace spectral_conformal {
namespace {

/// The free vertices, and all elements at one of them.
struct Region {
  std::vector<int> free;
  std::vector<int> elements;
};

class Unfolding {
 public:
  Unfolding(const std::vector<DistortionElement>& elements, const std::vector<char>& held, FactorizationBackend backend,
            ComplexVector& z, const Progress& progress)
      : elements_(elements),
        held_(held),
        backend_(backend),
        z_(z),
        progress_(progress),
        elements_at_(static_cast<int>(z.size()),
                     [&](const auto& visit) {
                       for_each_polled(elements.size(), [&](std::size_t t) {
                         for (const int v : elements[t].corners) visit(v, static_cast<int>(t));
                       });
                     }),
        log_scale_(vertex_log_scale()) {}

  int run() {
    constexpr int max_rings = 64;  // seven rounds; by then the whole map is free on all but large charts
    for (int rings = 1; rings <= max_rings; rings *= 2) {
      done_ = std::log2(rings) / 7;
      report(progress_, done_, "unfold");
      const std::vector<Region> regions = regions_around_flips(rings);
      if (regions.empty()) break;  // nothing is flipped, or nothing flipped may move
      for (const Region& region : regions) unfold(region);
    }
    return count_flipped(elements_, z_, unplaced);
  }

 private:
  bool is_held(int vertex) const { return !held_.empty() && held_[vertex]; }

  /// The mean log scale of the unflipped elements around each vertex, propagated to vertices without any.
  std::vector<double> vertex_log_scale() const {
    std::vector<double> sum(static_cast<std::size_t>(z_.size()), 0);
    std::vector<double> weight(sum.size(), 0);
    for_each_polled(elements_.size(), [&](std::size_t t) {
      const DistortionElement& element = elements_[t];
      if (!element.measured || is_flipped(element, z_, unplaced)) return;
      const double logarithm = 0.5 * std::log(jacobian(element, z_).determinant);
      for (const int v : element.corners) {
        sum[v] += logarithm;
        weight[v] += 1;
      }
    });
    // Each pass reaches one ring further, beyond the vertices that the last one reached.
    std::vector<int> reached;
    for (std::size_t v = 0; v < weight.size(); ++v) {
      if (weight[v] > 0) reached.push_back(static_cast<int>(v));
    }
    while (!reached.empty()) {
      std::vector<int> near;
      for (const int v : reached) near.insert(near.end(), elements_at_[v].begin(), elements_at_[v].end());
      call_while_polling(near.size(), [&] {
        std::sort(near.begin(), near.end());
        near.erase(std::unique(near.begin(), near.end()), near.end());
      });
      std::vector<std::pair<int, double>> values;
      for (const int t : near) {
        const std::array<int, 3>& corners = elements_[t].corners;
        for (int k = 0; k < 3; ++k) {
          if (weight[corners[k]] > 0) continue;
          for (const int other : {corners[(k + 1) % 3], corners[(k + 2) % 3]}) {
            if (weight[other] > 0) values.emplace_back(corners[k], sum[other] / weight[other]);
          }
        }
      }
      reached.clear();
      for (const auto& [v, value] : values) {
        if (weight[v] == 0) reached.push_back(v);
        sum[v] += value;
        weight[v] += 1;
      }
    }
    for (std::size_t v = 0; v < sum.size(); ++v) sum[v] = weight[v] > 0 ? sum[v] / weight[v] : 0;
    return sum;
  }

  /// The corners of flipped elements and the vertices within rings - 1 edges of them, by connected components.
  std::vector<Region> regions_around_flips(int rings) const {
    std::vector<char> near(static_cast<std::size_t>(z_.size()), 0);
    std::vector<int> reached;
    const auto reach = [&](int v) {
      if (near[v]) return;
      near[v] = 1;
      reached.push_back(v);
    };
    for_each_polled(elements_.size(), [&](std::size_t t) {
      if (!is_flipped(elements_[t], z_, unplaced)) return;
      for (const int v : elements_[t].corners) reach(v);
    });
    std::size_t ring_begin = 0;
    for (int ring = 1; ring < rings; ++ring) {
      const std::size_t ring_end = reached.size();
      for (; ring_begin < ring_end; ++ring_begin) {
        for (const int t : elements_at_[reached[ring_begin]]) {
          for (const int v : elements_[t].corners) reach(v);
        }
        poll();
      }
    }
    return connected_components(near, reached);
  }

  std::vector<Region> connected_components(std::vector<char>& near, const std::vector<int>& reached) const {
    std::vector<Region> regions;
    std::vector<char> taken(elements_.size(), 0);
    for (const int seed : reached) {
      if (!near[seed]) continue;
      Region region;
      std::vector<int> open{seed};
      near[seed] = 0;
      while (!open.empty()) {
        const int v = open.back();
        open.pop_back();
        poll();
        if (!is_held(v)) region.free.push_back(v);
        for (const int t : elements_at_[v]) {
          if (!taken[t]) region.elements.push_back(t);
          taken[t] = 1;
          for (const int other : elements_[t].corners) {
            if (!near[other]) continue;
            near[other] = 0;
            open.push_back(other);
          }
        }
      }
      call_while_polling(region.elements.size(), [&] { std::sort(region.elements.begin(), region.elements.end()); });
      if (!region.free.empty()) regions.push_back(std::move(region));
    }
    return regions;
  }

  void unfold(const Region& region) {
    // A separate problem with its own vertex indices.
    std::vector<int> vertices;
    call_while_polling(3 * region.elements.size(), [&] {
      for (const int t : region.elements)
        vertices.insert(vertices.end(), elements_[t].corners.begin(), elements_[t].corners.end());
      std::sort(vertices.begin(), vertices.end());
      vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    });
    const auto index = [&](int v) {
      return static_cast<int>(std::lower_bound(vertices.begin(), vertices.end(), v) - vertices.begin());
    };
    std::vector<char> fixed(vertices.size(), 1);
    for (const int v : region.free) fixed[index(v)] = 0;
    if (std::find(fixed.begin(), fixed.end(), 1) == fixed.end()) fixed.clear();
    std::vector<DistortionElement> local;
    double log_scale = 0;
    for (const int v : region.free) log_scale += log_scale_[v] / static_cast<double>(region.free.size());
    for (const int t : region.elements) {
      DistortionElement element = elements_[t];
      const auto& [a, b, c] = element.corners;
      // The side of its undistorted image, in units of the region's mean scale.
      const double scale = std::exp((log_scale_[a] + log_scale_[b] + log_scale_[c]) / 3 - log_scale);
      element.shape = element.shape.scaled(scale);
      element.weight = 1 / static_cast<double>(region.elements.size());
      element.corners = {index(a), index(b), index(c)};
      local.push_back(element);
      poll();
    }
    ComplexVector z(static_cast<Eigen::Index>(vertices.size()));
    const Complex origin = z_[vertices.front()];
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      z[static_cast<Eigen::Index>(i)] = (z_[vertices[i]] - origin) * std::exp(-log_scale);
    }
    poll(vertices.size());
    if (!descend_to_unfold(local, fixed, z)) return;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      if (fixed.empty() || !fixed[i]) z_[vertices[i]] = origin + std::exp(log_scale) * z[static_cast<Eigen::Index>(i)];
    }
  }

  /// Returns whether fewer elements are flipped than before.
  bool descend_to_unfold(std::vector<DistortionElement>& local, const std::vector<char>& fixed,
                         ComplexVector& z) const {
    const Progress still_there = [this](double, const char* phase) { return !progress_ || progress_(done_, phase); };
    const ComplexVector given = z;
    const std::vector<DistortionElement> given_elements = local;
    const int before = count_flipped(local, z, unplaced);
    int left = before;
    // What is not flipped stays so, unless some cannot pass it.
    for (const bool may_flip : {false, true}) {
      if (left == 0) break;
      std::vector<DistortionElement> elements = given_elements;
      ComplexVector moved = given;
      DescentOptions options{DistortionMeasure::symmetric_dirichlet, 1e-2, 30};
      options.may_flip = may_flip;
      descend(elements, fixed, moved, backend_, options, still_there);
      const int after = moved.allFinite() ? count_flipped(elements, moved, unplaced) : left;
      if (after >= left) continue;
      left = after;
      z = std::move(moved);
      local = std::move(elements);
    }
    if (left > 0) return left < before;
    // Some unflipped elements have too little area for the descent to have raised their barrier.
    for (DistortionElement& element : local) {
      if (element.without_area()) element.regularization = 0;
    }
    ComplexVector relaxed = z;
    descend(local, fixed, relaxed, backend_, {DistortionMeasure::conformal, 1e-3, 20}, still_there);
    if (relaxed.allFinite() && count_flipped(local, relaxed, unplaced) == 0) z = std::move(relaxed);
    return true;
  }

  const std::vector<DistortionElement>& elements_;
  const std::vector<char>& held_;
  FactorizationBackend backend_;
  ComplexVector& z_;
  const Progress& progress_;
  Grouped<int> elements_at_;  ///< each vertex
  double done_ = 0;
  std::vector<double> log_scale_;
};

}  // namespace

int unfold_locally(const std::vector<DistortionElement>& elements, const std::vector<char>& held,
                   FactorizationBackend backend, ComplexVector& z, const Progress& progress) {
  return Unfolding(elements, held, backend, z, progress).run();
}

}  // namespace spectral_conformal
