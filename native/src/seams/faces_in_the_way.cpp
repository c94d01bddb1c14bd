#include "seams/faces_in_the_way.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <utility>

#include "geometry/quad_splits.h"
#include "quality/overlap.h"

namespace spectral_conformal {
namespace {

/// The images of some faces of a chart.
class FaceImages {
 public:
  FaceImages(const TrialMap& mapped, const std::vector<int>& some) : map_(mapped.z) {
    std::vector<char> wanted(mapped.chart.faces.size(), 0);
    for (const int face : some) wanted[static_cast<std::size_t>(face)] = 1;
    const Chart& chart = mapped.chart;
    for (const int t : mapped_triangulation(chart.triangles, chart.triangle_weights, map_)) {
      const int face = chart.triangle_face[static_cast<std::size_t>(t)];
      if (wanted[static_cast<std::size_t>(face)] == 0) continue;
      triangles_.push_back(chart.triangles[static_cast<std::size_t>(t)]);
      face_.push_back(face);
    }
  }

  /// Those of some faces, ascending, that cover part of each other's image.
  std::vector<int> overlapping(const std::vector<int>& some) const {
    std::vector<std::array<int, 3>> triangles;
    std::vector<int> face;
    for (std::size_t t = 0; t < face_.size(); ++t) {
      if (!std::binary_search(some.begin(), some.end(), face_[t])) continue;
      triangles.push_back(triangles_[t]);
      face.push_back(face_[t]);
    }
    const std::vector<bool> overlaps = overlapping_triangles(triangles, map_, face);
    std::vector<int> result;
    for (std::size_t t = 0; t < face.size(); ++t) {
      if (overlaps[t] && (result.empty() || result.back() != face[t])) result.push_back(face[t]);
    }
    return result;
  }

 private:
  const ComplexVector& map_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<int> face_;  ///< per triangle, ascending
};

std::vector<int> without(const std::vector<int>& faces, const std::vector<int>& some) {
  std::vector<int> result;
  std::set_difference(faces.begin(), faces.end(), some.begin(), some.end(), std::back_inserter(result));
  return result;
}

}  // namespace

std::vector<int> faces_in_the_way(const SeparableFaces& faces, const TrialMap& mapped,
                                  const std::vector<int>& defective) {
  const FaceImages images(mapped, defective);
  std::vector<int> result = mapped.flipped;
  std::vector<int> left = images.overlapping(without(defective, mapped.flipped));
  std::vector<std::vector<int>> parts = connected_parts(faces, left);
  std::reverse(parts.begin(), parts.end());
  for (const bool by_faces : {false, true}) {
    for (std::vector<int>& part : parts) {
      std::sort(part.begin(), part.end());
      // A part that covers itself loses its faces one by one, until the others have room.
      const std::size_t step = by_faces ? 1 : part.size();
      for (std::size_t first = 0; first < part.size() && !left.empty(); first += step) {
        const auto begin = part.begin() + static_cast<std::ptrdiff_t>(first);
        const std::vector<int> some(begin, begin + static_cast<std::ptrdiff_t>(step));
        const std::vector<int> others = without(left, some);
        if (others.size() == left.size()) continue;
        std::vector<int> still = images.overlapping(others);
        if (still.size() == others.size()) continue;
        result.insert(result.end(), some.begin(), some.end());
        left = std::move(still);
      }
    }
  }
  // Whatever could not be told apart.
  result.insert(result.end(), left.begin(), left.end());
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace spectral_conformal
