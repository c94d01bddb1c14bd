#include "spectral_conformal/metric.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/signed_area.h"
#include "geometry/tolerances.h"
#include "geometry/triangle_shape.h"

namespace spectral_conformal {
namespace {

/// G = mean I + deviator, where the deviator is trace-free with eigenvalues +-radius.
struct Split {
  double mean;
  double half_difference;
  double radius;
  explicit Split(const TriangleMetric& g)
      : mean(0.5 * (g.xx + g.yy)), half_difference(0.5 * (g.xx - g.yy)), radius(std::hypot(half_difference, g.xy)) {}
};

/// The ratio of the eigenvalues, at most 1 / epsilon, beyond which double precision does not resolve the smaller. The
/// smaller one is det / larger: the difference mean - radius would cancel.
double eigenvalue_ratio(const TriangleMetric& g, const Split& split) {
  const double larger = split.mean + split.radius;
  const double determinant = (g.xx / larger) * (g.yy / larger) - (g.xy / larger) * (g.xy / larger);
  return 1 / std::max(determinant, epsilon);
}

}  // namespace

Eigen::Matrix<double, 2, 3> tangent_frame(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1,
                                          const Eigen::Vector3d& p2) {
  Eigen::Matrix<double, 2, 3> frame = Eigen::Matrix<double, 2, 3>::Zero();
  const Eigen::Vector3d side = (p1 - p0).stableNormalized();
  const Eigen::Vector3d normal = side.cross((p2 - p0).stableNormalized());
  if (!(normal.norm() > TriangleShape::min_height)) return frame;
  frame.row(0) = side;
  frame.row(1) = normal.normalized().cross(side);
  return frame;
}

TriangleMetric restrict_to_triangle(const SpaceMetric& metric, const Eigen::Vector3d& p0, const Eigen::Vector3d& p1,
                                    const Eigen::Vector3d& p2) {
  const Eigen::Matrix<double, 2, 3> frame = tangent_frame(p0, p1, p2);
  if (frame.isZero(0)) return {};
  const Eigen::Matrix2d g = frame * metric * frame.transpose();
  return {g(0, 0), 0.5 * (g(0, 1) + g(1, 0)), g(1, 1)};
}

TriangleMetric metric_of_map(const TriangleShape& shape, Complex d1, Complex d2) {
  const Complex along = d1 / shape.x1;
  const Complex across = (d2 - shape.x2 * along) / shape.y2;
  return {std::norm(along), dot(along, across), std::norm(across)};
}

TriangleMetric metric_along(const Eigen::Vector3d& direction, double ratio,
                            const Eigen::Matrix<double, 2, 3>& tangent_frame) {
  const Eigen::Vector2d t = tangent_frame * direction.stableNormalized();
  // The projection of a perpendicular direction is rounding error, about 1e-16 long, and points anywhere.
  if (!(t.norm() > sum_rounding)) return {};
  const Eigen::Vector2d unit = t.normalized();
  const double excess = ratio * ratio - 1;
  return {1 + excess * unit.x() * unit.x(), excess * unit.x() * unit.y(), 1 + excess * unit.y() * unit.y()};
}

TriangleMetric blend(const TriangleMetric& metric, double amount) {
  const Split split(metric);
  if (!(split.radius > 0)) return {};
  // With eigenvalues e^a and e^-a at determinant 1: G^amount = cosh(amount a) I + sinh(amount a) deviator / radius.
  const double a = amount * 0.5 * std::log(eigenvalue_ratio(metric, split));
  const double scale = std::sinh(a) / split.radius;
  const double difference = scale * split.half_difference;
  return {std::cosh(a) + difference, scale * metric.xy, std::cosh(a) - difference};
}

bool is_positive_definite(const TriangleMetric& metric) {
  const Split split(metric);
  return metric.xx > 0 && metric.yy > 0 && std::isfinite(split.mean + split.radius) &&
         eigenvalue_ratio(metric, split) < 1 / epsilon;
}

TriangleShape stretched(const TriangleShape& shape, const TriangleMetric& metric) {
  // The Cholesky factor R of G = R^T R, upper triangular, keeps the first side on the first axis.
  const double along = std::sqrt(metric.xx);
  const double shear = metric.xy / along;
  const double across = std::sqrt(std::max(metric.yy - shear * shear, metric.yy * epsilon));
  TriangleShape result = shape;
  result.x1 = along * shape.x1;
  result.x2 = along * shape.x2 + shear * shape.y2;
  result.y2 = across * shape.y2;
  return result;
}

}  // namespace spectral_conformal
