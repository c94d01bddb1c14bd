#include "seams/faces_in_the_way.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <utility>

#include "concurrency/listening.h"
#include "geometry/box_tree.h"
#include "geometry/quad_splits.h"
#include "graph/disjoint_sets.h"
#include "graph/grouped.h"
#include "quality/overlap.h"

namespace spectral_conformal {
namespace {

/// The images of some faces of a chart.
class FaceImages {
 public:
  /// some: ascending. Both must outlive this object.
  FaceImages(const TrialMap& mapped, const std::vector<int>& some)
      : map_(mapped.z), faces_(some), triangles_(static_cast<int>(some.size()), [&](const auto& visit) {
          const Chart& chart = mapped.chart;
          for (const int t : mapped_triangulation(chart.triangles, chart.triangle_weights, mapped.z)) {
            const int face = chart.triangle_face[t];
            if (std::binary_search(some.begin(), some.end(), face)) visit(index(face), chart.triangles[t]);
          }
        }) {}

  /// The faces among `some` whose images overlap; both ascending.
  std::vector<int> overlapping(const std::vector<int>& some) const {
    std::vector<std::array<int, 3>> triangles;
    std::vector<int> face;
    for (const int f : some) {
      triangles.insert(triangles.end(), triangles_[index(f)].begin(), triangles_[index(f)].end());
      face.resize(triangles.size(), f);
    }
    const std::vector<bool> overlaps = overlapping_triangles(triangles, map_, face);
    std::vector<int> result;
    for (std::size_t t = 0; t < face.size(); ++t) {
      if (overlaps[t] && (result.empty() || result.back() != face[t])) result.push_back(face[t]);
    }
    return result;
  }

  /// Splits `some`, ascending, into sets that cannot overlap each other, each ascending.
  std::vector<std::vector<int>> apart(const std::vector<int>& some) const {
    std::vector<PlaneBox> boxes;
    boxes.reserve(some.size());
    for (const int f : some) boxes.push_back(box(f));
    const BoxTree tree(boxes);
    const int n = static_cast<int>(some.size());
    DisjointSets sets(n);
    for (int i = 0; i < n; ++i) {
      tree.for_each_meeting(boxes[i], [&](int other) {
        sets.unite(i, other);
        return true;
      });
    }
    std::vector<std::vector<int>> of_root(some.size());
    for (int i = 0; i < n; ++i) of_root[sets.find(i)].push_back(some[i]);
    of_root.erase(std::remove_if(of_root.begin(), of_root.end(), [](const auto& set) { return set.empty(); }),
                  of_root.end());
    return of_root;
  }

 private:
  int index(int face) const {
    return static_cast<int>(std::lower_bound(faces_.begin(), faces_.end(), face) - faces_.begin());
  }
  PlaneBox box(int face) const {
    PlaneBox result{{infinity, infinity}, {-infinity, -infinity}};
    for (const auto& [a, b, c] : triangles_[index(face)]) result.include(PlaneBox::of({map_[a], map_[b], map_[c]}));
    return result;
  }

  const ComplexVector& map_;
  const std::vector<int>& faces_;
  Grouped<std::array<int, 3>> triangles_;  ///< per face
};

std::vector<int> without(const std::vector<int>& faces, const std::vector<int>& some) {
  std::vector<int> result;
  std::set_difference(faces.begin(), faces.end(), some.begin(), some.end(), std::back_inserter(result));
  return result;
}

/// Moves parts of overlapping faces to `result`, smallest first, until the rest do not overlap.
void take_out(const SeparableFaces& faces, const FaceImages& images, std::vector<int> left, std::vector<int>& result) {
  std::vector<std::vector<int>> parts = connected_parts(faces, left);
  std::reverse(parts.begin(), parts.end());
  for (const bool by_faces : {false, true}) {
    for (std::vector<int>& part : parts) {
      std::sort(part.begin(), part.end());
      // A part that overlaps itself loses faces one by one until the rest have room.
      const std::size_t step = by_faces ? 1 : part.size();
      for (std::size_t first = 0; first < part.size() && !left.empty(); first += step) {
        const auto begin = part.begin() + static_cast<std::ptrdiff_t>(first);
        const std::vector<int> some(begin, begin + static_cast<std::ptrdiff_t>(step));
        const std::vector<int> others = without(left, some);
        still_working(1000.0 * static_cast<double>(left.size()));
        if (others.size() == left.size()) continue;
        std::vector<int> still = images.overlapping(others);
        if (still.size() == others.size()) continue;
        result.insert(result.end(), some.begin(), some.end());
        left = std::move(still);
      }
    }
  }
  // Faces that could not be separated.
  result.insert(result.end(), left.begin(), left.end());
}

}  // namespace

std::vector<int> faces_in_the_way(const SeparableFaces& faces, const TrialMap& mapped,
                                  const std::vector<int>& defective) {
  const FaceImages images(mapped, defective);
  std::vector<int> result = mapped.flipped;
  const std::vector<int> overlapping = images.overlapping(without(defective, mapped.flipped));
  for (std::vector<int>& some : images.apart(overlapping)) take_out(faces, images, std::move(some), result);
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace spectral_conformal
