#pragma once

#include "conformal/conformal_energy.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The number of length 1 that turns a map to stand upright when z is multiplied by it. It depends on the surface and
/// the shape of its map, not on how z is turned, moved or scaled, nor on the numbering of the vertices.
///
/// Up is where the third coordinate of the positions grows: the gradient of the linear function of the map that fits it
/// best, each vertex by its area in the map. Where that is weak beside the gradients of the other coordinates, as on a
/// floor or a dome, the second coordinate goes up, seen from above, and where that is weak, too, the first one to the
/// right.
///
/// The map is not turned by any angle, which would tilt straight borders, but to the quarter turn nearest to that of
///   - an axis of its mirror symmetry, where it has one; if it has only one and the third coordinate is weak, that axis
///     stands;
///   - otherwise the smallest rectangle around its outer loop; of about equally small ones, the nearest.
/// Where most of the outer loop runs along one direction and across, as of a letter L or a cross, neither may lie
/// between: without an axis or a smallest rectangle along it, that direction itself is taken.
/// A map without symmetry or straight borders is exactly upright where its bounding box then is hardly larger.
/// Between quarter turns that are about equally near, the other coordinates decide, and where no coordinate tells
/// directions apart, the shape: higher than wide, the broader end down.
///
/// Precondition: z finite, with positive area.
Complex upright_turn(const ComplexVector& z, const ConformalEnergy& energy, const BoundaryLoop& outer_loop,
                     const Eigen::Ref<const Positions>& positions);

}  // namespace spectral_conformal
