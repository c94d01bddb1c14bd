#pragma once

#include <Eigen/Core>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

struct TriangleShape;

/// A change of metric of one triangle (section 4.3): the symmetric positive definite tensor
///   G = [xx xy; xy yy]
/// in the triangle's plane, in the frame of its TriangleShape: first axis from corner 0 to corner 1, second axis a
/// quarter turn counter-clockwise from it. A vector t gets the squared length t^T G t. Only the ratio of its
/// eigenvalues and their directions matter to a map.
struct TriangleMetric {
  double xx = 1;
  double xy = 0;
  double yy = 1;
};

/// A symmetric tensor of space that measures the tangent vectors of a face: lengths sqrt(t^T G t).
using SpaceMetric = Eigen::Matrix3d;

/// Two orthonormal tangent vectors of a triangle, as rows: along its first side, and counter-clockwise from it. 0 where
/// the triangle has no plane.
Eigen::Matrix<double, 2, 3> tangent_frame(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1,
                                          const Eigen::Vector3d& p2);

/// The restriction of a tensor to the plane of a triangle; the identity where the triangle has no plane.
TriangleMetric restrict_to_triangle(const SpaceMetric& metric, const Eigen::Vector3d& p0, const Eigen::Vector3d& p1,
                                    const Eigen::Vector3d& p2);

/// J^T J of the linear map of a triangle to the plane, 0 -> 0, x1 -> d1, x2 + i y2 -> d2: solved with this metric, the
/// conformal map is that very map, up to a similarity.
TriangleMetric metric_of_map(const TriangleShape& shape, Complex d1, Complex d2);

/// The metric that stretches by `ratio` along a direction of space, projected into the triangle's plane; the identity
/// where the direction is perpendicular to it.
TriangleMetric metric_along(const Eigen::Vector3d& direction, double ratio,
                            const Eigen::Matrix<double, 2, 3>& tangent_frame);

/// Between the identity (amount 0) and the metric scaled to determinant 1 (amount 1): its power G^amount.
/// Eigenvalue ratios above 1e16, which double precision does not hold, are taken for 1e16.
TriangleMetric blend(const TriangleMetric& metric, double amount);

/// Whether both eigenvalues are positive, with a ratio of at most 1e16.
bool is_positive_definite(const TriangleMetric& metric);

/// The triangle stretched by the root of the metric, in its local isometric frame again.
TriangleShape stretched(const TriangleShape& shape, const TriangleMetric& metric);

}  // namespace spectral_conformal
