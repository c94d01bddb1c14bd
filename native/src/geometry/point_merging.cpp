#include "geometry/point_merging.h"

#include <cmath>
#include <cstddef>

#include "concurrency/listening.h"
#include "geometry/box_tree.h"

namespace spectral_conformal {

ComplexVector merge_points(const ComplexVector& points, const std::vector<double>& radii) {
  std::vector<PlaneBox> boxes;
  boxes.reserve(radii.size());
  for (const Complex p : points) boxes.push_back(PlaneBox::of({p}));
  const BoxTree tree(boxes);
  ComplexVector result = points;
  std::vector<char> is_placed(radii.size(), 0);
  for (std::size_t first = 0; first < radii.size(); ++first) {
    still_working(300);
    if (is_placed[first] != 0) continue;
    const Complex place = points[static_cast<Eigen::Index>(first)];
    const Complex diagonal(radii[first], radii[first]);
    tree.for_each_meeting(PlaneBox::of({place - diagonal, place + diagonal}), [&](int k) {
      const auto other = static_cast<std::size_t>(k);
      if (is_placed[other] == 0 && std::abs(points[k] - place) <= radii[other]) {
        is_placed[other] = 1;
        result[k] = place;
      }
      return true;
    });
  }
  return result;
}

}  // namespace spectral_conformal
