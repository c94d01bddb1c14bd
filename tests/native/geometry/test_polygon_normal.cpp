#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "geometry/polygon_normal.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("polygon_normal");

TEST_CASE("a plane polygon, convex or not, has twice its area along its normal") {
  Positions corners(5, 3);  // a square of side 2 with a notch of area 1
  corners << 0, 0, 0, 2, 0, 0, 1, 1, 0, 2, 2, 0, 0, 2, 0;
  const Eigen::Quaterniond turn = Eigen::Quaterniond(0.3, -0.5, 0.2, 0.7).normalized();
  Positions turned = corners * turn.toRotationMatrix().transpose();
  turned.rowwise() += Eigen::RowVector3d(3, -1, 2);
  for (const Eigen::Vector3d& origin : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(3, -1, 2)}) {
    CHECK((polygon_normal(turned, origin) - turn * Eigen::Vector3d(0, 0, 6)).norm() < 1e-13);
  }
  CHECK((polygon_normal(corners.colwise().reverse(), {0, 0, 0}) + Eigen::Vector3d(0, 0, 6)).norm() < 1e-13);
}

TEST_CASE("that of a quad in space is the cross product of its diagonals") {
  Positions quad(4, 3);
  quad << 0, 0, 0, 1, 0.2, 0.5, 1.3, 1, -0.4, 0.1, 0.9, 0.3;
  const Eigen::Vector3d first = (quad.row(2) - quad.row(0)).transpose();
  const Eigen::Vector3d second = (quad.row(3) - quad.row(1)).transpose();
  CHECK((polygon_normal(quad, quad.row(0).transpose()) - first.cross(second)).norm() < 1e-15);
}

TEST_CASE("a polygon on one line has none") {
  Positions line(4, 3);
  line << 0, 0, 0, 1, 0, 0, 3, 0, 0, 2, 0, 0;
  CHECK(polygon_normal(line, {0, 0, 0}).norm() == 0);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
