#pragma once

#include <Eigen/Core>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

struct TriangleShape;

/// The metric of one triangle (section 4.3): a symmetric positive definite tensor
///   G = [xx xy; xy yy]
/// in the triangle's plane, in the frame of its TriangleShape: the first axis runs from corner 0 to corner 1, the
/// second a quarter turn counterclockwise from it. A vector t has the squared length t^T G t. A map depends only on the
/// ratio of the eigenvalues and on their directions.
struct TriangleMetric {
  double xx = 1;
  double xy = 0;
  double yy = 1;
};

/// A symmetric tensor in 3D that measures the tangent vectors t of a face: length sqrt(t^T G t).
using SpaceMetric = Eigen::Matrix3d;

/// Two orthonormal tangent vectors of a triangle, as rows: along its first side, and a quarter turn counterclockwise
/// from it. Zero where the triangle has no plane.
Eigen::Matrix<double, 2, 3> tangent_frame(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1,
                                          const Eigen::Vector3d& p2);

/// The restriction of a tensor to the plane of a triangle; the identity where the triangle has no plane.
TriangleMetric restrict_to_triangle(const SpaceMetric& metric, const Eigen::Vector3d& p0, const Eigen::Vector3d& p1,
                                    const Eigen::Vector3d& p2);

/// J^T J of the linear map of a triangle to the plane, 0 -> 0, x1 -> d1, x2 + i y2 -> d2. With this metric the
/// conformal map is this linear map, up to a similarity.
TriangleMetric metric_of_map(const TriangleShape& shape, Complex d1, Complex d2);

/// The metric that stretches by `ratio` along a direction in 3D projected to the triangle's plane; the identity where
/// the direction is perpendicular to the plane.
TriangleMetric metric_along(const Eigen::Vector3d& direction, double ratio,
                            const Eigen::Matrix<double, 2, 3>& tangent_frame);

/// Interpolates between the identity (amount 0) and the metric G scaled to determinant 1 (amount 1): G^amount. Clamps
/// eigenvalue ratios to 1e16, the limit of double precision.
TriangleMetric blend(const TriangleMetric& metric, double amount);

/// Whether both eigenvalues are positive, with a ratio of at most 1e16.
bool is_positive_definite(const TriangleMetric& metric);

/// The triangle stretched by the square root of the metric, again in its local isometric frame.
TriangleShape stretched(const TriangleShape& shape, const TriangleMetric& metric);

}  // namespace spectral_conformal
