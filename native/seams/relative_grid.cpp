#include "seams/relative_grid.h"

#include <cmath>

#include "concurrency/cancellation_scope.h"

namespace spectral_conformal {
namespace {

/// The spacing of the grid, a power of two.
constexpr double step = 1.0 / (1 << 27);

}  // namespace

RelativeGrid RelativeGrid::over(const Positions& points) {
  Eigen::RowVector3d low = Eigen::RowVector3d::Constant(infinity);
  Eigen::RowVector3d high = -low;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    if (!points.row(i).allFinite()) continue;
    low = low.cwiseMin(points.row(i));
    high = high.cwiseMax(points.row(i));
  }
  RelativeGrid result;
  if (!(low[0] <= high[0])) return result;
  result.center_ = 0.5 * low + 0.5 * high;
  result.unit_ = (high - low).maxCoeff() / std::sqrt(2.0);
  return result;
}

Positions RelativeGrid::coordinates(const Positions& points) const {
  Positions result(points.rows(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    poll();
    for (int k = 0; k < 3; ++k) {
      const double offset = points(i, k) - center_[k];
      // A quotient of tiny numbers is exact where the reciprocal of the divisor would be infinite.
      const double ratio = unit_ > 0 || !std::isfinite(offset) ? offset / unit_ : 0;
      result(i, k) = std::isfinite(ratio) ? std::round(ratio / step) * step : std::nan("");
    }
  }
  return result;
}

}  // namespace spectral_conformal
