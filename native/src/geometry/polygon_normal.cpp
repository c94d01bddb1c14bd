#include "geometry/polygon_normal.h"

#include <Eigen/Geometry>

namespace spectral_conformal {

Eigen::Vector3d polygon_normal(const Eigen::Ref<const Positions>& corners, const Eigen::Vector3d& origin) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  const Eigen::Index n = corners.rows();
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector3d a = corners.row(i).transpose() - origin;
    const Eigen::Vector3d b = corners.row((i + 1) % n).transpose() - origin;
    normal += a.cross(b);
  }
  return normal;
}

}  // namespace spectral_conformal
