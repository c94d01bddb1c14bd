#include "seams/faces_in_the_way.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>

#include "concurrency/cancellation_scope.h"
#include "geometry/quad_splits.h"
#include "seams/triangle_forest.h"

namespace spectral_conformal {

std::vector<int> faces_in_the_way(const SeparableFaces& faces, const TrialMap& mapped,
                                  const std::vector<int>& defective) {
  const Chart& chart = mapped.chart;
  std::map<int, std::vector<PlaneTriangle>> images;
  for (const int t : mapped_triangulation(chart.triangles, chart.triangle_weights, mapped.z)) {
    if (!std::binary_search(defective.begin(), defective.end(), chart.triangle_face[t])) continue;
    const auto& [a, b, c] = chart.triangles[t];
    images[chart.triangle_face[t]].emplace_back(std::array<Complex, 3>{mapped.z[a], mapped.z[b], mapped.z[c]});
  }
  std::vector<int> result = mapped.flipped;
  std::vector<int> overlapping;
  std::set_difference(defective.begin(), defective.end(), result.begin(), result.end(),
                      std::back_inserter(overlapping));
  TriangleForest kept;
  for (const std::vector<int>& part : connected_parts(faces, overlapping)) {
    for (const int face : part) {
      std::vector<PlaneTriangle>& image = images[face];
      poll();
      // As deep as overlapping_triangles counts.
      if (std::any_of(image.begin(), image.end(), [&](const auto& t) { return kept.overlaps(t, 1e-9); })) {
        result.push_back(face);
      } else {
        kept.add(std::move(image));
      }
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace spectral_conformal
