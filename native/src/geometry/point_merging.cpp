#include "geometry/point_merging.h"

#include <cmath>
#include <cstddef>

#include "concurrency/cancellation_scope.h"
#include "geometry/box_tree.h"
#include "geometry/tolerances.h"

namespace spectral_conformal {

ComplexVector merge_points(const ComplexVector& points, const std::vector<double>& tolerances) {
  // Two corners that meet moved by less than a tolerance together, also after rounding.
  const double below_half = 0.5 * (1 - insignificant);
  std::vector<PlaneBox> boxes;
  boxes.reserve(tolerances.size());
  for (const Complex p : points) boxes.push_back(PlaneBox::of({p}));
  const BoxTree tree = BoxTree::over(boxes);
  ComplexVector result = points;
  std::vector<char> is_placed(tolerances.size(), 0);
  for (std::size_t first = 0; first < tolerances.size(); ++first) {
    poll();
    if (is_placed[first] != 0) continue;
    const Complex place = points[static_cast<Eigen::Index>(first)];
    const double radius = below_half * tolerances[first];
    const Complex diagonal(radius, radius);
    tree.for_each_meeting(PlaneBox::of({place - diagonal, place + diagonal}), [&](int k) {
      const auto other = static_cast<std::size_t>(k);
      if (is_placed[other] == 0 && std::abs(points[k] - place) <= below_half * tolerances[other]) {
        is_placed[other] = 1;
        result[k] = place;
      }
      return true;
    });
  }
  return result;
}

}  // namespace spectral_conformal
