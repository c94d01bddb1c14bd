#include "seams/seam_price.h"

#include <algorithm>
#include <cmath>

namespace spectral_conformal {
namespace {

constexpr double flat_price = 2;
constexpr double sharp_price = 0.1;
constexpr double shown_angle = 20 * M_PI / 180;

}  // namespace

double dihedral_angle(const SeamGraph::Edge& edge) {
  // The sum of two unit vectors with the angle theta between them has the length 2 cos(theta / 2).
  return 2 * std::acos(std::min(0.5 * edge.normal.norm(), 1.0));
}

double seam_price(const SeamGraph::Edge& edge) {
  const double ratio = dihedral_angle(edge) / shown_angle;
  return std::max(sharp_price, flat_price / (1 + ratio * ratio));
}

}  // namespace spectral_conformal
