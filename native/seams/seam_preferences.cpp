#include "seams/seam_preferences.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace spectral_conformal {
namespace {

/// Cost factor of an avoided edge, as documented: a path up to eight times as long is taken instead.
constexpr double avoided = 8;

}  // namespace

std::vector<double> cost_factors(const SeamSuggestionOptions& options, const SeamGraph& graph,
                                 const std::vector<int>& mesh_vertices) {
  const Eigen::Vector3d front(options.front[0], options.front[1], options.front[2]);
  const double strength = front.norm();
  std::vector<double> factors;
  factors.reserve(graph.edges().size());
  for (const auto& edge : graph.edges()) {
    double factor = 1;
    const double length = edge.normal.norm();
    if (strength > 0 && length > 0) factor += std::max(0.0, front.dot(edge.normal) / length);
    if (options.vertex_preference != nullptr) {
      double sum = 0;
      for (const int v : edge.vertices) {
        sum += options.vertex_preference[mesh_vertices[v]];
      }
      factor *= std::pow(avoided, -0.5 * sum);
    }
    factors.push_back(factor);
  }
  return factors;
}

}  // namespace spectral_conformal
