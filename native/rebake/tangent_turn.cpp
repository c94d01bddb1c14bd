#include "rebake/tangent_turn.h"

#include <Eigen/Geometry>
#include <cstddef>

namespace spectral_conformal {
namespace {

Eigen::Vector3d vector_at(const float* values, int stride, int corner) {
  const float* const entry = values + static_cast<std::size_t>(stride) * static_cast<std::size_t>(corner);
  return {entry[0], entry[1], entry[2]};
}

/// The side of most corners.
double side_of(const float* tangents, const int* corners) {
  float sum = 0;
  for (int k = 0; k < 3; ++k) sum += tangents[4 * static_cast<std::size_t>(corners[k]) + 3];
  return sum < 0 ? -1 : 1;
}

}  // namespace

TangentTurn::TangentTurn(const MapPair& maps, const int* corners) : old_side_(side_of(maps.old_tangents, corners)) {
  for (std::size_t k = 0; k < 3; ++k) {
    normals_[k] = vector_at(maps.normals, 3, corners[k]);
    tangents_[0][k] = vector_at(maps.old_tangents, 4, corners[k]);
    tangents_[1][k] = vector_at(maps.new_tangents, 4, corners[k]);
  }
  side_ = old_side_ * side_of(maps.new_tangents, corners);
}

TexelValue TangentTurn::turned(TexelValue value, PlaceInTriangle place) const {
  const auto between = [&](const Corners& at) -> Eigen::Vector3d {
    return at[0] + place.second * (at[1] - at[0]) + place.third * (at[2] - at[0]);
  };
  const Eigen::Vector3d normal = between(normals_).normalized();
  const auto across = [&](const Corners& at) -> Eigen::Vector3d {
    const Eigen::Vector3d tangent = between(at);
    return tangent - normal * normal.dot(tangent);
  };
  const Eigen::Vector3d from = across(tangents_[0]);
  const Eigen::Vector3d to = across(tangents_[1]);
  // By the angle from the old tangent to the new one, counterclockwise about N.
  const Complex turn(from.dot(to), normal.cross(from).dot(to));
  const double length = modulus(turn);
  if (!(length > 0)) return value;
  // x T_old + y s_old N x T_old has these coordinates along T_old and N x T_old, then along T_new and N x T_new.
  const Complex old_plane(value[0], old_side_ * value[1]);
  const Complex new_plane = old_plane * std::conj(turn) / length;
  value[0] = static_cast<float>(new_plane.real());
  value[1] = static_cast<float>(old_side_ * side_ * new_plane.imag());
  return value;
}

}  // namespace spectral_conformal
