#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <vector>

#include "rebake/tangent_turn.h"

namespace spectral_conformal::test {
namespace {

/// The frames of one triangle.
struct FramesOfTriangle {
  std::vector<float> normals, old_tangents, new_tangents;

  void add(const Eigen::Vector3f& normal, const Eigen::Vector4f& old_tangent, const Eigen::Vector4f& new_tangent) {
    normals.insert(normals.end(), normal.data(), normal.data() + 3);
    old_tangents.insert(old_tangents.end(), old_tangent.data(), old_tangent.data() + 4);
    new_tangents.insert(new_tangents.end(), new_tangent.data(), new_tangent.data() + 4);
  }
  MapPair maps() const {
    MapPair pair;
    pair.normals = normals.data();
    pair.old_tangents = old_tangents.data();
    pair.new_tangents = new_tangents.data();
    return pair;
  }
};

/// The normal in space that a value means at a place.
Eigen::Vector3f in_space(const FramesOfTriangle& frames, const std::vector<float>& tangents, const TexelValue& value,
                         PlaceInTriangle place) {
  const auto mean = [&](const std::vector<float>& of, Eigen::Index stride) -> Eigen::Vector3f {
    const Eigen::Map<const Eigen::MatrixXf> at(of.data(), stride, 3);
    return at.topRows<3>() * Eigen::Vector3d(1 - place.second - place.third, place.second, place.third).cast<float>();
  };
  const Eigen::Vector3f normal = mean(frames.normals, 3).normalized();
  Eigen::Vector3f tangent = mean(tangents, 4);
  tangent = (tangent - normal * normal.dot(tangent)).normalized();
  return value[0] * tangent + value[1] * tangents[3] * normal.cross(tangent) + value[2] * normal;
}

}  // namespace

TEST_SUITE_BEGIN("tangent_turn");

TEST_CASE("a turned normal is the same in space") {
  const std::array<int, 3> corners{0, 1, 2};
  for (const float old_side : {1.0F, -1.0F}) {
    for (const float new_side : {1.0F, -1.0F}) {
      FramesOfTriangle frames;
      frames.add({0, 0, 1}, {1, 0, 0, old_side}, {0, 1, 0, new_side});
      frames.add({0.6F, 0, 0.8F}, {0.8F, 0, -0.6F, old_side}, {0, -1, 0, new_side});
      frames.add({0, 0.6F, 0.8F}, {0.6F, 0.64F, -0.48F, old_side}, {0.8F, -0.48F, 0.36F, new_side});
      const TangentTurn turn(frames.maps(), corners.data());
      for (const PlaceInTriangle place : {PlaceInTriangle{0, 0}, {0.1, 0.2}, {0.3, 0.6}, {0, 1}}) {
        const TexelValue value{0.48F, -0.6F, 0.64F, 0.25F};
        const TexelValue turned = turn.turned(value, place);
        CHECK(
            (in_space(frames, frames.old_tangents, value, place) - in_space(frames, frames.new_tangents, turned, place))
                .norm() < 1e-6);
        CHECK(turned[2] == value[2]);
        CHECK(turned[3] == value[3]);
      }
    }
  }
}

TEST_CASE("without a direction nothing turns") {
  const std::array<int, 3> corners{0, 0, 0};
  FramesOfTriangle frames;
  frames.add({0, 0, 1}, {0, 0, 1, 1}, {0, 1, 0, 1});
  const TexelValue value{0.6F, 0, 0.8F, 0};
  CHECK(TangentTurn(frames.maps(), corners.data()).turned(value, {}) == value);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
