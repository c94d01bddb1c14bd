#pragma once

#include "conformal/conformal_energy.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The unit complex number that turns a map z upright by multiplication. It depends on the surface and the shape of its
/// map, not on the rotation, position or scale of z, nor on the numbering of the vertices.
///
/// Up is the direction in which the third coordinate of the positions grows: the gradient of its best linear fit on the
/// map, with vertices weighted by their area in the map. If that is weak compared with the other coordinates, as on a
/// floor or a dome, the second coordinate points up, as seen from above. If that is weak too, the first one points to
/// the right.
///
/// The map is not turned by an arbitrary angle, which would tilt straight borders, but by the nearest quarter turn of
///   - an axis of its mirror symmetry, if any; a single axis is vertical if the third coordinate is weak. If all axes
///     are diagonals of the outline, as of a bent square, it is the directions between them;
///   - otherwise the smallest rectangle around its outer loop; among about equally small ones, the nearest.
/// If most of the outer loop runs along and across one direction, as for a letter L or a cross, neither may lie in
/// between: without an axis or a smallest rectangle along that direction, the direction itself is used. A map without
/// symmetry or straight borders is turned exactly upright if that hardly enlarges its bounding box. Among about equally
/// near quarter turns the other coordinates decide; if no coordinate does, the shape: higher than wide, the broader end
/// down.
///
/// Precondition: z finite, with positive area.
Complex upright_turn(const ComplexVector& z, const ConformalEnergy& energy, const BoundaryLoop& outer_loop,
                     const Eigen::Ref<const Positions>& positions);

}  // namespace spectral_conformal
