#pragma once

#include <Eigen/Core>
#include <array>

#include "rebake/texel_coding.h"
#include "rebake/triangle_samples.h"
#include "spectral_conformal/texture_rebake.h"

namespace spectral_conformal {

/// Expresses normals of the old map's tangent frame in the new one. Both frames share the surface's normal N, so that
/// the third component stays. As where textures are drawn, N and the tangents T are linear on a triangle, T is then
/// made perpendicular to N, and the bitangent is s N x T, where s is the side.
class TangentTurn {
 public:
  TangentTurn(const MapPair& maps, const int* corners);
  /// value: a normal, the first three channels.
  TexelValue turned(TexelValue value, PlaceInTriangle place) const;

 private:
  using Corners = std::array<Eigen::Vector3d, 3>;
  Corners normals_;
  std::array<Corners, 2> tangents_;  ///< of the old and of the new map
  double side_ = 1;                  ///< the product of both sides
  double old_side_ = 1;
};

}  // namespace spectral_conformal
